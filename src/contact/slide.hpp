// Sliding to one side, and rolling with resistance, solved by power series. Half a swing takes some
// twenty series, each accurate to double precision within its reach; samples use the same series.
// The slide ends at the first root of a series; the signs of Bernstein coefficients prove that
// there is no earlier one.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "contact/sliding.hpp"
#include "integrator/system.hpp"
#include "numerics/numbers.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

struct SlidePoint {
    // Angle of the body from the quarter turn nearest to the start. A thin body is most sensitive
    // to the angle near quarter turns, and the total angle cannot be stored precisely enough.
    DoubleDouble angle;
    DoubleDouble omega;
    DoubleDouble slip;
    // Velocity of the centre. Where friction hardly changes it, computing it as slip + h omega
    // would only add rounding errors.
    DoubleDouble x_dot;
    DoubleDouble path;  // path from the start
    DoubleDouble time;  // time from the start
    // Energy per mass without the kinetic energy of x_dot. It is 0 at rest on the tip, and only
    // friction changes it.
    DoubleDouble energy;
};

// The motion from a point onwards: its changes as power series in a clock that reads 0 at this
// point.
struct SlidePiece {
    SlidePoint centre;
    SlideClock clock;
    double unit;   // unit of time of the series
    double reach;  // reading of the clock at the end of the piece
    SlideMotion motion;
};

struct Slide {
    SlidingBody body;  // the body, with axes exchanged after an odd number of quarter turns
    Axes axes;
    DoubleDouble theta_base;
    double x_base;
    SlidePoint last;  // end of the last piece
    std::vector<SlidePiece> pieces;
    std::optional<double> rolls_by;  // set if the body rolls: its friction coefficient
};

// A slide at its start, with slip to the given side (0 without friction). If it follows another
// slide, it starts from the unrounded end of that slide. With `rolls_by`, the body rolls with
// resistance as long as this friction coefficient suffices.
Slide slide_from(const Scene& scene, const State& start, double side,
                 const std::optional<SlidePoint>& end_of_other = {},
                 std::optional<double> rolls_by = {});

struct SlideBounds {
    double t_end = infinity;
    long most_pieces = 0;
    double theta = infinity;  // the slide stops beyond this angle or if the body turns back
};

enum class SlideStop {
    slip_vanishes,
    pressure_vanishes,
    rotation_vanishes,  // only with rolling resistance, whose couple then changes
    law_fails,          // rolling would need more friction, or a pull by the ground
    jams,
    out_of_bounds,
    time_is_over,
    too_many_pieces,
    no_progress
};

// Extends the slide until something stops it; `slide.last` is the point where it stops.
SlideStop slide_on(Slide& slide, const SlideBounds& bounds, const Checkpoint& checkpoint);

// The state at the last point.
State end_of(const Slide& slide);
// The angle of the body at the last point of the slide, to full accuracy.
DoubleDouble angle_at_end(const Slide& slide);

// The angular velocity at the last point, where the slip has vanished. It is computed as x_dot/h if
// x_dot was smaller than h omega during the slide and therefore has smaller rounding errors.
DoubleDouble omega_without_slip(const Slide& slide);

// States and forces at n ascending times since the start.
void sample(const Slide& slide, const double* times, std::size_t n, ContactSample* samples);

}  // namespace rolling_ellipse
