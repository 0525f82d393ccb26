// Several doubles side by side, and functions of them. For files that are compiled once for every
// vector level, see rolling/flow_lanes_kernel.hpp: everything here is in an anonymous namespace, so
// that no function of a wide level can come to run on a machine without it.
//
// The same operations in the same order at every level, so that all levels give the same bits: a
// fused multiply-add serves two_product alone, which is exact without it as well.
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__)
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
using Bits = long long __attribute__((vector_size(lanes * sizeof(double))));
using UnsignedBits = unsigned long long __attribute__((vector_size(lanes * sizeof(double))));
using Mask = decltype(Pack{} < Pack{});

inline Pack pack(double value) { return value - Pack{}; }

inline Pack load(const double* from) {
    Pack loaded;
    __builtin_memcpy(&loaded, from, sizeof loaded);
    return loaded;
}

inline void store(Pack values, double* to) { __builtin_memcpy(to, &values, sizeof values); }

inline bool any(Mask mask) {
    bool found = false;
    for (int i = 0; i < lanes; ++i) found |= mask[i] != 0;
    return found;
}

inline Pack sqrt(Pack x) {
#if defined(__AVX512F__)
    return (Pack)_mm512_maskz_sqrt_pd(0xff, (__m512d)x);
#elif defined(__AVX2__)
    return (Pack)_mm256_sqrt_pd((__m256d)x);
#elif defined(__SSE2__)
    return (Pack)_mm_sqrt_pd((__m128d)x);
#else
    for (int i = 0; i < lanes; ++i) x[i] = __builtin_sqrt(x[i]);
    return x;
#endif
}

inline Pack abs(Pack x) { return (Pack)((Bits)x & 0x7fffffffffffffffLL); }

inline Pack copysign(Pack size, Pack sign) {
    const Bits sign_bit = (Bits)sign & (Bits)pack(-0.0);
    return (Pack)((Bits)abs(size) | sign_bit);
}

inline Pack max(Pack x, Pack y) { return x > y ? x : y; }
inline Pack min(Pack x, Pack y) { return x < y ? x : y; }

// 1.5 2^52, whose last bit is 1: a sum with it is rounded to whole numbers.
constexpr double rounder = 6755399441055744.0;

// The nearest whole number, for |x| < 2^51.
inline Pack nearest(Pack x) { return (x + rounder) - rounder; }

// 2^n for a whole number |n| <= 1022.
inline Pack power_of_two(Pack n) {
    return (Pack)(((UnsignedBits)(n + rounder) << 52) + (1023ULL << 52));
}

constexpr double ln2_high = 0x1.62e42fefa3800p-1;  // ln 2 to 42 bits: multiples of it are exact
constexpr double ln2_low = 0x1.ef35793c76730p-45;

// sinh v and e^-v, 0 <= v < 700: from sinh r and cosh r, v = n ln 2 + r, by the addition theorems,
// so that a small sinh keeps its digits.
struct Hyperbolic {
    Pack sinh;
    Pack falling;
};

inline Hyperbolic hyperbolic(Pack v) {
    const Pack n = nearest(v * 1.44269504088896340736);
    const Pack r = (v - n * ln2_high) - n * ln2_low;
    const Pack x = r * r;
    // Taylor series: |r| <= 0.35, the first terms left out are below 5e-18.
    Pack odd = x * (1.0 / 6227020800) + 1.0 / 39916800;
    odd = odd * x + 1.0 / 362880;
    odd = odd * x + 1.0 / 5040;
    odd = odd * x + 1.0 / 120;
    odd = odd * x + 1.0 / 6;
    odd = r + r * (x * odd);
    Pack even = x * (1.0 / 479001600) + 1.0 / 3628800;
    even = even * x + 1.0 / 40320;
    even = even * x + 1.0 / 720;
    even = even * x + 1.0 / 24;
    even = even * x + 0.5;
    even = even * x;  // cosh r - 1
    const Pack up = 0.5 * power_of_two(n);
    const Pack down = 0.5 * power_of_two(-n);
    const Pack cosh_n = up + down;
    const Pack sinh_n = up - down;
    return {sinh_n + (sinh_n * even + cosh_n * odd), 2 * down * (1 + (even - odd))};
}

// The natural logarithm of a normal positive number: of a power of two and of m between sqrt(1/2)
// and sqrt(2), by the series of 2 artanh((m - 1)/(m + 1)).
inline Pack log(Pack x) {
    constexpr unsigned long long root_half = 0x3fe6a09e667f3bcdULL;
    constexpr unsigned long long one = 0x3ff0000000000000ULL;
    const UnsignedBits exponent = ((UnsignedBits)x - root_half + one) >> 52;  // n + 1023
    const Pack m = (Pack)((UnsignedBits)x - (exponent << 52) + one);
    const Pack n = (Pack)(exponent | 0x4330000000000000ULL) - (4503599627370496.0 + 1023);
    const Pack f = (m - 1) / (m + 1);
    const Pack s = f * f;
    Pack sum = s * (1.0 / 23) + 1.0 / 21;
    sum = sum * s + 1.0 / 19;
    sum = sum * s + 1.0 / 17;
    sum = sum * s + 1.0 / 15;
    sum = sum * s + 1.0 / 13;
    sum = sum * s + 1.0 / 11;
    sum = sum * s + 1.0 / 9;
    sum = sum * s + 1.0 / 7;
    sum = sum * s + 1.0 / 5;
    sum = sum * s + 1.0 / 3;
    return n * ln2_high + (2 * f + (2 * f * s * sum + n * ln2_low));
}

// The angle of the point (cos, sin) in the first octant, 0 <= sin <= cos: of the tangent, or of
// that of its distance from 45 degrees; a polynomial of least error (2e-19) for 22.5 degrees.
inline Pack octant_angle(Pack sin, Pack cos) {
    const Mask upper = sin > 0.41421356237309503 * cos;
    const Pack y = (upper ? sin - cos : sin) / (upper ? sin + cos : cos);
    const Pack z = y * y;
    Pack sum = z * 0.016285756855221028 - 0.034570561981427744;
    sum = sum * z + 0.04551593220626549;
    sum = sum * z - 0.05230454270650244;
    sum = sum * z + 0.05878928997834775;
    sum = sum * z - 0.06666424885738255;
    sum = sum * z + 0.07692296375032143;
    sum = sum * z - 0.09090908753500877;
    sum = sum * z + 0.11111111105155447;
    sum = sum * z - 0.14285714285659828;
    sum = sum * z + 0.19999999999999804;
    sum = sum * z - 0.3333333333333333;
    const Pack over = y * (z * sum);
    return upper ? 0.78539816339744830962 + (y + (over + 3.06161699786838301793e-17)) : y + over;
}

// high + low, |low| <= ulp(high)/2; see numerics/double_double.hpp.
struct PackPair {
    Pack high;
    Pack low;
};

inline Pack rounded(PackPair x) { return x.high + x.low; }

inline PackPair quick_two_sum(Pack large, Pack small) {
    const Pack sum = large + small;
    return {sum, small - (sum - large)};
}

inline PackPair two_sum(Pack x, Pack y) {
    const Pack sum = x + y;
    const Pack y_part = sum - x;
    return {sum, (x - (sum - y_part)) + (y - y_part)};
}

#if !defined(__FMA__)
// A number as a sum of two of 26 bits.
inline PackPair halves(Pack x) {
    const Pack shifted = 134217729.0 * x;  // 2^27 + 1
    const Pack high = shifted - (shifted - x);
    return {high, x - high};
}
#endif

inline PackPair two_product(Pack x, Pack y) {
    const Pack product = x * y;
#if defined(__AVX512F__)
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

inline PackPair operator-(PackPair x) { return {-x.high, -x.low}; }

inline PackPair operator+(PackPair x, Pack y) {
    const PackPair sum = two_sum(x.high, y);
    return quick_two_sum(sum.high, sum.low + x.low);
}

inline PackPair operator+(PackPair x, PackPair y) {
    const PackPair sum = two_sum(x.high, y.high);
    return quick_two_sum(sum.high, sum.low + (x.low + y.low));
}

inline PackPair operator-(PackPair x, PackPair y) { return x + (-y); }

inline PackPair select(Mask mask, PackPair x, PackPair y) {
    return {mask ? x.high : y.high, mask ? x.low : y.low};
}

}  // namespace
}  // namespace rolling_ellipse
