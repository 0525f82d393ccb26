#include "rolling_steps.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "integrator/gauss.hpp"
#include "integrator/radau.hpp"
#include "integrator/runge_kutta.hpp"

namespace rolling_ellipse {
namespace {

constexpr int default_stages = 4;
constexpr DoubleDouble half_turn = {2 * half_pi_exact.high, 2 * half_pi_exact.low};

template <class Tableau>
using Explicit = ExplicitMethod<Tableau, RollingEquation>;

// Call action with the integrator of a motion.
template <class Action>
auto with_integrator(const SteppedRolling& motion, Action action) {
    const RollingEquation& f = motion.equation;
    switch (motion.method) {
        case Method::rk4:
            return action(Explicit<RungeKutta4>(f));
        case Method::dopri5:
            return action(Explicit<DormandPrince5>(f));
        case Method::radau:
            return action(Radau<RollingEquation>(f));
        case Method::gauss:
            if (motion.stages == 2) return action(Gauss<2, RollingEquation>(f));
            if (motion.stages == 3) return action(Gauss<3, RollingEquation>(f));
            return action(Gauss<4, RollingEquation>(f));
        default:
            return action(Explicit<DormandPrince853>(f));
    }
}

SteppedRolling motion_from(const Scene& scene, const State& start, const Settings& settings) {
    const bool turned = std::abs(start.theta) > pi;
    const double theta =
        turned ? std::atan2(std::sin(start.theta), std::cos(start.theta)) : start.theta;
    SteppedRolling motion{RollingEquation(scene.body(), scene.slope),
                          {scene.a, scene.b},
                          settings.method == Method::automatic ? Method::dop853 : settings.method,
                          settings.stages.value_or(default_stages),
                          settings.step.value_or(0.0),
                          two_sum(start.theta, -theta),
                          two_sum(start.x, -centre_path({scene.a, scene.b}, theta)),
                          centre_path({scene.a, scene.b}, pi),
                          {}};
    motion.knots.push_back({0.0, {theta, 0.0}, {start.omega, 0.0}, 0.0});
    return motion;
}

Point<2> point(const RollingKnot& knot) {
    return {knot.t, {knot.theta.high, knot.omega.high}, {knot.theta.low, knot.omega.low}};
}

// Move full half turns from y to the origin once y exceeds one.
void reduce(Point<2>& at, double& half_turns, const DoubleDouble& base) {
    if (std::abs(at.y[0]) <= pi) return;
    const double over = std::nearbyint(at.y[0] / pi);
    const DoubleDouble rest = DoubleDouble{at.y[0], at.carry[0]} - half_turn * over;
    at.y[0] = rest.high;
    at.carry[0] = rest.low;
    half_turns += over;
    at.origin[0] = base.high + half_turns * pi;
}

template <class Integrator, class Visit>
Ending run(Integrator& integrator, const SteppedRolling& motion, const Point<2>& start,
           double t_end, const Settings& settings, Visit visit) {
    if constexpr (Integrator::controls_error) {
        if (motion.step == 0) {
            return integrator.integrate(start, t_end, {settings.rtol, settings.atol},
                                        settings.max_steps, visit);
        }
    }
    return integrate_by_fixed_steps(integrator, start, motion.step, t_end, settings.max_steps,
                                    visit);
}

// The step that a time falls into.
class StepFinder {
  public:
    explicit StepFinder(const SteppedRolling& motion) : motion_(motion) {}

    // Go to the step that holds t; true if it is another one than before.
    bool move_to(double t) {
        const std::vector<RollingKnot>& knots = motion_.knots;
        if (step_ < knots.size() && knots[step_].t <= t &&
            (step_ + 1 == knots.size() || t < knots[step_ + 1].t)) {
            return false;
        }
        const auto later =
            std::upper_bound(knots.begin(), knots.end(), t,
                             [](double time, const RollingKnot& knot) { return time < knot.t; });
        step_ = static_cast<std::size_t>(later - knots.begin()) - 1;
        return true;
    }

    const RollingKnot& knot() const { return motion_.knots[step_]; }

    // Time since the knot. Fixed steps lie at multiples that are not rounded.
    double since_knot(double t) const {
        return motion_.step == 0 ? t - knot().t
                                 : std::fma(-static_cast<double>(step_), motion_.step, t);
    }

    // Size of the step; 0 after the last knot.
    double size() const {
        return step_ + 1 == motion_.knots.size() ? 0.0 : since_knot(motion_.knots[step_ + 1].t);
    }

  private:
    const SteppedRolling& motion_;
    std::size_t step_ = static_cast<std::size_t>(-1);
};

FlowSample flow_sample(const SteppedRolling& motion, const RollingKnot& knot,
                       const Vector<2>& change) {
    const DoubleDouble theta = knot.theta + change[0];
    const double path = centre_path(motion.axes, static_cast<double>(theta));
    return {static_cast<double>(motion.theta_base + half_turn * knot.half_turns + theta),
            static_cast<double>(knot.omega + change[1]),
            static_cast<double>(motion.x_base +
                                std::fma(knot.half_turns, motion.half_turn_path, path))};
}

}  // namespace

RollingIntegration integrate_rolling(const Scene& scene, const State& start,
                                     const Settings& settings, double t_end,
                                     const Checkpoint& checkpoint) {
    RollingIntegration result{motion_from(scene, start, settings), Ending::reached, {}};
    SteppedRolling& motion = result.motion;
    double half_turns = 0.0;
    const auto visit = [&](Point<2>& at) {
        constexpr std::size_t steps_between_checks = 1024;
        reduce(at, half_turns, motion.theta_base);
        motion.knots.push_back({at.t, {at.y[0], at.carry[0]}, {at.y[1], at.carry[1]}, half_turns});
        if (motion.knots.size() % steps_between_checks == 0) checkpoint();
    };
    Point<2> first = point(motion.knots.front());
    first.origin[0] = motion.theta_base.high;
    with_integrator(motion, [&](auto integrator) {
        result.ending = run(integrator, motion, first, t_end, settings, visit);
        result.counts = integrator.counts();
    });
    return result;
}

void sample(const SteppedRolling& motion, const double* times, std::size_t n, FlowSample* samples) {
    with_integrator(motion, [&](auto integrator) {
        StepFinder steps(motion);
        std::optional<decltype(integrator.dense_output({}, 0.0))> step;
        for (std::size_t i = 0; i < n; ++i) {
            if (steps.move_to(times[i])) step.reset();
            const double size = steps.size();
            const double since = steps.since_knot(times[i]);
            Vector<2> change = Vector<2>::Zero();
            if (size > 0 && since != 0) {
                if (!step) step.emplace(integrator.dense_output(point(steps.knot()), size));
                change = step->change(since / size);
            }
            samples[i] = flow_sample(motion, steps.knot(), change);
        }
    });
}

}  // namespace rolling_ellipse
