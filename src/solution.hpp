// A motion: segments in time order, each with an evaluator for any time inside.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "flow.hpp"
#include "rolling_steps.hpp"

namespace rolling_ellipse {

struct Segment {
    Mode mode;
    double t0;
    double t1;
    std::variant<RollingFlow, SteppedRolling> motion;
};

enum class Status { completed, validity_lost, max_steps, step_too_small, step_too_large };

struct Solution {
    std::vector<Segment> segments;
    Method method = Method::exact;
    StepCounts counts;
    Status status = Status::completed;
    double followed_until = -infinity;  // last time that the segments describe
    double valid_until = infinity;      // time at which the model stops being true
    std::string reason;
    std::string message;
};

// The state at n times that the segments describe.
void sample(const Solution& solution, const double* times, std::size_t n, FlowSample* samples);

}  // namespace rolling_ellipse
