// Sentences for people: why a motion is valid, where it ends, what cannot be followed.
#pragma once

#include <string>

#include "contact/continuation.hpp"
#include "integrator/system.hpp"
#include "proof/certificate.hpp"
#include "proof/watch.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse {

// A number with six digits.
std::string brief(double value);

// The impulse by which infinite friction takes a given slip off, and the energy; else empty.
std::string slip_removal(const InitialState& start);

// The choice for a body that may roll and may fly; else empty.
std::string why_it_rolls(const Continuation& next);

// Why a start does not roll, so that nothing is proved of its motion.
std::string why_not_rolling(const Scene& scene, const State& start);

// What makes rolling the right model of a motion, or ends it: as proved, or as seen on the way.
std::string reason(const Scene& scene, const InitialState& start, const Certificate& certificate);
std::string reason(const Scene& scene, const ContactWatch& watch);

// Why a motion ended at t, before its last time, and what helps; empty where it did not.
std::string why_ended(Ending ending, const Settings& settings, double t, double t_end);

}  // namespace rolling_ellipse
