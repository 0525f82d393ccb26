// A motion and what is known of it: an evaluator for any time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "contact/contact.hpp"
#include "multipliers/steps.hpp"

namespace rolling_ellipse {

enum class Status {
    completed,
    jammed,
    validity_lost,
    max_events,
    max_steps,
    step_too_small,
    step_too_large
};

struct Solution {
    std::variant<RollingFlow, SteppedRolling, SteppedMultipliers, ContactMotion> motion;
    Model model = Model::rolling;
    Method method = Method::exact;
    StepCounts counts = {};
    Status status = Status::completed;
    double followed_until = 0.0;    // last time that the motion describes
    double valid_until = infinity;  // time at which the model stops being true
    std::string reason = {};
    std::string message = {};
};

// The state of rolling at so many times in all, in parts.
class RollingSampler {
  public:
    RollingSampler(const Solution& solution, std::size_t expected);

    void operator()(const double* times, std::size_t n, FlowSample* samples) const;

  private:
    const Solution& solution_;
    std::optional<FlowSampler> exact_;
};

// The state at n times: of the multiplier model, and of the contact model.
void sample(const Solution& solution, const double* times, std::size_t n, CoordinateState* samples);
void sample(const Solution& solution, const double* times, std::size_t n, ContactSample* samples);

// Start and end, and the points between the steps, of a motion that is integrated.
std::vector<double> knot_times(const Solution& solution);

// The force of the ground on the body at n times, of a motion that is integrated.
void contact_forces(const Solution& solution, const Scene& scene, const Settings& settings,
                    const double* times, std::size_t n, ContactForce* forces);

}  // namespace rolling_ellipse
