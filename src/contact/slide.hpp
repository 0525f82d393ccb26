// Sliding to one side, solved by power series: a few to an arc, each as accurate as a double within
// its reach; samples are taken from them, too. The slide ends at first roots, which are proved by
// the signs of Bernstein coefficients, and not searched for by samples.
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
    // to the angle there, and the whole angle could not hold these digits.
    DoubleDouble angle;
    DoubleDouble omega;
    DoubleDouble slip;
    // Velocity of the centre, not computed from slip + h omega: it would have their rounding, where
    // friction hardly changes it.
    DoubleDouble x_dot;
    DoubleDouble path;  // path since the start
    DoubleDouble time;  // time since the start
    // Energy per mass, without the energy of x_dot, 0 at rest on the tip; only friction changes it.
    DoubleDouble energy;
};

// The motion from a point on, as series of changes by a clock that is 0 there.
struct SlidePiece {
    SlidePoint centre;
    SlideClock clock;
    double unit;   // unit of time of the series
    double reach;  // reading of the clock at the end of the piece
    SlideMotion motion;
};

struct Slide {
    SlidingBody body;  // the body; after an odd number of quarter turns its axes are exchanged
    Axes axes;
    DoubleDouble theta_base;
    double x_base;
    SlidePoint last;  // end of the last piece
    std::vector<SlidePiece> pieces;
};

// A slide at its start, with the slip to the given side (0: without friction there is none). After
// the end of another slide it starts without slip, with the digits that a state rounds away.
Slide slide_from(const Scene& scene, const State& start, double side,
                 const std::optional<SlidePoint>& end_of_other = {});

struct SlideBounds {
    double t_end = infinity;
    long most_pieces = 0;
    double theta = infinity;  // the slide stops beyond this angle, or where it turns back
};

enum class SlideStop {
    slip_vanishes,
    pressure_vanishes,
    jams,
    out_of_bounds,
    time_is_over,
    too_many_pieces,
    no_progress
};

// Extends the slide until something stops the body; `slide.last` is the point where it stops.
SlideStop slide_on(Slide& slide, const SlideBounds& bounds, const Checkpoint& checkpoint);

// The state at the last point.
State end_of(const Slide& slide);
// The angle of the body at the last point of the slide, to full accuracy.
DoubleDouble angle_at_end(const Slide& slide);

// The angular velocity at the last point, where the slip has vanished: by x_dot = h omega, if x_dot
// was smaller during the slide than h omega, and so has smaller roundings.
DoubleDouble omega_without_slip(const Slide& slide);

// States and forces at n times since the start, ascending.
void sample(const Slide& slide, const double* times, std::size_t n, ContactSample* samples);

}  // namespace rolling_ellipse
