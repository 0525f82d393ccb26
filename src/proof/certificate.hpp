// Validity of rolling on level ground, proved from the signs of polynomials.
#pragma once

#include <optional>

#include "proof/forces.hpp"
#include "rolling/level/flow.hpp"

namespace rolling_ellipse {

// edge: the margin of the law is 0 to within rounding. no_proof: the body does not roll at the
// start, or has rolling resistance.
enum class Validity { valid, invalid, edge, no_proof };

template <>
inline constexpr std::array names<Validity>{"VALID", "INVALID", "EDGE", "NO_PROOF"};

// The end of rolling, forward in time: theta and the sign of omega when rolling ends. The angle is
// empty if rolling does not end.
struct EndOfRolling {
    Validity validity;
    std::optional<double> angle = std::nullopt;
    double heading = 0.0;
    double time = infinity;  // [s], set only on slopes; see time_of_end
};

struct Certificate {
    EndOfRolling end;
    // Extremes over the whole motion, in both directions of time; empty without a proof. A body
    // that runs downhill forever has infinite extremes without angles.
    std::optional<double> smallest_normal_force;  // smallest N [N]
    // theta at the smallest N; on level ground it is folded into [0, pi/2].
    std::optional<double> smallest_normal_force_angle;
    std::optional<double> largest_friction_needed;  // max |F/N|
    std::optional<double> largest_friction_needed_angle;
};

Certificate certify_rolling(const RollingStart& from, double mass, double friction);
EndOfRolling end_of_rolling(const RollingStart& from, double friction);

// Time from the start of the motion to the end of rolling [s]; infinite if rolling does not end.
double time_of_end(const RollingFlow& flow, const EndOfRolling& end);

// mu^2 P^2 - G Q^2, physics (35), at least 0 where friction mu suffices; divided by mu^2 for
// mu > 1, so that a large mu does not overflow.
Polynomial<10> grip_polynomial(const ForcePolynomials& p, double friction);

}  // namespace rolling_ellipse
