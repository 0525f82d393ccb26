// The energies at which rolling on level ground breaks the law of contact somewhere.
//
// Energies are given as heights H - S above the flat position, lengths in units of the long
// semi-axis L, omega^2 in units of g/L; S is the short semi-axis, D the inertia per mass about the
// contact. At a position of height h the law is linear in omega^2, and hence in
// H = h + D omega^2/2, for either sign of friction, physics (47): N > 0 holds below one energy,
// |F| < mu N between a lower and an upper energy. Therefore contact is lost above some energy, and
// friction is too small
//   * at all energies above the least of the upper energies of all positions;
//   * from the energy of the lowest position at which a body at rest slips, mu (k^2 + h^2) <
//     h |h'|, up to the largest of the lower energies. Such positions form one interval, physics
//     (48); with less energy the body passes the position of this largest lower energy too slowly,
//     or stops before it within the interval.
// Hence there are one or two energy windows with slip, and the last one has no upper end.
#pragma once

#include <optional>
#include <vector>

#include "proof/forces.hpp"

namespace rolling_ellipse {

// The least energy or friction at which a law breaks, and the angle at which it breaks.
struct Onset {
    double value = infinity;
    std::optional<double> angle;

    void lower_to(double lower, double at) {
        if (lower < value) *this = {lower, at};
    }
};

// The least energy at which N vanishes somewhere during rolling, physics (46).
Onset contact_loss(const Shape& shape);

// A range of energies in which rolling needs more friction than available.
struct SlipWindow {
    Onset start;
    double end = infinity;
};

// The windows of a body other than a circle, ascending: one or two. A scan over the positions finds
// their ends, which are then refined. The polynomials of the certificate either show no slip just
// outside the windows or give a position that the scan has missed.
std::vector<SlipWindow> slip_windows(const Shape& shape, double friction);

}  // namespace rolling_ellipse
