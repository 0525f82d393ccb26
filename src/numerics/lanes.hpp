// Several doubles side by side (a Pack), and function templates that give the same bits for T =
// double as for T = Pack. Some files that include this header are compiled for every vector level
// (rolling/level/kernel_code.hpp), the other files only once. All names are in an anonymous
// namespace, so that the linker cannot use a function compiled for wide vectors in code for
// machines without these vectors.
//
// Every function that takes or returns a Pack is inlined, because the wide version of a function
// (numerics/wide.hpp) would pass a Pack in different registers.
//
// Operations and their order are the same at every level. Only two_product uses a fused
// multiply-add, and it gives the exact product on machines without this instruction, too.
#pragma once

#include <type_traits>

#include "numerics/numbers.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#if defined(ROLLING_ELLIPSE_LANES)  // chosen by the including file
#elif defined(__AVX512F__)
#define ROLLING_ELLIPSE_LANES 8
#elif defined(__AVX2__)
#define ROLLING_ELLIPSE_LANES 4
#else
#define ROLLING_ELLIPSE_LANES 2
#endif

namespace rolling_ellipse {
namespace {

constexpr int lanes = ROLLING_ELLIPSE_LANES;

using Pack = double __attribute__((vector_size(lanes * sizeof(double))));
using PackBits = unsigned long long __attribute__((vector_size(lanes * sizeof(double))));
using PackPair = TwoParts<Pack>;

template <class T>
using Bits = std::conditional_t<std::is_same_v<T, double>, unsigned long long, PackBits>;

// A value copied to all lanes; a Pack is returned unchanged.
template <class T, class Number>
[[gnu::always_inline]] inline T filled(Number value) {
    return value - T{};
}

[[gnu::always_inline]] inline Pack pack(double value) { return filled<Pack>(value); }

[[gnu::always_inline]] inline Pack load(const double* from) {
    Pack loaded;
    __builtin_memcpy(&loaded, from, sizeof loaded);
    return loaded;
}

[[gnu::always_inline]] inline void store(Pack values, double* to) {
    __builtin_memcpy(to, &values, sizeof values);
}

template <class T>
[[gnu::always_inline]] inline Bits<T> bits(T x) {
    Bits<T> found;
    __builtin_memcpy(&found, &x, sizeof x);
    return found;
}

template <class T>
[[gnu::always_inline]] inline T number(Bits<T> of) {
    T found;
    __builtin_memcpy(&found, &of, sizeof of);
    return found;
}

// Number of lanes of a type, 1 for double; lane_of and set_lane read and write one lane.
template <class T>
inline constexpr int lanes_of = sizeof(T) / sizeof(double);
[[gnu::always_inline]] inline double lane_of(double x, int) { return x; }
[[gnu::always_inline]] inline double lane_of(Pack x, int lane) { return x[lane]; }
[[gnu::always_inline]] inline void set_lane(double& x, int, double value) { x = value; }
[[gnu::always_inline]] inline void set_lane(Pack& x, int lane, double value) {
    __builtin_memcpy(reinterpret_cast<char*>(&x) + lane * sizeof value, &value, sizeof value);
}

[[gnu::always_inline]] inline bool any(bool mask) { return mask; }
[[gnu::always_inline]] inline bool any(Mask<Pack> mask) {
#if defined(__AVX512F__) && ROLLING_ELLIPSE_LANES == 8
    return _mm512_movepi64_mask((__m512i)mask) != 0;
#elif defined(__AVX2__)
    return _mm256_movemask_pd((__m256d)mask) != 0;
#else
    bool found = false;
    for (int i = 0; i < lanes; ++i) found |= mask[i] != 0;
    return found;
#endif
}

[[gnu::always_inline]] inline bool negated(bool mask) { return !mask; }
[[gnu::always_inline]] inline Mask<Pack> negated(Mask<Pack> mask) { return ~mask; }

// The largest value in any lane.
template <class T>
[[gnu::always_inline]] inline double largest(T x) {
    double found = lane_of(x, 0);
    for (int i = 1; i < lanes_of<T>; ++i) found = lane_of(x, i) > found ? lane_of(x, i) : found;
    return found;
}

// from[index] in each lane, with a separate index for each lane.
template <class T>
[[gnu::always_inline]] inline T element(const T* from, T index) {
    T found{};
    for (int i = 0; i < lanes_of<T>; ++i) {
        set_lane(found, i, lane_of(from[static_cast<int>(lane_of(index, i))], i));
    }
    return found;
}

[[gnu::always_inline]] inline double sqrt(double x) { return __builtin_sqrt(x); }
[[gnu::always_inline]] inline Pack sqrt(Pack x) {
#if defined(__AVX512F__) && ROLLING_ELLIPSE_LANES == 8
    return (Pack)_mm512_maskz_sqrt_pd(0xff, (__m512d)x);
#elif defined(__AVX2__)
    return (Pack)_mm256_sqrt_pd((__m256d)x);
#elif defined(__SSE2__) && ROLLING_ELLIPSE_LANES == 2
    return (Pack)_mm_sqrt_pd((__m128d)x);
#else
    double each[lanes];
    store(x, each);
    for (double& number : each) number = __builtin_sqrt(number);
    return load(each);
#endif
}

template <class T>
[[gnu::always_inline]] inline T abs(T x) {
    return number<T>(bits(x) & 0x7fffffffffffffffULL);
}

template <class T>
[[gnu::always_inline]] inline T copysign(T size, T sign) {
    constexpr unsigned long long sign_bit = 0x8000000000000000ULL;
    return number<T>((bits(size) & ~sign_bit) | (bits(sign) & sign_bit));
}

template <class T>
[[gnu::always_inline]] inline T max(T x, T y) {
    return x > y ? x : y;
}
template <class T>
[[gnu::always_inline]] inline T min(T x, T y) {
    return x < y ? x : y;
}

// The nearest whole number, for |x| < 2^51; rounded_down and rounded_up are floor and ceiling.
template <class T>
[[gnu::always_inline]] inline T nearest(T x) {
    return (x + to_integer) - to_integer;
}
template <class T>
[[gnu::always_inline]] inline T rounded_down(T x) {
    const T n = nearest(x);
    return n > x ? n - 1 : n;
}
template <class T>
[[gnu::always_inline]] inline T rounded_up(T x) {
    const T n = nearest(x);
    return n < x ? n + 1 : n;
}

template <class T>
[[gnu::always_inline]] inline Mask<T> is_odd(T n) {
    return nearest(0.5 * n) != 0.5 * n;
}

// 2^n for a whole number |n| <= 1022.
template <class T>
[[gnu::always_inline]] inline T power_of_two(T n) {
    return number<T>((bits<T>(n + to_integer) << 52) + (1023ULL << 52));
}

// A polynomial by Horner's scheme, with the coefficients in descending powers.
template <class T, class... Doubles>
[[gnu::always_inline]] inline T horner(T x, double highest, Doubles... lower) {
    T sum = filled<T>(highest);
    ((sum = sum * x + lower), ...);
    return sum;
}

constexpr double ln2_high = 0x1.62e42fefa3800p-1;  // ln 2 to 42 bits, so that n ln2_high is exact
constexpr double ln2_low = 0x1.ef35793c76730p-45;

// sinh v and e^-v for 0 <= v < 700. The addition theorems give them from sinh r and cosh r with v =
// n ln 2 + r, so that a small sinh stays accurate.
template <class T>
struct Hyperbolic {
    T sinh;
    T falling;
};

template <class T>
[[gnu::always_inline]] inline Hyperbolic<T> hyperbolic(T v) {
    const T n = nearest<T>(v * 1.44269504088896340736);
    const T r = (v - n * ln2_high) - n * ln2_low;
    const T x = r * r;
    const T x2 = x * x;
    // Taylor series for |r| <= 0.35; the first omitted terms are below 5e-18. Pairs of terms are
    // independent of each other, which shortens the chain of operations.
    const T odd = r * x *
                  (((x * (1.0 / 120) + 1.0 / 6) + x2 * (x * (1.0 / 362880) + 1.0 / 5040)) +
                   (x2 * x2) * (x * (1.0 / 6227020800) + 1.0 / 39916800));
    const T sinh_r = r + odd;
    const T even = x * (((x * (1.0 / 24) + 0.5) + x2 * (x * (1.0 / 40320) + 1.0 / 720)) +
                        (x2 * x2) * (x * (1.0 / 479001600) + 1.0 / 3628800));  // cosh r - 1
    const T up = 0.5 * power_of_two<T>(n);
    const T down = 0.5 * power_of_two<T>(-n);
    const T cosh_n = up + down;
    const T sinh_n = up - down;
    return {sinh_n + (sinh_n * even + cosh_n * sinh_r), 2 * down * (1 + (even - sinh_r))};
}

// The natural logarithm of a normal positive number 2^n m with m between sqrt(1/2) and sqrt(2),
// from the series of 2 artanh((m - 1)/(m + 1)).
template <class T>
[[gnu::always_inline]] inline T log(T x) {
    constexpr unsigned long long root_half = 0x3fe6a09e667f3bcdULL;
    constexpr unsigned long long one = 0x3ff0000000000000ULL;
    const Bits<T> exponent = (bits(x) - root_half + one) >> 52;  // biased exponent, n + 1023
    const T m = number<T>(bits(x) - (exponent << 52) + one);
    const T n = number<T>(exponent | 0x4330000000000000ULL) - (4503599627370496.0 + 1023);
    const T f = (m - 1) / (m + 1);
    const T s = f * f;
    const T sum = horner(s, 1.0 / 23, 1.0 / 21, 1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11,
                         1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3);
    return n * ln2_high + (2 * f + (2 * f * s * sum + n * ln2_low));
}

// The inverse of sinh for 0 <= x < 1e150: e^asinh(x) = 1 + gain, corrected for the rounding of this
// sum.
template <class T>
[[gnu::always_inline]] inline T asinh(T x) {
    const T gain = x + x * x / (1 + sqrt(1 + x * x));
    const T one_more = 1 + gain;
    return log(one_more) + (gain - (one_more - 1)) / one_more;
}

// The angle of the point (cos, sin) in the first octant, 0 <= sin <= cos. A minimax polynomial
// (error 2e-19) is used up to 22.5 degrees; beyond that, it is applied to the angle measured from
// 45 degrees.
template <class T>
[[gnu::always_inline]] inline T octant_angle(T sin, T cos) {
    const auto upper = sin > 0.41421356237309503 * cos;
    const T y = (upper ? sin - cos : sin) / (upper ? sin + cos : cos);
    const T z = y * y;
    const T sum = horner(z, 0.016285756855221028, -0.034570561981427744, 0.04551593220626549,
                         -0.05230454270650244, 0.05878928997834775, -0.06666424885738255,
                         0.07692296375032143, -0.09090908753500877, 0.11111111105155447,
                         -0.14285714285659828, 0.19999999999999804, -0.3333333333333333);
    const T over = y * (z * sum);
    return upper ? 0.5 * half_pi_exact.high + (y + (over + 0.5 * half_pi_exact.low)) : y + over;
}

// The angle of the point (cos, sin), between -pi and pi.
template <class T>
[[gnu::always_inline]] inline T angle_of(T sin, T cos) {
    const T s = abs(sin);
    const T c = abs(cos);
    const T near_axis = octant_angle(min(s, c), max(s, c));
    const T acute = s > c ? half_pi_exact.high - (near_axis - half_pi_exact.low) : near_axis;
    const T angle = cos < 0 ? 2 * half_pi_exact.high - (acute - 2 * half_pi_exact.low) : acute;
    return copysign(angle, sin);
}

using rolling_ellipse::two_product;

#if !defined(__FMA__)
// Splits each double into a sum of two doubles of 26 bits.
[[gnu::always_inline]] inline PackPair halves(Pack x) {
    const Pack shifted = 134217729.0 * x;  // 2^27 + 1
    const Pack high = shifted - (shifted - x);
    return {high, x - high};
}
#endif

[[gnu::always_inline]] inline PackPair two_product(Pack x, Pack y) {
    const Pack product = x * y;
#if defined(__AVX512F__) && ROLLING_ELLIPSE_LANES == 8
    return {product, (Pack)_mm512_fmsub_pd((__m512d)x, (__m512d)y, (__m512d)product)};
#elif defined(__FMA__)
    return {product, (Pack)_mm256_fmsub_pd((__m256d)x, (__m256d)y, (__m256d)product)};
#else
    const PackPair p = halves(x);
    const PackPair q = halves(y);
    return {product,
            ((p.high * q.high - product) + p.high * q.low + p.low * q.high) + p.low * q.low};
#endif
}

}  // namespace
}  // namespace rolling_ellipse
