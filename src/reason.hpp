// Sentences for people: why a motion is valid, where it ends, what cannot be followed.
#pragma once

#include <string>

#include "contact/contact.hpp"
#include "proof/certificate.hpp"
#include "proof/watch.hpp"

namespace rolling_ellipse {

// A number with six digits.
std::string brief(double value);

// Why a start does not roll, and why nothing is proved of its motion; empty where it does and is.
std::string why_not_rolling(const Scene& scene, const State& start);
std::string why_no_proof(const Scene& scene, const State& start);

// What makes rolling the right model of a motion, or ends it: as proved, or as seen on the way.
std::string reason(const Scene& scene, const State& start, const Certificate& certificate);
std::string reason(const Scene& scene, const ContactWatch& watch);

// Why an integration stopped at t, before its end, and what helps; empty where it did not.
std::string why_stopped(Ending ending, const Settings& settings, double t, double t_end);
std::string why_stopped(ContactEnding ending, const Settings& settings, double t, double t_end);

std::string rolling_ends(double t);

}  // namespace rolling_ellipse
