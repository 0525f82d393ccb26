// Stability of Baumgarte's feedback under the steps of an explicit method.
#pragma once

#include "scene/settings.hpp"

namespace rolling_ellipse {

// Largest growth factor of a constraint error per step, above 1 if the error diverges; 0 without
// feedback or without a fixed step.
//
// To first order the feedback is linear. Its rates s are the roots of s^2 + 2 alpha s + beta^2 for
// the positions and -2 alpha for f1; a step of size dt multiplies each part of the error by the
// stability function of the method at s dt (E. Hairer, G. Wanner, Solving Ordinary Differential
// Equations II, 2nd ed., Springer 1996, IV.2).
double feedback_growth(const Settings& settings);

}  // namespace rolling_ellipse
