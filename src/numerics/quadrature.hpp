// Gauss-Legendre quadrature. The nearest singularities fix the number of nodes.
#pragma once

#include <cmath>
#include <initializer_list>
#include <iterator>

#include "numerics/gauss_legendre.hpp"
#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// The smallest tabled rule with at least n nodes; the largest rule if n exceeds the table.
inline const GaussRule& gauss_rule(int n) {
    for (const GaussRule& rule : gauss_rules) {
        if (rule.size >= n) return rule;
    }
    return gauss_rules[std::size(gauss_rules) - 1];
}

// A node of a rule on -1 .. 1.
struct Node {
    double place;
    double weight;
};

inline Node node_of(const GaussRule& rule, int i) {
    const bool left = i < rule.size / 2;
    const int from_middle = left ? (rule.size + 1) / 2 - 1 - i : i - rule.size / 2;
    return {left ? -rule.nodes[from_middle] : rule.nodes[from_middle], rule.weights[from_middle]};
}

// Number of nodes for full double precision if the integrand is singular at the points
// place +- i height, in the coordinate that maps the interval to -1 .. 1. The error falls like
// rho^(-2n), rho the sum of the semi-axes of the smallest ellipse with foci +-1 through a
// singularity (Trefethen, SIAM Rev. 50 (2008) 67, theorem 4.5).
inline int nodes_needed(double height, std::initializer_list<double> places) {
    constexpr double log_accuracy = 38.0;  // -ln(3e-17), for a relative error of 3e-17
    double axis = infinity;
    for (const double place : places) {
        const double distances = std::sqrt(square(place - 1) + square(height)) +
                                 std::sqrt(square(place + 1) + square(height));
        axis = std::fmin(axis, distances / 2);
    }
    const double rho = axis + std::sqrt((axis - 1) * (axis + 1));
    return 1 + static_cast<int>(std::ceil(log_accuracy / (2 * std::log(rho))));
}

// The integral of f from v0 to v1 as a double-double: the summation adds no rounding.
template <class Function>
DoubleDouble integrate(const GaussRule& rule, double v0, double v1, const Function& f) {
    const double middle = 0.5 * (v0 + v1);
    const double half = 0.5 * (v1 - v0);
    DoubleDouble sum{};
    for (int i = 0; i < (rule.size + 1) / 2; ++i) {
        const double offset = half * rule.nodes[i];
        const double weight = rule.nodes[i] == 0 ? 0.5 * rule.weights[i] : rule.weights[i];
        sum = sum + two_product(weight, f(middle - offset) + f(middle + offset));
    }
    return sum * half;
}

}  // namespace rolling_ellipse
