// Polynomials of a small degree fixed at compile time. Every coefficient carries a bound of its
// rounding.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// A number, and the sum of the magnitudes of the terms from which it was computed.
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

enum class Sign { positive, negative, undecided };

// Bound of the rounding error of a number: coefficients of degree 10 pass some 60 additions and
// products with errors of half an ulp each, and their parameters are rounded, too.
inline double margin(Tracked number) {
    constexpr double rounding_units = 64;
    return rounding_units * epsilon * number.magnitude;
}

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

}  // namespace rolling_ellipse
