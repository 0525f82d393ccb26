// Polynomials of small degree, fixed at compile time, with a bound on the rounding error of every
// coefficient. Their signs on an interval are proved, and all their roots on it are computed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "numerics/bisect.hpp"

namespace rolling_ellipse {

// A value and the sum of the magnitudes of the terms from which it was computed.
struct Tracked {
    double value = 0.0;
    double magnitude = 0.0;
};

inline Tracked tracked(double value) { return {value, std::abs(value)}; }

inline Tracked operator+(Tracked x, Tracked y) {
    return {x.value + y.value, x.magnitude + y.magnitude};
}

inline Tracked operator-(Tracked x, Tracked y) {
    return {x.value - y.value, x.magnitude + y.magnitude};
}

inline Tracked operator*(Tracked x, Tracked y) {
    return {x.value * y.value, x.magnitude * y.magnitude};
}

// Two doubles side by side, in one register if the processor has registers of this size.
using Pair = double __attribute__((vector_size(2 * sizeof(double))));

enum class Sign { positive, negative, undecided };

// The largest number of roundings in any chain of operations from the parameters to a result. Each
// rounding is at most epsilon/2 of the magnitude, so that their sum stays below the margin.
//   * The law of rolling, of degree 10, has the longest chain, 37, counted along the lines of
//     force_polynomials and grip_polynomial. A product of polynomials of degrees M and N with m and
//     n roundings has m + n + 1 + min(M, N).
//   * In a series of degree 24 (slides), the factors reach^k add 25 to those of its coefficients.
//   * The Bernstein form adds 3N + 1: 2N in an entry of the matrix, a product and N sums. That is
//     31 for degree 10, 73 for degree 24.
//   * Subdivision at a point other than the middle adds 3N: 30 for degree 10, the largest used.
// In total, the law has 98, and the series has 98 plus those of its coefficients. Each subdivision
// in the middle, of which there are up to 48, adds N sums; `divided` adds their roundings to the
// magnitude. The parameters are rounded, too: the sign is proved for a body and a start that differ
// from the exact ones by no more than this rounding.
constexpr double most_roundings = 128;

// Bound on the rounding error of a number.
inline double margin(Tracked number) { return most_roundings * (epsilon / 2) * number.magnitude; }

inline Sign sign(Tracked number) {
    if (number.value > margin(number)) return Sign::positive;
    return number.value < -margin(number) ? Sign::negative : Sign::undecided;
}

// Coefficients of 1, x, x^2, ...
template <int Degree>
struct Polynomial {
    std::array<Tracked, Degree + 1> coefficients{};
};

template <class... Coefficients>
Polynomial<sizeof...(Coefficients) - 1> polynomial(Coefficients... coefficients) {
    return {{tracked(coefficients)...}};
}

template <int M, int N>
Polynomial<std::max(M, N)> operator+(const Polynomial<M>& p, const Polynomial<N>& q) {
    Polynomial<std::max(M, N)> sum;
    for (int i = 0; i <= M; ++i) sum.coefficients[i] = p.coefficients[i];
    for (int i = 0; i <= N; ++i) sum.coefficients[i] = sum.coefficients[i] + q.coefficients[i];
    return sum;
}

template <int N>
Polynomial<N> operator*(double factor, const Polynomial<N>& p) {
    Polynomial<N> scaled;
    for (int i = 0; i <= N; ++i) scaled.coefficients[i] = tracked(factor) * p.coefficients[i];
    return scaled;
}

template <int M, int N>
Polynomial<std::max(M, N)> operator-(const Polynomial<M>& p, const Polynomial<N>& q) {
    return p + (-1.0) * q;
}

template <int M, int N>
Polynomial<M + N> operator*(const Polynomial<M>& p, const Polynomial<N>& q) {
    Polynomial<M + N> product;
    for (int i = 0; i <= M; ++i) {
        for (int j = 0; j <= N; ++j) {
            Tracked& target = product.coefficients[i + j];
            target = target + p.coefficients[i] * q.coefficients[j];
        }
    }
    return product;
}

template <int N>
Polynomial<N - 1> derivative(const Polynomial<N>& p) {
    Polynomial<N - 1> result;
    for (int i = 1; i <= N; ++i) result.coefficients[i - 1] = tracked(i) * p.coefficients[i];
    return result;
}

// A polynomial given by its Bernstein coefficients on [0, 1]; the smallest and the largest
// coefficient bound its values.
template <int Degree>
struct Bernstein {
    std::array<Tracked, Degree + 1> coefficients{};
};

template <int Degree>
constexpr auto binomials() {
    std::array<double, Degree + 1> row{1.0};
    for (int i = 0; i < Degree; ++i) row[i + 1] = row[i] * (Degree - i) / (i + 1);
    return row;
}

template <int N>
Bernstein<N> bernstein(const Polynomial<N>& p) {
    // The matrix that converts powers to the Bernstein form: binomial(i, j)/binomial(N, j), physics
    // (37).
    static constexpr auto matrix = [] {
        std::array<std::array<double, N + 1>, N + 1> rows{};
        for (int i = 0; i <= N; ++i) {
            rows[i][0] = 1.0;
            for (int j = 0; j < i; ++j) rows[i][j + 1] = rows[i][j] * double(i - j) / double(N - j);
        }
        return rows;
    }();
    std::array<Pair, N + 1> powers;
    for (int j = 0; j <= N; ++j) {
        powers[j] = Pair{p.coefficients[j].value, p.coefficients[j].magnitude};
    }
    Bernstein<N> result;
    for (int i = 0; i <= N; ++i) {
        Pair sum{};
        for (int j = 0; j <= i; ++j) sum += matrix[i][j] * powers[j];
        result.coefficients[i] = {sum[0], sum[1]};
    }
    return result;
}

// The value at 0 <= x <= 1, by Horner's scheme in x/(1 - x) or its inverse, whichever is smaller.
template <int N>
double value(const Bernstein<N>& p, double x) {
    static constexpr auto binomial = binomials<N>();
    const bool near_zero = x < 0.5;
    const double ratio = near_zero ? x / (1 - x) : (1 - x) / x;
    double sum = 0.0;
    double power = 1.0;
    for (int i = 0; i <= N; ++i) {
        const int j = near_zero ? N - i : i;
        sum = sum * ratio + binomial[j] * p.coefficients[j].value;
        power *= i < N ? std::max(x, 1 - x) : 1.0;
    }
    return sum * power;
}

// A polynomial split into two parts, on [0, at] and on [at, 1], by de Casteljau's subdivision.
template <int N>
struct Parts {
    Bernstein<N> left;
    Bernstein<N> right;
};

template <int N>
Parts<N> divided(const Bernstein<N>& p, double at = 0.5) {
    Parts<N> parts{{}, p};
    auto& work = parts.right.coefficients;
    for (int level = 0; level < N; ++level) {
        parts.left.coefficients[level] = work[0];
        for (int i = 0; i < N - level; ++i) {
            work[i] = tracked(1 - at) * work[i] + tracked(at) * work[i + 1];
            work[i].magnitude += std::abs(work[i].value) / most_roundings;  // one more rounding
        }
    }
    parts.left.coefficients[N] = work[0];
    return parts;
}

namespace detail {

// Number of bisections of [0, 1] after which a subinterval counts as a point.
constexpr int deepest = 48;

template <int N>
bool all(const Bernstein<N>& p, Sign wanted) {
    return std::all_of(p.coefficients.begin(), p.coefficients.end(),
                       [wanted](Tracked c) { return sign(c) == wanted; });
}

template <int N>
int sign_changes(const Bernstein<N>& p) {
    int changes = 0;
    double last = 0.0;
    for (const Tracked c : p.coefficients) {
        if (c.value == 0.0) continue;
        if (last != 0.0 && (c.value > 0) != (last > 0)) ++changes;
        last = c.value;
    }
    return changes;
}

// The root of a polynomial that changes its sign once in (0, 1).
template <int N>
double single_root(const Bernstein<N>& p) {
    const auto [low, high] = bisect_root(0.0, 1.0, [&](double x) { return value(p, x); });
    return 0.5 * (low + high);
}

template <int N>
void collect_roots(const Bernstein<N>& p, double start, double width, int depth,
                   std::vector<double>& roots) {
    const int changes = sign_changes(p);
    if (changes == 0) return;
    const double first = p.coefficients.front().value;
    const double last = p.coefficients.back().value;
    if (changes == 1 && first != 0.0 && last != 0.0) {
        roots.push_back(start + width * single_root(p));
        return;
    }
    if (depth == deepest || all(p, Sign::undecided)) {
        roots.push_back(start + 0.5 * width);
        return;
    }
    const Parts<N> parts = divided(p);
    collect_roots(parts.left, start, width / 2, depth + 1, roots);
    if (parts.right.coefficients.front().value == 0.0) roots.push_back(start + 0.5 * width);
    collect_roots(parts.right, start + width / 2, width / 2, depth + 1, roots);
}

}  // namespace detail

// The sign on [0, 1]: positive everywhere, negative somewhere (both proved), or undecided to within
// rounding.
template <int N>
Sign sign_on_unit_interval(const Bernstein<N>& p, int depth = 0) {
    if (sign(p.coefficients.front()) == Sign::negative) return Sign::negative;
    if (sign(p.coefficients.back()) == Sign::negative) return Sign::negative;
    if (detail::all(p, Sign::positive)) return Sign::positive;
    if (depth == detail::deepest || detail::all(p, Sign::undecided)) return Sign::undecided;
    const Parts<N> parts = divided(p);
    const Sign left = sign_on_unit_interval(parts.left, depth + 1);
    if (left == Sign::negative) return left;
    const Sign right = sign_on_unit_interval(parts.right, depth + 1);
    return right == Sign::positive ? left : right;
}

// The first point in [0, 1] just after which p is provably negative; empty if p is not provably
// negative anywhere. Values within rounding of zero do not count as negative; if p has only such
// values before that point, the result is 0.
template <int N>
std::optional<double> first_negative(const Bernstein<N>& p, int depth = 0) {
    int changes = 0;
    Sign last = Sign::undecided;
    for (const Tracked c : p.coefficients) {
        const Sign now = sign(c);
        if (now == Sign::undecided || now == last) continue;
        if (last == Sign::undecided && now == Sign::negative) return 0.0;
        if (last != Sign::undecided) ++changes;
        last = now;
    }
    if (changes == 0) return std::nullopt;
    const Sign first = sign(p.coefficients.front());
    if (changes == 1 && first == Sign::positive && last == Sign::negative) {
        return detail::single_root(p);
    }
    if (depth == detail::deepest) return 0.0;
    const Parts<N> parts = divided(p);
    if (const auto left = first_negative(parts.left, depth + 1)) return 0.5 * *left;
    const auto right = first_negative(parts.right, depth + 1);
    return right ? std::optional(0.5 + 0.5 * *right) : std::nullopt;
}

// All points in [0, 1] where p changes its sign or may touch zero, ascending.
template <int N>
std::vector<double> roots_on_unit_interval(const Bernstein<N>& p) {
    std::vector<double> roots;
    if (p.coefficients.front().value == 0.0) roots.push_back(0.0);
    detail::collect_roots(p, 0.0, 1.0, 0, roots);
    if (p.coefficients.back().value == 0.0) roots.push_back(1.0);
    std::sort(roots.begin(), roots.end());
    return roots;
}

}  // namespace rolling_ellipse
