// Is rolling without slip valid for the whole motion? Proved by the signs of polynomials.
#pragma once

#include <optional>

#include "proof/forces.hpp"
#include "rolling/level/flow.hpp"

namespace rolling_ellipse {

// edge: rounding cannot tell. no_proof: of a start that does not roll.
enum class Validity { valid, invalid, edge, no_proof };

// Where rolling ends, forwards in time: theta and the sign of omega there. No angle where it does
// not end.
struct EndOfRolling {
    Validity validity;
    std::optional<double> angle = std::nullopt;
    double heading = 0.0;
};

struct Certificate {
    EndOfRolling end;
    // Over the whole motion, both directions of time; absent without a proof. Downhill for ever
    // they are infinite, and at no angle.
    std::optional<double> smallest_normal_force;        // [N]
    std::optional<double> smallest_normal_force_angle;  // theta, on level ground in [0, pi/2]
    std::optional<double> largest_friction_needed;      // max |F/N|
    std::optional<double> largest_friction_needed_angle;
};

Certificate certify_rolling(const RollingStart& from, double mass, double friction);
EndOfRolling end_of_rolling(const RollingStart& from, double friction);

// The time from the start of the motion to that end; infinite without one.
double time_of_end(const RollingFlow& flow, const EndOfRolling& end);

// Friction mu suffices where mu^2 P^2 - G Q^2 >= 0, physics (35); divided by mu^2 above 1, so that
// any mu fits.
Polynomial<10> grip_polynomial(const ForcePolynomials& p, double friction);

}  // namespace rolling_ellipse
