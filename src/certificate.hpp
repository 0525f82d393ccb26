// Is rolling without slip valid for the whole motion? Proved by the signs of polynomials.
#pragma once

#include <optional>

#include "scene.hpp"

namespace rolling_ellipse {

// edge: rounding cannot tell. no_proof: on a slope, or a start that does not roll.
enum class Validity { valid, invalid, edge, no_proof };

struct Certificate {
    Validity validity;
    // Over the whole motion, both directions of time; absent without a proof.
    std::optional<double> smallest_normal_force;        // [N]
    std::optional<double> smallest_normal_force_angle;  // theta in [0, pi/2]
    std::optional<double> largest_friction_needed;      // max |F/N|
    std::optional<double> largest_friction_needed_angle;
    // Where rolling ends, forwards in time: theta and the sign of omega there.
    std::optional<double> ends_at;
    double ends_heading;
};

// For a body that rolls (or rests) on level ground with the given angle and angular velocity.
Certificate certify_rolling(const Body& body, double mass, double friction, double theta,
                            double omega);

}  // namespace rolling_ellipse
