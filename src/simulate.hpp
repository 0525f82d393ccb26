// The whole computation: scene -> initial state -> certificate -> model -> solution. Also messages
// for users: why a body does not roll at its start, and why a motion stopped.
//
// Throughout the sources, "physics (4)" means formula (4) of notebooks/02_physics.ipynb.
#pragma once

#include <optional>
#include <string>

#include "contact/segments.hpp"
#include "proof/certificate.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse {

// A motion, how it was computed and how it ended.
struct Solution : Integration<Motion> {
    Model model = Model::rolling;
    Method method = Method::exact;
    // Time at which the model stops being valid; NaN if all that is known is that it is valid up to
    // the last requested time.
    double valid_until = infinity;
    std::string message = {};
};

// Numerical errors in the energy and the constraints of an integrated motion.
struct Losses {
    // Largest change of the energy, divided by the largest kinetic + |potential| energy. Heights
    // are measured from the ground where the motion starts, so the origin of x has no effect.
    double energy = 0.0;
    double constraints = 0.0;  // largest of |f2|/L, |f3|/L and |f4|; L is the long semi-axis
    double projected = 0.0;    // largest constraint residual after a step, before its projection
};

// The certificate of the motion that starts from the scene.
Certificate certify(const Scene& scene);

Solution simulate(const Scene& scene, const Settings& settings, double t_end,
                  const Checkpoint& checkpoint);

// Simulates the multiplier model from coordinates and velocities that violate the constraints; such
// a motion is never valid. The scene provides only the body and the ground.
Solution simulate(const Scene& scene, const CoordinateState& start, const Settings& settings,
                  double t_end, const Checkpoint& checkpoint);

// The time at which the model of a scene's solution stops being valid, found by following the
// motion beyond the last requested time if necessary.
double valid_until(const Scene& scene, const Solution& solution);

// The numerical errors of a motion computed in steps; empty for other motions.
std::optional<Losses> losses(const Solution& solution);

// The duration of a full swing or a full turn of the rolling motion that starts from the scene;
// infinite at rest or, on level ground, if the body only approaches the tip. Throws
// std::invalid_argument if there is rolling resistance, or if the body does not roll at its start
// or runs downhill for ever.
double period(const Scene& scene);

// A number as text with six digits.
std::string brief(double value);

// A sentence that says why a body does not roll at its start; empty if it rolls.
std::string why_not_rolling(const Scene& scene, const State& start);

// A sentence that says why the validity of rolling is unknown or lost from the time t on: rolling
// is invalid, at the edge of its validity, or (no_proof) it starts off the constraints.
std::string why_invalid(Validity validity, double t);

// A sentence that says why a motion ended early, at t, and suggests a remedy; empty for a complete
// motion, and for one that only loses its validity.
std::string why_ended(Ending ending, const Settings& settings, double t, double t_end);

}  // namespace rolling_ellipse
