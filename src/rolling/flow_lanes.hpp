// Exact rolling of many bodies, each at its own time: several bodies side by side in the lanes of
// the processor's vectors.
//
// The road is that of rolling/phase_time.hpp, with a number of nodes that does not depend on the
// neighbours, and with Newton's method on a Legendre series in place of its iterations. So the bits
// of a body are its own, at every level, in any company; they differ from those of one body alone
// (rolling/flow.hpp) by roundings of the same size. Bodies that are not ordinary (at rest, circles,
// beside the separatrix, small moves, extreme inertia) go the way of one alone.
#pragma once

#include <cstddef>
#include <cstdint>

#include "numerics/gauss_legendre.hpp"
#include "numerics/lane_levels.hpp"
#include "rolling/flow.hpp"

namespace rolling_ellipse {

// The states of n bodies at times of their own, not validated; throws std::invalid_argument for a
// time that is.
void sample(LaneLevel level, const RollingStart* starts, const double* times, std::size_t n,
            FlowSample* samples);

namespace detail {

// The rules of the panels: enough nodes where the grades of both halves are no less than the root
// of this, that is, where W is at most 1.54, 2.31, 3.08, 3.85, 5.35, 6.8 and 9.6
// (rolling/phase_time.hpp). By numerics/quadrature.hpp, with the zero of h at the worst place, in
// the middle of a panel.
struct LaneRule {
    GaussRule rule;
    double least_grade2;
};

inline constexpr LaneRule lane_rules[] = {
    {{10, gauss_tables::nodes_10, gauss_tables::weights_10}, 0.2001},
    {{12, gauss_tables::nodes_12, gauss_tables::weights_12}, 0.0405},
    {{14, gauss_tables::nodes_14, gauss_tables::weights_14}, 8.5e-3},
    {{16, gauss_tables::nodes_16, gauss_tables::weights_16}, 1.83e-3},
    {{20, gauss_tables::nodes_20, gauss_tables::weights_20}, 9.1e-5},
    {{24, gauss_tables::nodes_24, gauss_tables::weights_24}, 4.92e-6},
    {{32, gauss_tables::nodes_32, gauss_tables::weights_32}, 1.71e-8},
};
inline constexpr int lane_rule_count = 7;

// The bodies that one kernel call takes: places in `starts` and `times`, all of one rule.
struct LaneBodies {
    const RollingStart* starts;
    const double* times;
    const std::uint32_t* places;
    int count;
    int rule;
};

// Writes the states to their places in `samples`, and for every one of `count` bodies how many
// times longer than x the paths are whose difference it is, as far as that matters: infinity where
// there is no state.
using LaneKernel = void (*)(const LaneBodies& bodies, FlowSample* samples, double* losses);

void sample_sse2(const LaneBodies& bodies, FlowSample* samples, double* losses);
void sample_avx2(const LaneBodies& bodies, FlowSample* samples, double* losses);
void sample_avx512(const LaneBodies& bodies, FlowSample* samples, double* losses);

}  // namespace detail

}  // namespace rolling_ellipse
