// Events: an integration that stops once one of several quantities of the state becomes negative.
#pragma once

#include <array>
#include <optional>
#include <tuple>

#include "integrator/first_negative.hpp"
#include "integrator/steps.hpp"

namespace rolling_ellipse {

// To be called after each step (see `integrate`); margins: y -> std::array<double, M>. Looks
// several times into each step, by its dense output.
template <int M, class Integrator, class Margins>
class EventRule {
  public:
    static constexpr int N = Integrator::N;

    EventRule(Integrator& integrator, const Steps<N>& steps, Margins margins)
        : integrator_(integrator), steps_(steps), margins_(margins) {}

    AfterStep operator()(const Point<N>& point) {
        const Knot<N>& from = steps_.knots.back();
        const double h = point.t - from.t;
        before_ = now_;
        now_.emplace(View{from, h, integrator_.dense_output_of_last_step(from.point(), h)});
        const auto at = [this](double t) { return margins_at(t); };
        for (int j = before_ ? 1 : 0; j <= looks_per_step; ++j) {
            const double t = j == looks_per_step ? point.t : from.t + j * h / looks_per_step;
            if (finder_.look(t, at)) return AfterStep::stop;
        }
        return AfterStep::go_on;
    }

    // Time and number of the margin that became negative; infinite if none did.
    double time() const { return finder_.found(); }
    int which() const { return finder_.which(); }

    // Its rate there, by a difference over a share of the step in which the margin is nearly
    // linear.
    double rate() const {
        const double ahead = 1e-3 * now_->h;
        return (margins_at(time())[which()] - margins_at(time() - ahead)[which()]) / ahead;
    }

  private:
    struct View {
        Knot<N> from;
        double h;
        decltype(std::declval<Integrator>().dense_output({}, 0.0)) dense;
    };

    // A dip may lie in the step before.
    std::array<double, M> margins_at(double t) const {
        const View& view = before_ && t < now_->from.t ? *before_ : *now_;
        const Vector<N> change = view.dense.change((t - view.from.t) / view.h);
        return margins_(view.from.y + (view.from.carry + change));
    }

    Integrator& integrator_;
    const Steps<N>& steps_;
    Margins margins_;
    FirstNegative<M> finder_;
    std::optional<View> before_;
    std::optional<View> now_;
};

// The tolerance of motions that have to be integrated; what lies between their steps is right to
// about 1e-13.
inline constexpr Tolerance finest = {1e-15, 1e-17};

// How an integration ended, and where: the time since its start.
struct Until {
    Ending ending;
    double time;  // at which a margin became negative, if that stopped it; infinite else
    int which;    // that margin
    StepCounts counts;
};

// Ends the solution where a margin became negative: the dense output knows the time to its order
// only, a step that ends there to that of the method. Returns the time.
template <class Integrator, int N, class Margins>
double end_at_event(Integrator& integrator, Steps<N>& steps, double t, int which, double rate,
                    const Margins& margins) {
    // Each correction gains the digits that the dense output lacks, 6 or more; one beyond a
    // millionth of the step would mean another root.
    constexpr int corrections = 3;
    constexpr double largest_correction = 1e-6;
    while (steps.knots.back().t >= t && steps.knots.size() > 1) steps.knots.pop_back();
    const Knot<N> from = steps.knots.back();
    const auto step_to = [&](double time) {
        Point<N> point = from.point();
        if (time > from.t) integrator.advance(point, time - from.t);
        point.t = time;
        return point;
    };
    const auto margin = [&](const Point<N>& point) {
        return margins(Vector<N>(point.y + point.carry))[which];
    };
    Point<N> end = step_to(t);
    for (int i = 0; i < corrections; ++i) {
        const double change = -margin(end) / rate;
        const double size = std::abs(change);
        if (!(size <= largest_correction * (end.t - from.t)) || size <= epsilon * end.t) break;
        end = step_to(end.t + change);
    }
    if (end.t > from.t) steps.knots.push_back({end.t, end.y, end.carry, from.periods});
    return end.t;
}

// Integrate from the last knot until a margin becomes negative, or to t_end.
template <class Integrator, int N, class Margins, class Checkpoint>
Until integrate_until(Integrator& integrator, Steps<N>& steps, const Tolerance& tolerance,
                      long max_steps, double t_end, Margins margins, const Checkpoint& checkpoint) {
    constexpr int M = std::tuple_size_v<decltype(margins(Vector<N>{}))>;
    EventRule<M, Integrator, Margins> rule(integrator, steps, margins);
    const std::size_t before = steps.knots.size();
    const Ending ending = integrate(
        integrator, steps, tolerance, max_steps, t_end,
        [&](const Point<N>& point) { return rule(point); }, [](Point<N>&) { return 0.0; },
        checkpoint);
    double time = rule.time();
    if (ending == Ending::event) {
        time = end_at_event(integrator, steps, time, rule.which(), rule.rate(), margins);
    }
    StepCounts counts = integrator.counts();
    counts.steps = static_cast<long>(steps.knots.size() - before);
    return {ending, time, rule.which(), counts};
}

}  // namespace rolling_ellipse
