// Events: an integration that stops once one of several quantities of the state becomes negative.
#pragma once

#include <array>
#include <optional>

#include "first_negative.hpp"
#include "stepped.hpp"

namespace rolling_ellipse {

// To be called after each step (see `integrate`); margins: y -> std::array<double, M>. Looks
// several times into each step, by its dense output.
template <int M, class Integrator, class System, class Margins>
class EventRule {
  public:
    static constexpr int N = System::size;

    EventRule(const System& f, const Steps<N>& steps, Margins margins)
        : integrator_(f), steps_(steps), margins_(margins) {}

    AfterStep operator()(const Point<N>& point) {
        constexpr int looks_per_step = 8;
        const Knot<N>& from = steps_.knots.back();
        const double h = point.t - from.t;
        before_ = now_;
        now_.emplace(View{from, h, integrator_.dense_output(from.point(), h)});
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

    Integrator integrator_;
    const Steps<N>& steps_;
    Margins margins_;
    FirstNegative<M> finder_;
    std::optional<View> before_;
    std::optional<View> now_;
};

}  // namespace rolling_ellipse
