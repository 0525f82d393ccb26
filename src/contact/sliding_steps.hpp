// Sliding in one direction as a list of steps, and what ends it.
#pragma once

#include <cstddef>

#include "contact/sliding.hpp"
#include "integrator/events.hpp"
#include "numerics/double_double.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// The tolerance of segments that have to be integrated; what lies between their steps is right to
// about 1e-13.
inline constexpr Tolerance finest = {1e-15, 1e-17};

// The response B, physics (50), below which the slower clock is the better one, physics (54).
inline constexpr double small_response = 1e-2;

// The angle is integrated from the nearest quarter turn, where a thin body is the most sensitive to
// it: there it keeps digits that the whole angle has no room for. After an odd number of quarter
// turns the equation is that of the body with its axes exchanged.
struct SteppedSliding {
    SlidingEquation equation;
    Axes axes;
    DoubleDouble theta_base;
    double x_base;
    Steps<4> steps;  // of (theta - theta_base, omega, x - x_base, slip velocity)
};

// The start of sliding, with the slip to the given side (0: without friction there is none).
SteppedSliding sliding_from(const Scene& scene, const State& start, double side);

// Slide on until a margin of the equation has come to an end, or to t_end.
Until integrate_sliding(SteppedSliding& motion, const Tolerance& tolerance, long max_steps,
                        double t_end, const Checkpoint& checkpoint);

// The states and forces at n times since the start.
void sample(const SteppedSliding& motion, const double* times, std::size_t n,
            ContactSample* samples);

}  // namespace rolling_ellipse
