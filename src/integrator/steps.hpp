// A solution, stored as the list of the points (knots) at the ends of its steps. The dense output
// of a step is stored if it needs no further evaluation of f and the limit on stored dense output
// is not reached; otherwise it is computed when the step is sampled.
//
// An integration method is a class template over a System (see system.hpp) with
//     static constexpr int N;                  // = System::size
//     static constexpr bool controls_error;
//     explicit Method(const System&);
//     bool advance(Point<N>&, double h);       // one step; false if its stages have no solution
//     Dense dense_output(const Point<N>& from, double h);  // .change(s) = y - from.y, 0 <= s <= 1
//     StepCounts counts;                       // counts so far
// and, if it controls its error,
//     Ending integrate(Point<N>, double t_end, const Tolerance&, long max_steps, Visit);
//     static constexpr bool keeps_dense;
//     Dense last_dense;                        // of the last step, if keeps_dense
// A step allocates no memory and adds increments by compensated summation (`add`).
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "integrator/system.hpp"

namespace rolling_ellipse {

template <int N>
struct Knot {
    double t;
    Vector<N> y;
    Vector<N> carry;
    double periods;  // number of periods of f that were subtracted from y

    Point<N> point() const { return {t, y, carry, Vector<N>::Zero()}; }
};

template <int N>
struct Steps {
    double size;  // size of each step; if 0, error control chooses it
    std::vector<Knot<N>> knots;
    std::vector<DenseOutput<N, 1>> dense = {};  // stored dense output of the first steps
};

// Largest number of steps whose dense output is stored, to limit the memory of long runs.
inline constexpr std::size_t most_kept = std::size_t{1} << 17;

// Integrates from the last knot to t_end. `after_step(point)` may change each new point;
// `reduce(point)` subtracts periods from it and returns their number; `checkpoint()` is called
// every `steps_between_checks` steps.
template <class Integrator, int N, class Rule, class Reduce, class Checkpoint>
Ending integrate(Integrator& integrator, Steps<N>& steps, const Tolerance& tolerance,
                 long max_steps, double t_end, Rule after_step, Reduce reduce,
                 const Checkpoint& checkpoint) {
    double periods = steps.knots.back().periods;
    const auto visit = [&](Point<N>& point) {
        const AfterStep next = after_step(point);
        periods += reduce(point);
        steps.knots.push_back({point.t, point.y, point.carry, periods});
        ++integrator.counts.steps;
        if (steps.knots.size() % steps_between_checks == 0) checkpoint();
        return next;
    };
    const Point<N> start = steps.knots.back().point();
    if constexpr (Integrator::controls_error) {
        if (steps.size == 0) {
            return integrator.integrate(start, t_end, tolerance, max_steps, [&](Point<N>& point) {
                if constexpr (Integrator::keeps_dense) {
                    auto& kept = steps.dense;
                    if (kept.size() < most_kept) kept.push_back(integrator.last_dense);
                }
                return visit(point);
            });
        }
    }
    return integrate_by_fixed_steps(integrator, start, steps.size, t_end, max_steps, visit);
}

// Calls take(i, knot, change) for each of n times between the first and the last knot; the state at
// time i is the state at the knot plus the change. Fastest for sorted times.
template <class Integrator, int N, class Take>
void sample_steps(Integrator& integrator, const Steps<N>& steps, const double* times, std::size_t n,
                  Take take) {
    const std::vector<Knot<N>>& knots = steps.knots;
    const std::size_t last = knots.size() - 1;
    std::size_t step = last + 1;  // the step that contains the time; initially none
    std::optional<decltype(integrator.dense_output({}, 0.0))> dense;
    // Time since the knot of the step. A fixed step starts at the exact multiple of its size.
    const auto since_knot = [&](double t) {
        return steps.size == 0 ? t - knots[step].t
                               : std::fma(-static_cast<double>(step), steps.size, t);
    };
    for (std::size_t i = 0; i < n; ++i) {
        const double t = times[i];
        if (!(step <= last && knots[step].t <= t && (step == last || t < knots[step + 1].t))) {
            const auto later =
                std::upper_bound(knots.begin(), knots.end(), t,
                                 [](double time, const Knot<N>& knot) { return time < knot.t; });
            step = static_cast<std::size_t>(later - knots.begin()) - 1;
            dense.reset();
        }
        const Knot<N>& knot = knots[step];
        const double size = step == last ? 0.0 : since_knot(knots[step + 1].t);
        const double since = since_knot(t);
        Vector<N> change = Vector<N>::Zero();
        if (size > 0 && since != 0) {
            if (step < steps.dense.size()) {
                change = steps.dense[step].change(since / size);
            } else {
                if (!dense) dense.emplace(integrator.dense_output(knot.point(), size));
                change = dense->change(since / size);
            }
        }
        take(i, knot, change);
    }
}

// Calls take(knot, change) at evenly spaced knots and at the midpoints of some steps. A knot costs
// less than three evaluations of f, a midpoint at most two steps; together they cost about a
// twentieth of the integration. Implicit methods are examined at knots only, since their dense
// output is itself a step of the same accuracy.
template <class Integrator, int N, class Take>
void survey(Integrator& integrator, const Steps<N>& steps, long evaluations, Take take) {
    constexpr std::size_t least_knots = 8;
    constexpr std::size_t evaluations_per_knot = 128;
    constexpr std::size_t steps_per_middle = 64;
    using Dense = decltype(integrator.dense_output({}, 0.0));
    constexpr bool has_middles = !Dense::of_full_order;
    const std::vector<Knot<N>>& knots = steps.knots;
    const std::size_t n = knots.size() - 1;
    const std::size_t seen =
        std::min(n, least_knots + static_cast<std::size_t>(evaluations) / evaluations_per_knot);
    const std::size_t middles = std::min(seen, (n + steps_per_middle - 1) / steps_per_middle);
    for (std::size_t i = 0; i < seen; ++i) {
        const std::size_t k = i * n / seen;
        take(knots[k], Vector<N>(Vector<N>::Zero()));
        if (!has_middles || (i + 1) * middles / seen == i * middles / seen) continue;
        if (k < steps.dense.size()) {
            take(knots[k], steps.dense[k].change(0.5));
        } else {
            const double size = knots[k + 1].t - knots[k].t;
            take(knots[k], integrator.dense_output(knots[k].point(), size).change(0.5));
        }
    }
    take(knots.back(), Vector<N>(Vector<N>::Zero()));
}

}  // namespace rolling_ellipse
