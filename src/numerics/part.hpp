// Functions on a part, the interval -1 ... 1, as polynomials through their values at the Gauss
// nodes; the loops use several lanes.
#pragma once

#include <array>

#define ROLLING_ELLIPSE_LANES 4  // one wide register, or two narrow ones (numerics/wide.hpp)
#include "numerics/lanes.hpp"
#include "numerics/quadrature.hpp"
#include "numerics/series.hpp"
#include "numerics/wide.hpp"

namespace rolling_ellipse {
namespace {

using PartMatrix = std::array<PartArray, part_order>;  // row j multiplies element j of an array

struct PartRule {
    PartArray places;
    PartArray weights;
    PartMatrix integrals;  // integrals from -1 to the nodes
    PartMatrix moments;    // integrals of (1 + x) f from -1 to the nodes, divided by (1 + node)^2
    PartMatrix legendre;   // Legendre coefficients from values at the nodes
    PartMatrix powers;     // power coefficients from Legendre coefficients
};

// The Legendre polynomials P_0 ... P_part_order at x.
inline std::array<double, part_order + 1> legendre_polynomials(double x) {
    std::array<double, part_order + 1> p{1.0, x};
    for (int k = 1; k < part_order; ++k) {
        p[k + 1] = ((2 * k + 1) * x * p[k] - k * p[k - 1]) / (k + 1);
    }
    return p;
}

// The integral of P_k is (P_(k+1) - P_(k-1))/(2k + 1).
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
                rule.legendre[j][k] = (k + 0.5) * weight * at_node[k];
            }
            for (int i = 0; i < part_order; ++i) {
                const auto p = legendre_polynomials(node_of(gauss, i).place);
                double sum = rule.legendre[j][0] * (p[1] + 1);
                for (int k = 1; k < part_order; ++k) {
                    sum += rule.legendre[j][k] * (p[k + 1] - p[k - 1]) / (2 * k + 1);
                }
                rule.integrals[j][i] = sum;
                rule.moments[j][i] = 0.0;
                for (int q = 0; q < part_order; ++q) {
                    const auto [at, part] = node_of(gauss, q);
                    const double share = 0.5 * (1 + at);
                    const auto inside =
                        legendre_polynomials(share * (1 + node_of(gauss, i).place) - 1);
                    for (int k = 0; k < part_order; ++k) {
                        rule.moments[j][i] += 0.5 * part * share * rule.legendre[j][k] * inside[k];
                    }
                }
            }
        }
        auto& powers = rule.powers;  // P_0 = 1, P_1 = x; the other P_k follow by recurrence
        powers[0][0] = powers[1][1] = 1.0;
        for (int k = 1; k + 1 < part_order; ++k) {
            for (int i = 0; i <= k + 1; ++i) {
                const double times_x = i > 0 ? powers[k][i - 1] : 0.0;
                powers[k + 1][i] = ((2 * k + 1) * times_x - k * powers[k - 1][i]) / (k + 1);
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

}  // namespace
}  // namespace rolling_ellipse
