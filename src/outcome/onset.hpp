// The energies at which rolling on level ground breaks the law of contact somewhere.
//
// Energies are heights H - S over the flat position, lengths in units of the long semi-axis,
// omega^2 in units of g over it. At a position of height h the law is linear in omega^2, and so in
// H = h + D omega^2/2, on either side of friction, physics (47): N > 0 below one energy, |F| < mu N
// between two. So contact is lost from one energy on, and friction is too little
//   * above the least of the upper energies of all positions, for all larger energies;
//   * from the lowest position at which a body at rest slips, mu (k^2 + h^2) < h |h'|, up to the
//     largest of the lower energies. These positions are one interval, physics (48); with less
//     energy the body passes the position of the largest one too slowly, or stops in the interval
//     before it.
// So there are one or two windows of energies that slip, and the last one has no upper end.
#pragma once

#include <optional>
#include <vector>

#include "proof/forces.hpp"

namespace rolling_ellipse {

// The least value of a quantity (energy or friction) at which a law breaks, and the angle there.
struct Onset {
    double value = infinity;
    std::optional<double> angle;

    void lower_to(double lower, double at) {
        if (lower < value) *this = {lower, at};
    }
};

// The energy from which N of rolling vanishes somewhere, physics (46).
Onset contact_loss(const Shape& shape);

// Energies between which rolling needs more friction than there is.
struct SlipWindow {
    Onset start;
    double end = infinity;
};

// The windows of a body that is no circle, ascending: one or two. Their ends are found by a scan
// over the positions and refined; the certificate then proves that rolling holds beside them, or
// names a position that the scan has missed.
std::vector<SlipWindow> slip_windows(const Shape& shape, double friction);

}  // namespace rolling_ellipse
