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

#include "numerics/series.hpp"
#include "rolling/flow.hpp"

namespace rolling_ellipse {

// Angle, angular velocity and path over a stretch of time; angle and path are counted from the
// nearest flat position or tip, which lies `quarters` quarter turns from the first flat one.
struct FlowPiece {
    DoubleDouble centre;  // times since the flat position
    double low;
    double high;
    double quarters;
    Series angle;
    Series omega;
    Series path;
};

struct FlowTable {
    RollingFlow flow;
    double time_unit;
    FlowPiece start;  // about t = 0; its angle and path are those since then
    std::vector<FlowPiece> pieces;
};

// The table of a rotation or a libration, for times from 0 to `span`; with an infinite span for
// any.
FlowTable flow_table(const RollingFlow& flow, double span);

// Quickest for times in order; outside of the table's span it is as slow as without.
void sample(const FlowTable& table, const double* times, std::size_t n, FlowSample* samples);

// A motion to be sampled at so many times in all: few of them are not worth a table, nor are rest
// and uniform rotation.
class FlowSampler {
  public:
    FlowSampler(const RollingFlow& flow, double span, std::size_t expected);

    void operator()(const double* times, std::size_t n, FlowSample* samples) const;

  private:
    RollingFlow flow_;
    std::optional<FlowTable> table_;
};

}  // namespace rolling_ellipse
