// A motion: segments in time order, each with an evaluator for any time inside.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "flow.hpp"
#include "multiplier_steps.hpp"
#include "rolling_steps.hpp"

namespace rolling_ellipse {

struct Segment {
    Mode mode;
    double t0;
    double t1;
    std::variant<RollingFlow, SteppedRolling, SteppedMultipliers> motion;

    // Start and end, and the points between the steps.
    std::vector<double> knot_times() const;
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

// The state at n times that the segments describe: of rolling, and of the multiplier model.
void sample(const Solution& solution, const double* times, std::size_t n, FlowSample* samples);
void sample(const Solution& solution, const double* times, std::size_t n, CoordinateState* samples);

// The force of the ground on the body at n times.
void contact_forces(const Solution& solution, const Scene& scene, const Settings& settings,
                    const double* times, std::size_t n, ContactForce* forces);

}  // namespace rolling_ellipse
