// What the steps of an explicit method make of Baumgarte's feedback.
#pragma once

#include "scene/settings.hpp"

namespace rolling_ellipse {

// The largest factor that a step puts on what the constraints are missed by: more than 1
// and they are lost. For the explicit methods; 0 where no feedback or no fixed step is asked for.
//
// To first order the feedback is linear, positions with the roots of s^2 + 2 alpha s + beta^2, f1
// with -2 alpha, and a step of size dt multiplies each by the stability function of the method at
// s dt (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996,
// IV.2).
double feedback_growth(const Settings& settings);

}  // namespace rolling_ellipse
