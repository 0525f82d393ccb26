// Gauss-Legendre quadrature with the number of nodes that the nearest singularities ask for.
#pragma once

#include <cmath>
#include <complex>
#include <initializer_list>

#include "double_double.hpp"
#include "gauss_legendre.hpp"

namespace rolling_ellipse {

// The smallest tabled rule with at least n nodes; the largest one where n exceeds the table.
inline const GaussRule& gauss_rule(int n) {
    for (const GaussRule& rule : gauss_rules) {
        if (rule.size >= n) return rule;
    }
    return gauss_rules[std::size(gauss_rules) - 1];
}

// Nodes for full double precision on an interval whose integrand is singular at the given points
// z (mapped to the interval -1 .. 1): the error falls like rho^(-2n), rho the semi-axis sum of the
// smallest Bernstein ellipse through a singularity (Trefethen, SIAM Rev. 50 (2008) 67, thm 4.5).
inline int nodes_needed(std::initializer_list<std::complex<double>> singularities) {
    constexpr double log_accuracy = 38.0;  // -ln(3e-17)
    double rho = infinity;
    for (const std::complex<double> z : singularities) {
        const std::complex<double> root = std::sqrt(z * z - 1.0);
        rho = std::fmin(rho, std::fmax(std::abs(z + root), std::abs(z - root)));
    }
    return 1 + static_cast<int>(std::ceil(log_accuracy / (2 * std::log(rho))));
}

// The integral of f from v0 to v1, as a double-double: the sum itself adds no rounding.
template <class Function>
DoubleDouble integrate(const GaussRule& rule, double v0, double v1, const Function& f) {
    const double middle = 0.5 * (v0 + v1);
    const double half = 0.5 * (v1 - v0);
    DoubleDouble sum{};
    const int half_size = (rule.size + 1) / 2;
    for (int i = 0; i < half_size; ++i) {
        const double offset = half * rule.nodes[i];
        const double pair = offset == 0.0 && rule.nodes[i] == 0.0
                                ? f(middle)
                                : f(middle - offset) + f(middle + offset);
        sum = sum + two_product(rule.weights[i], pair);
    }
    return sum * half;
}

}  // namespace rolling_ellipse
