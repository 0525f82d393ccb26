// Rolling with rolling resistance as power series about a state, physics (64).
#pragma once

#include <array>
#include <optional>

#include "contact/sliding.hpp"
#include "numerics/polynomial.hpp"

namespace rolling_ellipse {

// The contact force per mass times h^3, as series with the magnitudes of their terms.
struct RollingForces3 {
    std::array<Tracked, long_order + 1> normal;
    std::array<Tracked, long_order + 1> friction;
};

// The moment h g sin(alpha) - (h' + d) g cos(alpha) of gravity about the point where the normal
// force acts, per mass, from an angle in double-double precision. Empty unless these terms all but
// cancel, as in small swings about an equilibrium.
std::optional<double> cancelled_moment(const SlidingBody& body, const Geometry& at,
                                       const DoubleDouble& angle);

// With u = h^2, p = h h', the lever d of the normal force ahead of the contact, and C = h^3 c,
//     W = u (k^2 + u) + p^2 + d h p
//     W u omega' = g sin(alpha) u^2 h - p (C + u^2 omega^2) - d h C,
//     h^3 N/m = C + p u omega',    h^3 F/m = u (u omega' + p omega^2 - g sin(alpha) h).
// The slip and the work are 0. `centre.torque` is the result of `cancelled_moment`.
SlideSeries rolling_series(const SlidingBody& body, const SlideCentre& centre,
                           RollingForces3& forces);

}  // namespace rolling_ellipse
