// Functions on a part of a panel, as polynomials through the Gauss nodes -1 ... 1.
#pragma once

#include <array>

#define ROLLING_ELLIPSE_LANES 4  // one register in the wide version of a function, two elsewhere
#include "numerics/lanes.hpp"
#include "numerics/wide.hpp"
#include "rolling/slope/run.hpp"

namespace rolling_ellipse {
namespace {

using PartMatrix = std::array<PartArray, part_order>;  // [j] belongs to the value at the node j

struct PartRule {
    PartArray places;
    PartArray weights;
    PartMatrix integrals;     // from -1 to the nodes
    PartMatrix coefficients;  // of the Legendre polynomials
};

// The Legendre polynomials P_0 ... P_part_order at x.
inline std::array<double, part_order + 1> legendre_polynomials(double x) {
    std::array<double, part_order + 1> p{1.0, x};
    for (int k = 1; k < part_order; ++k) {
        p[k + 1] = ((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1);
    }
    return p;
}

// P_k integrates to (P_(k+1) - P_(k-1))/(2k + 1).
inline const PartRule& part_rule() {
    static const PartRule found = [] {
        PartRule rule{};
        const GaussRule& gauss = gauss_rule(part_order);
        for (int j = 0; j < part_order; ++j) {
            const auto [place, weight] = node_of(gauss, j);
            rule.places[j] = place;
            rule.weights[j] = weight;
            const auto at_node = legendre_polynomials(place);
            for (int k = 0; k < part_order; ++k) {
                rule.coefficients[j][k] = (k + 0.5) * weight * at_node[k];
            }
            for (int i = 0; i < part_order; ++i) {
                const auto p = legendre_polynomials(node_of(gauss, i).place);
                double sum = rule.coefficients[j][0] * (p[1] + 1);
                for (int k = 1; k < part_order; ++k) {
                    sum += rule.coefficients[j][k] * (p[k + 1] - p[k - 1]) / (2 * k + 1);
                }
                rule.integrals[j][i] = sum;
            }
        }
        return rule;
    }();
    return found;
}

inline PartArray product(const PartMatrix& matrix, const PartArray& values) {
    static_assert(part_order % lanes == 0);
    PartArray found;
    for (int i = 0; i < part_order; i += lanes) {
        Pack even{};
        Pack odd{};
        for (int j = 0; j < part_order; j += 2) {
            even += load(&matrix[j][i]) * values[j];
            odd += load(&matrix[j + 1][i]) * values[j + 1];
        }
        store(even + odd, &found[i]);
    }
    return found;
}

inline double integral(const PartArray& values) {
    const PartArray& weights = part_rule().weights;
    Pack sum{};
    for (int i = 0; i < part_order; i += lanes) sum += load(&weights[i]) * load(&values[i]);
    double total = 0.0;
    for (int i = 0; i < lanes; ++i) total += lane_of(sum, i);
    return total;
}

// A polynomial and its integral from -1.
struct PartValue {
    double value;
    double integral;
};

// From the Legendre coefficients; the factors of the recurrence are constants of the compiler.
inline PartValue value_at(const PartArray& coefficients, double x) {
    static constexpr auto factors = [] {
        std::array<std::array<double, 3>, part_order> found{};
        for (int k = 0; k < part_order; ++k) {
            found[k] = {(2 * k + 1.0) / (k + 1), k / (k + 1.0), 1 / (2 * k + 1.0)};
        }
        return found;
    }();
    double before = 1.0;
    double now = x;
    PartValue found{coefficients[0], coefficients[0] * (x + 1)};
    for (int k = 1; k < part_order; ++k) {
        const double next = factors[k][0] * x * now - factors[k][1] * before;
        found.value += coefficients[k] * now;
        found.integral += coefficients[k] * factors[k][2] * (next - before);
        before = now;
        now = next;
    }
    return found;
}

}  // namespace
}  // namespace rolling_ellipse
