// Gauss-Legendre quadrature.
#pragma once

#include <array>
#include <cmath>
#include <iterator>

#include "numerics/gauss_legendre.hpp"
#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// The smallest tabulated rule with at least n nodes; the largest rule if none has that many.
inline const GaussRule& gauss_rule(int n) {
    for (const GaussRule& rule : gauss_rules) {
        if (rule.size >= n) return rule;
    }
    return gauss_rules[std::size(gauss_rules) - 1];
}

// A node of a rule on -1 ... 1.
struct Node {
    double place;
    double weight;
};

inline Node node_of(const GaussRule& rule, int i) {
    const bool left = i < rule.size / 2;
    const int from_middle = left ? (rule.size + 1) / 2 - 1 - i : i - rule.size / 2;
    return {left ? -rule.nodes[from_middle] : rule.nodes[from_middle], rule.weights[from_middle]};
}

// Number of Gauss nodes on a part, which is an interval mapped to -1 ... 1. A PartArray contains
// the values of a function at these nodes.
inline constexpr int part_order = 20;
using PartArray = std::array<double, part_order>;

// The coefficients of a polynomial on a part and of its integral from -1, in ascending powers of
// the position. The last coefficient of `value` is 0.
struct PartPolynomial {
    std::array<double, part_order + 1> value;
    std::array<double, part_order + 1> integral;
};

// The integral of f from v0 to v1. The values at each pair of nodes are added as doubles; the terms
// of the pairs are summed in double-double.
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
