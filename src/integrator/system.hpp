// Points, tolerances and endings, common to all integrators. An integrator takes a system y' = f(t,
// y), or diag(mass) y' = f(t, y), as a class
//     struct System {
//         static constexpr int size;
//         Vector<size> operator()(double t, const Vector<size>& y) const;
//         Matrix<size> jacobian(double t, const Vector<size>& y) const;   // for Radau
//         Vector<size> mass() const;                                      // for Radau
//         Vector<size> typical() const;  // magnitudes of a typical state, for implicit methods
//     };
// A step allocates no memory and reports failure by its return value.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>

#include "numerics/names.hpp"
#include "numerics/numbers.hpp"

namespace rolling_ellipse {

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

template <int N>
using Matrix = Eigen::Matrix<double, N, N>;

// A point of a solution, origin + y + carry at time t. The carry is the sum of the rounding errors
// of y (compensated summation). The origin is a multiple of the period of f, subtracted from y by
// the caller; relative errors are measured against origin + y.
template <int N>
struct Point {
    double t;
    Vector<N> y;
    Vector<N> carry = Vector<N>::Zero();
    Vector<N> origin = Vector<N>::Zero();
};

// Adds an increment to y + carry; the rounding error is stored in the carry.
template <int N>
void add(Point<N>& point, const Vector<N>& increment) {
    for (int i = 0; i < N; ++i) {
        const DoubleDouble sum = two_sum(point.y[i], point.carry[i] + increment[i]);
        point.y[i] = sum.high;
        point.carry[i] = sum.low;
    }
}

// Dense output of an explicit method (E. Hairer, S. P. Norsett, G. Wanner, Solving Ordinary
// Differential Equations I, II.6): the cubic Hermite polynomial plus terms of higher order,
//     y(s) - y(0) = s (F0 + (1-s) (F1 + s (F2 + (1-s) (F3 + s (F4 + ...))))),   0 <= s <= 1.
template <int N, int Terms>
struct DenseOutput {
    static constexpr bool of_full_order = false;

    std::array<Vector<N>, 3 + Terms> terms;

    Vector<N> change(double s) const {
        Vector<N> value = terms.back();
        for (int i = 1 + Terms; i >= 0; --i) {
            const double factor = i % 2 == 0 ? 1 - s : s;
            for (int j = 0; j < N; ++j) value[j] = terms[i][j] + factor * value[j];
        }
        return s * value;
    }
};

// Number of steps between two calls of the checkpoint; these steps take 10 us to 4 ms.
inline constexpr std::size_t steps_between_checks = 64;

struct Tolerance {
    double relative;
    double absolute;
};

// True if no component exceeds `largest_number` in magnitude; false if one is NaN.
template <int N>
bool in_range(const Vector<N>& y) {
    return (y.array().abs() <= largest_number).all();
}

struct StepCounts {
    long steps = 0;
    long rejected = 0;
    long evaluations = 0;  // evaluations of f
};

// Return value of a visitor: `changed` if it altered the point, so that f must be evaluated again.
enum class AfterStep { unchanged, changed };

// The reason why a motion ended. Integrators return one of the first four values; the other values
// apply to whole motions.
enum class Ending {
    completed,
    max_steps,
    step_too_small,  // the tolerance cannot be met
    step_too_large,  // a fixed step whose stages have no solution or whose state is out of range
    max_events,
    jammed,        // a slide has no continuation
    undetermined,  // a slide has two continuations
    validity_lost,
    never  // the events at which the motion is to stop can no longer occur
};

template <>
inline constexpr std::array names<Ending>{"COMPLETED",      "MAX_STEPS",     "STEP_TOO_SMALL",
                                          "STEP_TOO_LARGE", "MAX_EVENTS",    "JAMMED",
                                          "UNDETERMINED",   "VALIDITY_LOST", "NEVER"};

// An integrated motion and the time up to which it is known.
template <class Motion>
struct Integration {
    Motion motion;
    Ending ending = Ending::completed;
    double followed_until = 0.0;
    StepCounts counts = {};
};

// Takes steps of equal size up to t_end; the last one may be shorter. `method.advance(point, h)`
// updates the point except its time and returns false if the step fails; `visit(point)` is called
// with each new point and may change it. Times are multiples of the step, so that rounding errors
// do not accumulate.
template <class Method, int N, class Visit>
Ending integrate_by_fixed_steps(Method& method, Point<N> point, double step, double t_end,
                                long max_steps, Visit visit) {
    constexpr double no_step = 1e-10;  // fraction of a step; a shorter remainder is due to rounding
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
