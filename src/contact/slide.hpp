// Sliding in one direction, solved by power series: a few to an arc, each as good as a double as
// far as it reaches, from which samples are taken, too. Ends are first roots, proved by the signs
// of Bernstein coefficients: nothing is looked for at places.
#pragma once

#include <cstddef>
#include <vector>

#include "contact/slide_series.hpp"
#include "integrator/system.hpp"
#include "numerics/double_double.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// The angle is counted from the quarter turn next to the start, where a thin body is the most
// sensitive to it: there it keeps digits that the whole angle has no room for. Path and time are
// those since the start. The velocity of the centre is a number of its own: as the sum of slip and
// h omega it would have their rounding, where friction hardly changes it. The energy, per mass, is
// that of turning and of the height over the tip's; only the work of friction changes it.
struct SlidePoint {
    DoubleDouble angle;
    DoubleDouble omega;
    DoubleDouble x_dot;
    DoubleDouble path;
    DoubleDouble time;
    DoubleDouble energy;
};

// How the motion goes on from a point, by a clock that is 0 there; the series are of the changes,
// in a unit of time of their own.
struct SlidePiece {
    SlidePoint centre;
    SlideClock clock;
    double unit;
    double reach;  // of the clock
    LongSeries angle;
    LongSeries omega;
    LongSeries x_dot;
    LongSeries path;
    LongSeries time;
};

struct Slide {
    SlidingBody body;  // after an odd number of quarter turns with its axes exchanged
    Axes axes;
    DoubleDouble theta_base;
    double x_base;
    SlidePoint last;    // where the pieces end
    DoubleDouble slip;  // there
    std::vector<SlidePiece> pieces;
};

// The start of sliding, with the slip to the given side (0: without friction there is none).
Slide slide_from(const Scene& scene, const State& start, double side);

// Let it start where another slide ended, with all digits of that, as the states have them rounded:
// its slip starts from 0.
void go_on_from(const SlidePoint& end, Slide& slide);

struct SlideBounds {
    double t_end = infinity;
    long most_pieces = 0;
    double theta = infinity;  // that it may pass,
    bool may_turn_back = true;
};

enum class SlideStop {
    slip_vanishes,
    pressure_vanishes,
    jams,
    passes_theta,
    turns_back,
    time_is_over,
    too_many_pieces,
    no_progress
};

// Slide on from the start until something stops it, at the time of the last point.
SlideStop slide_on(Slide& slide, const SlideBounds& bounds, const Checkpoint& checkpoint);

// State and force at the last point; its angle with all its digits.
ContactSample end_of(const Slide& slide);
DoubleDouble angle_at_end(const Slide& slide);

// States and forces at n times since the start, ascending.
void sample(const Slide& slide, const double* times, std::size_t n, ContactSample* samples);

}  // namespace rolling_ellipse
