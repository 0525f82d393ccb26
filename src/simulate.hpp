// The whole computation: scene -> initial state -> certificate -> model -> solution; and messages
// for users: why a start does not roll, why a motion stopped.
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
    // Time at which the model stops being valid; NaN if only its validity up to the last
    // requested time is known.
    double valid_until = infinity;
    std::string message = {};
};

// Numerical errors of an integrated motion in its energy and its constraints.
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
// a motion is never valid. The scene provides the body and the ground. (A start that satisfies the
// constraints is given by the scene itself.)
Solution simulate(const Scene& scene, const CoordinateState& start, const Settings& settings,
                  double t_end, const Checkpoint& checkpoint);

// The time at which the model of a scene's solution stops being valid. Where necessary, the motion
// is followed beyond the last requested time.
double valid_until(const Scene& scene, const Solution& solution);

// Numerical errors of energy and constraints in a motion computed in steps; empty for other
// motions.
std::optional<Losses> losses(const Solution& solution);

// Duration of a full swing or of a full turn in the rolling motion that starts from the scene;
// throws std::invalid_argument if the motion does not repeat.
double period(const Scene& scene);

// A number as text with six digits.
std::string brief(double value);

// A sentence that says why a body does not roll at its start; empty if it rolls.
std::string why_not_rolling(const Scene& scene, const State& start);

// A sentence that says why a motion ended early, at t, and suggests a remedy; empty for a complete
// motion.
std::string why_ended(Ending ending, const Settings& settings, double t, double t_end);

}  // namespace rolling_ellipse
