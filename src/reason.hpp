// Sentences for people: why a motion is valid, where it ends, why it stopped.
#pragma once

#include <string>

#include "contact/continuation.hpp"
#include "integrator/system.hpp"
#include "proof/certificate.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse {

// A number with six digits.
std::string brief(double value);

// Impulse and energy of a given slip that infinite friction stops; empty without one.
std::string slip_removal(const InitialState& start);

// The choice made for a body that may roll and may fly; empty for any other.
std::string why_it_rolls(const Continuation& next);

// The reason why a start does not roll; empty for one that rolls.
std::string why_not_rolling(const Scene& scene, const State& start);

// Why rolling is the right model of a motion, or where it ends: as proved by a certificate, or as
// observed along a computed motion.
std::string reason(const Scene& scene, const InitialState& start, const Certificate& certificate);
std::string reason(const Scene& scene, const ContactWatch& watch);

// Why a motion ended at t, before its last time, and what helps; empty for a complete one.
std::string why_ended(Ending ending, const Settings& settings, double t, double t_end);

}  // namespace rolling_ellipse
