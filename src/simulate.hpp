// The whole computation: scene -> initial state -> certificate -> model -> solution.
//
// Here and everywhere, "physics (4)" is formula (4) of notebooks/02_physics.ipynb.
#pragma once

#include <optional>
#include <string>

#include "contact/segments.hpp"
#include "proof/certificate.hpp"

namespace rolling_ellipse {

// A motion, with how it was computed and how it ended.
struct Solution : Integration<Motion> {
    Model model = Model::rolling;
    Method method = Method::exact;
    double valid_until = infinity;  // time at which the model stops being valid
    std::string message = {};
    std::optional<ContactWatch> watch = {};  // forces of a motion without a proof
};

// Energy and constraints lost by an integrated motion.
struct Losses {
    // Largest change of the energy over the largest kinetic + |potential| energy. The height is 0
    // on the ground where the motion starts: so the result does not depend on the origin of x.
    double energy = 0.0;
    double constraints = 0.0;  // largest of |f2|/L, |f3|/L and |f4|; L is the long semi-axis
    double projected = 0.0;    // that maximum within a step, before its projection
};

// The certificate of the motion that starts from the scene; its reason in one sentence.
struct CertifiedScene {
    Certificate certificate;
    std::string reason;
};

CertifiedScene certify(const Scene& scene);

Solution simulate(const Scene& scene, const Settings& settings, double t_end,
                  const Checkpoint& checkpoint);

// The multiplier model from any coordinates and velocities; the scene gives body and ground.
Solution simulate(const Scene& scene, const CoordinateState& start, const Settings& settings,
                  double t_end, const Checkpoint& checkpoint);

// The losses along a stepped motion; empty for an exact one.
std::optional<Losses> losses(const Solution& solution);

// Why the model of a scene's solution is valid, or until when, in one sentence. It needs the whole
// certificate, which costs as much as a motion: so it is not made by `simulate`.
std::string reason(const Scene& scene, const Solution& solution);

// Time of a full swing or turn of the rolling motion that starts from the scene; throws
// std::invalid_argument where it does not repeat.
double period(const Scene& scene);

}  // namespace rolling_ellipse
