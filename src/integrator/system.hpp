// What all integrators share. They see a system y' = f(t, y), or diag(mass) y' = f(t, y),
//     struct System {
//         static constexpr int size;
//         Vector<size> operator()(double t, const Vector<size>& y) const;
//         Matrix<size> jacobian(double t, const Vector<size>& y) const;   // for Radau
//         Vector<size> mass() const;                                      // for Radau
//         Vector<size> typical() const;  // sizes of an ordinary state, for implicit methods
//     };
// and know nothing of what it describes. Nothing is allocated in a step; a step that cannot be
// done is a status.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "numerics/double_double.hpp"

namespace rolling_ellipse {

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

template <int N>
using Matrix = Eigen::Matrix<double, N, N>;

// A point of a solution, origin + y + carry at time t. The carry is what rounding has taken from y
// (compensated summation). The origin is what the caller has taken off y because f is periodic; it
// counts in the size of the state, that is in the scale of a relative error.
template <int N>
struct Point {
    double t;
    Vector<N> y;
    Vector<N> carry = Vector<N>::Zero();
    Vector<N> origin = Vector<N>::Zero();
};

// y + carry + increment, the rounding kept.
template <int N>
void add(Point<N>& point, const Vector<N>& increment) {
    for (int i = 0; i < N; ++i) {
        const DoubleDouble sum = two_sum(point.y[i], point.carry[i] + increment[i]);
        point.y[i] = sum.high;
        point.carry[i] = sum.low;
    }
}

// How often long work calls its checkpoint: after 10 us of the cheapest steps, 4 ms of the dearest.
inline constexpr std::size_t steps_between_checks = 64;

struct Tolerance {
    double relative;
    double absolute;
};

// Whether no component is larger than a state may be.
template <int N>
bool in_range(const Vector<N>& y) {
    return (y.array().abs() <= largest_number).all();
}

struct StepCounts {
    long steps = 0;
    long rejected = 0;
    long evaluations = 0;  // of f
};

// What is to happen after a step: nothing, or f to be evaluated anew.
enum class AfterStep { go_on, changed };

// How a motion ended. An integrator comes to the last time, or to a step that it may not or cannot
// take; the rest is said of whole motions.
enum class Ending {
    completed,
    max_steps,
    step_too_small,  // the tolerance cannot be met
    step_too_large,  // a fixed step: stages without a solution, or a state out of range
    max_events,
    jammed,        // a slide goes on in no way
    undetermined,  // a slide goes on in two ways
    validity_lost
};

// A motion that was integrated, and the time up to which it is known.
template <class Motion>
struct Integration {
    Motion motion;
    Ending ending = Ending::completed;
    double followed_until = 0.0;
    StepCounts counts = {};
};

// Steps of one size up to t_end, the last one shorter. `method.advance(point, h)` takes all of the
// point but its time on by h, and says whether it could; `visit(point)` sees each new point and may
// change it. Times are not summed, so that no rounding collects.
template <class Method, int N, class Visit>
Ending integrate_by_fixed_steps(Method& method, Point<N> point, double step, double t_end,
                                long max_steps, Visit visit) {
    constexpr double no_step = 1e-10;  // of a step: a last one so short is rounding of the times
    const double start = point.t;
    for (long n = 0; point.t < t_end; ++n) {
        if (n == max_steps) return Ending::max_steps;
        const double rest = std::fma(-static_cast<double>(n), step, t_end - start);
        const bool last = rest <= step * (1 + no_step);
        if (!method.advance(point, last ? rest : step) || !in_range<N>(point.y)) {
            return Ending::step_too_large;
        }
        point.t = last ? t_end : start + (n + 1) * step;
        visit(point);
    }
    return Ending::completed;
}

}  // namespace rolling_ellipse
