// Exact rolling at many times, by Taylor series in time about points of the exact solution.
//
// The series cover the quarter turn (or swing) from the flat position on; all other times are
// mirror images. One more series starts at t = 0, so that small moves keep their digits. The
// coefficients follow from the equation of motion by the rules for products, quotients and roots of
// series (A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rolling/level/flow.hpp"
#include "rolling/level/kernel.hpp"

namespace rolling_ellipse {

// Writes a sample into place i of the columns.
inline void store(const FlowSample& sample, const FlowColumns& columns, std::size_t i) {
    columns.theta[i] = sample.theta;
    columns.omega[i] = sample.omega;
    columns.x[i] = sample.x;
}

// The table of a rotation or a libration, for any time. Never copied: the reader, which a kernel
// takes, points to the pieces and their ends.
struct FlowTable {
    FlowTable() = default;
    FlowTable(FlowTable&&) = default;
    FlowTable& operator=(FlowTable&&) = default;

    std::vector<FlowPiece> pieces;
    std::vector<double> ends;
    FlowReader reader;
};

// No table where no series holds.
std::optional<FlowTable> flow_table(const RollingFlow& flow);

// Sampler of a motion, to which it refers, for an expected number of times. A few times need no
// table, nor do rest and uniform rotation. The bits of a sample depend on its time only, not on the
// others.
class FlowSampler {
  public:
    FlowSampler(const RollingFlow& flow, std::size_t expected);

    void operator()(const double* times, std::size_t n, const FlowColumns& out) const;
    void operator()(const double* times, std::size_t n, FlowSample* samples) const;

  private:
    const RollingFlow& flow_;
    std::optional<FlowTable> table_;
};

}  // namespace rolling_ellipse
