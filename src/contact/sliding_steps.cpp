#include "contact/sliding_steps.hpp"

#include <cmath>
#include <utility>

#include "geometry/half_turns.hpp"
#include "integrator/runge_kutta.hpp"

namespace rolling_ellipse {
namespace {

using Integrator = ExplicitMethod<DormandPrince853, SlidingEquation>;

// Sliding by the clock that slows down near B = 0.
struct SlowedSliding {
    static constexpr int size = 5;
    SlidingEquation equation;

    Vector<5> operator()(double, const Vector<5>& y) const { return equation.slowed(y); }
};

// The margins of a slowed slide that follow those of SlideEnd.
enum SlowEnd { response_recovers = jams + 1, time_is_over };

struct Slowed {
    Until until;
    bool passed;  // B is no longer small: it slides on
};

Slowed slide_slowly(SteppedSliding& motion, const Tolerance& tolerance, long max_steps,
                    double t_end, const Checkpoint& checkpoint) {
    constexpr double no_response = 1e-13;
    const Knot<4> from = motion.steps.knots.back();
    const SlowedSliding f{motion.equation};
    ExplicitMethod<DormandPrince853, SlowedSliding> integrator(f);
    Vector<5> start;
    start << from.y, from.t;
    Steps<5> steps{0.0, {{0.0, start, Vector<5>::Zero(), 0.0}}};
    const auto margins = [&](const Vector<5>& y) -> std::array<double, 5> {
        const auto [slip, c, b] = motion.equation.margins(y.head<4>());
        return {slip, c, b - no_response, 2 * small_response - b, t_end - y[4]};
    };
    Until until =
        integrate_until(integrator, steps, tolerance, max_steps, infinity, margins, checkpoint);
    const auto append = [&](const Vector<5>& y) {  // times may differ by less than their rounding
        auto& knots = motion.steps.knots;
        while (knots.size() > 1 && knots.back().t >= y[4]) knots.pop_back();
        knots.push_back({y[4], y.head<4>(), Vector<4>::Zero(), from.periods});
    };
    for (std::size_t i = 1; i < steps.knots.size(); ++i) {
        append(steps.knots[i].y + steps.knots[i].carry);
    }
    until.time = motion.steps.knots.back().t;
    if (until.ending != Ending::event || until.which < jams) return {until, false};
    if (until.which == response_recovers || until.which == time_is_over) {
        until.ending = Ending::completed;
        until.time = infinity;
        return {until, until.which == response_recovers};
    }
    const auto [end, y] = motion.equation.last_moment(steps.knots.back().y);
    append(y);
    until.which = end;
    until.time = y[4];
    return {until, false};
}

}  // namespace

SteppedSliding sliding_from(const Scene& scene, const State& start, double side) {
    const Axes axes = scene.axes();
    const double slip = slip_velocity(start, geometry(axes, start.theta));
    const double turn = resolved(start.theta);
    const double quarters = std::nearbyint(turn / half_pi);
    const DoubleDouble rest = DoubleDouble{turn, 0.0} - half_pi_exact * quarters;
    Scene seen = scene;
    if (std::fmod(quarters, 2.0) != 0.0) std::swap(seen.a, seen.b);
    return {SlidingEquation(seen, side),
            axes,
            two_sum(start.theta, -turn) + half_pi_exact * quarters,
            start.x,
            {0.0, {{0.0, {rest.high, start.omega, 0.0, slip}, {rest.low, 0.0, 0.0, 0.0}, 0.0}}}};
}

Until integrate_sliding(SteppedSliding& motion, const Tolerance& tolerance, long max_steps,
                        double t_end, const Checkpoint& checkpoint) {
    const SlidingEquation& f = motion.equation;
    const auto margins = [&f](const Vector<4>& y) -> std::array<double, 3> {
        const auto [slip, c, b] = f.margins(y);
        return {slip, c, f.may_jam() ? b - small_response : b};
    };
    StepCounts counts;
    for (;;) {
        checkpoint();
        const double begin = motion.steps.knots.back().t;
        Integrator integrator(f);
        Until until = integrate_until(integrator, motion.steps, tolerance, max_steps - counts.steps,
                                      t_end, margins, checkpoint);
        counts += until.counts;
        if (f.may_jam() && until.ending == Ending::event && until.which == jams) {
            const auto [slow, passed] =
                slide_slowly(motion, tolerance, max_steps - counts.steps, t_end, checkpoint);
            counts += slow.counts;
            ++counts.steps;  // a change of the clock counts as one: there is no end of them else
            if (passed && motion.steps.knots.back().t > begin) continue;
            until = slow;
            if (passed) until.ending = Ending::step_too_small;
        }
        until.counts = counts;
        return until;
    }
}

void sample(const SteppedSliding& motion, const double* times, std::size_t n,
            ContactSample* samples) {
    Integrator integrator(motion.equation);
    look(integrator, motion.steps, times, n,
         [&](std::size_t i, const Knot<4>& knot, const Vector<4>& change) {
             const Vector<4> y = knot.y + (knot.carry + change);
             const double theta = static_cast<double>(
                 motion.theta_base + two_sum(knot.y[0], knot.carry[0] + change[0]));
             const Geometry at = geometry(motion.axes, theta);
             samples[i] = {in_contact(at, theta, y[1], motion.x_base + y[2], y[3], Mode::sliding),
                           motion.equation.force(at, y[1])};
         });
}

}  // namespace rolling_ellipse
