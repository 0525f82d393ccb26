// Exact rolling at many times: Taylor series in time, each about a point of the exact solution.
//
// The series cover the quarter turn (or swing) from the flat position on; everything else is its
// mirror image. One more starts at t = 0, so that small moves keep their digits. The coefficients
// follow from the equation of motion by the rules for products, quotients and roots of series
// (A. Jorba, M. Zou, Experiment. Math. 14 (2005) 99).
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rolling/level/flow.hpp"
#include "rolling/level/table.hpp"

namespace rolling_ellipse {

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

// None where no series holds.
std::optional<FlowTable> flow_table(const RollingFlow& flow);

// A motion, which has to live as long, to be sampled at so many times in all: few of them are not
// worth a table, nor are rest and uniform rotation. The bits depend on the time alone, not on those
// beside it.
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
