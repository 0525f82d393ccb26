#include "rolling/stepped/steps.hpp"

#include <cmath>

#include "integrator/gauss.hpp"
#include "integrator/radau.hpp"
#include "integrator/runge_kutta.hpp"
#include "rolling/stepped/path.hpp"

namespace rolling_ellipse {
namespace {

constexpr int default_stages = 4;

// Call action with the integrator of a motion.
template <class Action>
void with_integrator(const SteppedRolling& motion, Action action) {
    const RollingEquation& f = motion.equation;
    const int stages = motion.settings.stages.value_or(default_stages);
    switch (motion.settings.method) {
        case Method::radau:
            return action(Radau<RollingEquation>(f));
        case Method::gauss:
            if (stages == 2) return action(Gauss<2, RollingEquation>(f));
            if (stages == 3) return action(Gauss<3, RollingEquation>(f));
            return action(Gauss<4, RollingEquation>(f));
        default:
            return with_tableau(motion.settings.method, [&](auto tableau) {
                action(ExplicitMethod<decltype(tableau), RollingEquation>(f));
            });
    }
}

// The state at places of a motion. All places of a step share what is computed at its knot.
class StepView {
  public:
    explicit StepView(const SteppedRolling& motion) : motion_(motion), path_(motion.axes) {}

    FlowSample operator()(const Knot<2>& knot, const Vector<2>& change) {
        if (&knot != knot_) move_to(knot);
        const double rest = knot.y[0] + (knot.carry[0] + change[0]);
        const double path = change[0] == 0 ? centre_path(motion_.axes, rest) : path_(rest);
        return {double(theta_ + change[0]), knot.y[1] + (knot.carry[1] + change[1]),
                double(motion_.x_base + (path_before_ + path))};
    }

  private:
    void move_to(const Knot<2>& knot) {
        knot_ = &knot;
        theta_ =
            motion_.theta_base + half_turn * knot.periods + DoubleDouble{knot.y[0], knot.carry[0]};
        path_before_ = knot.periods * motion_.half_turn_path;
    }

    const SteppedRolling& motion_;
    PathSeries path_;
    const Knot<2>* knot_ = nullptr;
    DoubleDouble theta_;
    double path_before_ = 0.0;  // of the half turns before the knot
};

// The motion before its first step.
SteppedRolling rolling_from(const Scene& scene, const State& start, const Settings& settings) {
    const Axes axes = scene.axes();
    const double rest = within_a_turn(start.theta);
    SteppedRolling motion{RollingEquation(scene.body(), scene.slope),
                          axes,
                          settings,
                          two_sum(start.theta, -rest),
                          two_sum(start.x, -centre_path(axes, rest)),
                          centre_path(axes, pi),
                          {settings.step.value_or(0.0), {}}};
    motion.steps.knots.push_back({0.0, {rest, start.omega}, Vector<2>::Zero(), 0.0});
    return motion;
}

}  // namespace

Integration<SteppedRolling> integrate_rolling(const Scene& scene, const State& start,
                                              const Settings& settings, double t_end,
                                              const Checkpoint& checkpoint) {
    Integration<SteppedRolling> result{rolling_from(scene, start, settings)};
    result.followed_until = t_end;
    SteppedRolling& motion = result.motion;
    if (start.mode == Mode::rest) return result;
    const auto keep = [](Point<2>&) { return AfterStep::go_on; };
    const auto reduce = [&](Point<2>& point) {
        const double half_turns = take_half_turns_off(point.y[0], point.carry[0]);
        point.origin[0] += half_turns * pi;
        return half_turns;
    };
    with_integrator(motion, [&](auto integrator) {
        result.ending = integrate(integrator, motion.steps, {settings.rtol, settings.atol},
                                  settings.max_steps, t_end, keep, reduce, checkpoint);
        result.counts = integrator.counts();
    });
    result.counts.steps = static_cast<long>(motion.steps.knots.size()) - 1;
    if (result.ending != Ending::completed) result.followed_until = motion.steps.knots.back().t;
    return result;
}

void sample(const SteppedRolling& motion, const double* times, std::size_t n, FlowSample* samples) {
    with_integrator(motion, [&](auto integrator) {
        StepView view(motion);
        sample_steps(integrator, motion.steps, times, n,
                     [&](std::size_t i, const Knot<2>& knot, const Vector<2>& change) {
                         samples[i] = view(knot, change);
                     });
    });
}

std::vector<Invariants> invariants(const SteppedRolling& motion, long evaluations) {
    const RollingEquation& f = motion.equation;
    PathSeries path(motion.axes);
    const double path_before = f.is_level() ? 0.0 : path(motion.steps.knots.front().y[0]);
    std::vector<Invariants> found;
    with_integrator(motion, [&](auto integrator) {
        survey(integrator, motion.steps, evaluations,
               [&](const Knot<2>& knot, const Vector<2>& change) {
                   const Vector<2> y = knot.y + (knot.carry + change);
                   // The path of the centre, which changes the energy on a slope only.
                   const double x = f.is_level() ? 0.0
                                                 : knot.periods * motion.half_turn_path +
                                                       (path(y[0]) - path_before);
                   found.push_back({f.energy(geometry(motion.axes, y[0]), y[1], x), 0.0});
               });
    });
    return found;
}

}  // namespace rolling_ellipse
