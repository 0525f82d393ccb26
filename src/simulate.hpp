// The whole computation: scene -> initial state -> certificate -> model -> solution.
//
// Here and everywhere, "physics (4)" is formula (4) of notebooks/02_physics.ipynb.
#pragma once

#include "proof/certificate.hpp"
#include "solution.hpp"

namespace rolling_ellipse {

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

// Why the model of a scene's solution is valid, or until when, in one sentence. It needs the whole
// certificate, which costs as much as a motion: so it is not made by `simulate`.
std::string reason(const Scene& scene, const Solution& solution);

// Time of a full swing or turn of the rolling motion that starts from the scene; throws
// std::invalid_argument where it does not repeat.
double period(const Scene& scene);

}  // namespace rolling_ellipse
