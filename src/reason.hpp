// Sentences for people: why a motion is valid, where it ends, what cannot be followed.
#pragma once

#include <string>

#include "certificate.hpp"

namespace rolling_ellipse {

// A number with six digits.
std::string brief(double value);

// Why exact rolling does not describe this scene at all; empty where it does.
std::string why_not_rolling(const Scene& scene, const State& start);

std::string reason(const Scene& scene, const State& start, const Certificate& certificate);

}  // namespace rolling_ellipse
