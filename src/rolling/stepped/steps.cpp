#include "rolling/stepped/steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "integrator/implicit.hpp"
#include "integrator/runge_kutta.hpp"
#include "numerics/series.hpp"
#include "numerics/wide.hpp"

namespace rolling_ellipse {
namespace {

constexpr int default_stages = 4;

// Calls an action with the integrator of a motion.
template <class Action>
void with_integrator(const SteppedRolling& motion, Action action) {
    const RollingEquation& f = motion.equation;
    const Method method = motion.settings.method;
    if (method == Method::radau) return action(Radau<RollingEquation>(f));
    if (method == Method::gauss) {
        const int stages = motion.settings.stages.value_or(default_stages);
        if (stages == 2) return action(Gauss<2, RollingEquation>(f));
        if (stages == 3) return action(Gauss<3, RollingEquation>(f));
        return action(Gauss<4, RollingEquation>(f));
    }
    with_tableau(method, [&](auto tableau) {
        action(ExplicitMethod<decltype(tableau), RollingEquation>(f));
    });
}

// The values of a series about `middle` at four points.
ROLLING_ELLIPSE_WIDE void four_values(const Series& series, double middle, const double* places,
                                      double* values) {
    Quad z;
    std::memcpy(&z, places, sizeof z);
    z = value(series, z - middle);
    std::memcpy(values, &z, sizeof z);
}

// The path of the centre at many angles, each usually close to the previous one. Each interval of
// angles has a Taylor series of the integral of h, physics (9). The intervals are stored, since a
// body that rolls over passes through the same ones in each half turn.
class PathSeries {
  public:
    explicit PathSeries(const Axes& axes)
        : axes_(axes),
          c2_(axes.c2()),
          off_axis_(std::atanh(std::fmin(axes.a, axes.b) / std::fmax(axes.a, axes.b))) {}

    // centre_path(theta) to within 2 ulp. The bits depend neither on earlier calls nor on the sign
    // of theta.
    double operator()(double theta) {
        if (!here_.is_inside(theta)) move_to(theta);
        return value(here_.path, theta - here_.middle);
    }

    // The paths at n angles, computed four at a time where the angles share an interval.
    void operator()(const double* thetas, std::size_t n, double* paths) {
        const auto is_here = [this](double theta) { return here_.is_inside(theta); };
        for (std::size_t i = 0; i < n;) {
            if (n - i >= 4 && std::all_of(thetas + i, thetas + i + 4, is_here)) {
                four_values(here_.path, here_.middle, thetas + i, paths + i);
                i += 4;
            } else {
                paths[i] = (*this)(thetas[i]);
                ++i;
            }
        }
    }

  private:
    struct Interval {
        double low = 1.0;  // the interval is empty before the first call
        double high = 0.0;
        double middle = 0.0;
        Series path{};

        // False at the ends; for them, `move_to` selects the interval.
        bool is_inside(double theta) const { return low < theta && theta < high; }

        // The mirrored interval, for angles of the opposite sign.
        Interval mirrored() const {
            Interval found{-high, -low, -middle, path};
            for (int k = 0; k <= series_order; k += 2) found.path[k] = -path[k];
            return found;
        }
    };

    void move_to(double theta) {
        here_ = around(std::abs(theta));
        if (theta < 0) here_ = here_.mirrored();
    }

    Interval around(double angle) {
        constexpr std::size_t most_known = 256;  // limit on stored intervals; a thin body needs 100
        if (!(angle <= largest_in_quarters)) {
            return {angle, angle, angle, {centre_path(axes_, angle)}};
        }
        for (const Interval& interval : known_) {
            if (interval.low <= angle && angle < interval.high) return interval;
        }
        if (known_.size() == most_known) known_.clear();
        return known_.emplace_back(interval_at(angle));
    }

    // Distance of an angle from the nearest complex root of h: the radius of convergence there.
    double distance(double angle) const {
        const auto [rest, odd] = nearest_quarter(angle);
        const bool by_flat = odd == (c2_ < 0);
        return root_of_squares(by_flat ? std::abs(rest) : half_pi - std::abs(rest), off_axis_);
    }

    // An interval that contains an angle, obtained by halving [n, n + 1) until the width is at most
    // 1/3.5 of the distance from the nearest root of h, so that a series of 17 terms has an error
    // of less than 1e-17 times h times the width.
    Interval interval_at(double angle) const {
        constexpr double share = 3.5;
        Interval interval;
        double width = 2.0;
        do {
            width /= 2;
            interval.low = std::floor(angle / width) * width;
            interval.middle = interval.low + width / 2;
        } while (share * width > distance(interval.middle));
        interval.high = interval.low + width;

        // The series of u = h^2 from u'' = -4 u + constant, then those of h and of its integral,
        // the path
        const double s = std::sin(interval.middle);
        const double c = std::cos(interval.middle);
        Series u;
        u[0] = square(axes_.a * s) + square(axes_.b * c);
        u[1] = 2 * c2_ * s * c;
        u[2] = c2_ * ((c - s) * (c + s));
        for (int k = 3; k <= series_order; ++k) u[k] = -4 * u[k - 2] / (k * (k - 1));
        Series h;
        h[0] = std::sqrt(u[0]);
        const double half = 0.5 / h[0];
        interval.path[0] = centre_path(axes_, interval.middle);
        interval.path[1] = h[0];
        for (int k = 1; k < series_order; ++k) {
            h[k] = half * (u[k] - self_product(h, k, 1));
            interval.path[k + 1] = h[k] / (k + 1);
        }
        return interval;
    }

    Axes axes_;
    double c2_;
    double off_axis_;  // imaginary part of the roots of h, near the flat positions
    Interval here_;
    std::vector<Interval> known_;
};

// States at points of a motion. The angle at a knot, and the path of the half turns before the
// knot, are computed only once for all points of its step. x is computed later, for several points
// side by side.
class StepView {
  public:
    explicit StepView(const SteppedRolling& motion) : motion_(motion), path_(motion.axes) {}

    void take(const Knot<2>& knot, const Vector<2>& change, FlowSample& sample) {
        if (&knot != knot_) move_to(knot);
        const double rest = knot.y[0] + (knot.carry[0] + change[0]);
        sample.theta = double(theta_ + change[0]);
        sample.omega = knot.y[1] + (knot.carry[1] + change[1]);
        if (change[0] == 0) {
            sample.x = double(motion_.x_base + (path_before_ + centre_path(motion_.axes, rest)));
            return;
        }
        sample.x = path_before_;
        samples_[waiting_] = &sample;
        angles_[waiting_] = rest;
        if (++waiting_ == angles_.size()) finish();
    }

    // Computes x for the waiting samples.
    void finish() {
        std::array<double, most_waiting> paths;
        path_(angles_.data(), waiting_, paths.data());
        for (std::size_t i = 0; i < waiting_; ++i) {
            double& x = samples_[i]->x;
            x = double(motion_.x_base + (x + paths[i]));
        }
        waiting_ = 0;
    }

  private:
    static constexpr std::size_t most_waiting = 16;

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
    double path_before_ = 0.0;                 // path of the half turns before the knot
    std::array<double, most_waiting> angles_;  // the samples' angles, less those half turns
    std::array<FlowSample*, most_waiting> samples_;
    std::size_t waiting_ = 0;
};

// The motion before its first step.
SteppedRolling rolling_from(const Scene& scene, const State& start, const Settings& settings) {
    const Axes axes = scene.axes();
    const double rest = within_a_turn(start.theta);
    const Knot<2> knot{0.0, {rest, start.omega}, Vector<2>::Zero(), 0.0};
    return {RollingEquation(scene.body(), scene.slope),
            axes,
            settings,
            two_sum(start.theta, -rest),
            two_sum(start.x, -centre_path(axes, rest)),
            centre_path(axes, pi),
            {settings.step.value_or(0.0), {knot}}};
}

}  // namespace

Integration<SteppedRolling> integrate_rolling(const Scene& scene, const State& start,
                                              const Settings& settings, double t_end,
                                              const Checkpoint& checkpoint) {
    Integration<SteppedRolling> result{rolling_from(scene, start, settings)};
    result.followed_until = t_end;
    SteppedRolling& motion = result.motion;
    if (start.mode == Mode::rest) return result;
    const auto keep = [](Point<2>&) { return AfterStep::unchanged; };
    const auto reduce = [&](Point<2>& point) {
        const double half_turns = take_half_turns_off(point.y[0], point.carry[0]);
        point.origin[0] += half_turns * pi;
        return half_turns;
    };
    with_integrator(motion, [&](auto integrator) {
        result.ending = integrate(integrator, motion.steps, {settings.rtol, settings.atol},
                                  settings.max_steps, t_end, keep, reduce, checkpoint);
        result.counts = integrator.counts;
    });
    result.followed_until = motion.steps.knots.back().t;
    return result;
}

void sample(const SteppedRolling& motion, const double* times, std::size_t n, FlowSample* samples) {
    with_integrator(motion, [&](auto integrator) {
        StepView view(motion);
        sample_steps(integrator, motion.steps, times, n,
                     [&](std::size_t i, const Knot<2>& knot, const Vector<2>& change) {
                         view.take(knot, change, samples[i]);
                     });
        view.finish();
    });
}

std::vector<Invariants> invariants(const SteppedRolling& motion, long evaluations) {
    const RollingEquation& f = motion.equation;
    PathSeries path(motion.axes);
    const double path_before = f.is_level() ? 0.0 : path(motion.steps.knots.front().y[0]);
    std::vector<Invariants> points;
    with_integrator(motion, [&](auto integrator) {
        survey(integrator, motion.steps, evaluations,
               [&](const Knot<2>& knot, const Vector<2>& change) {
                   const Vector<2> y = knot.y + (knot.carry + change);
                   // The path of the centre, which changes the energy only on a slope.
                   const double x = f.is_level() ? 0.0
                                                 : knot.periods * motion.half_turn_path +
                                                       (path(y[0]) - path_before);
                   points.push_back({f.energy(geometry(motion.axes, y[0]), y[1], x), 0.0});
               });
    });
    return points;
}

}  // namespace rolling_ellipse
