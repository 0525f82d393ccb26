#include "contact_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace rolling_ellipse {
namespace {

constexpr int looks_per_step = 8;

// What is left until rolling ends: of N, and of the friction where there is a limit to it.
double margin(const Scene& scene, const ContactForce& force) {
    if (std::isinf(scene.friction)) return force.normal;
    return scene.friction * force.normal - std::abs(force.friction);
}

double margin_at(const Scene& scene, const SteppedRolling& motion, double t) {
    FlowSample at{};
    sample(motion, &t, 1, &at);
    return margin(scene, rolling_force(scene, at.theta, at.omega));
}

// The first time of a negative margin between one that is not and one that is.
double first_negative(const Scene& scene, const SteppedRolling& motion, double good, double bad) {
    for (;;) {
        const double middle = 0.5 * (good + bad);
        if (!(good < middle && middle < bad)) return bad;
        (margin_at(scene, motion, middle) < 0 ? bad : good) = middle;
    }
}

struct Look {
    double t;
    double margin;
};

// Where the parabola through three looks is least.
double lowest(const Look& a, const Look& b, const Look& c) {
    const double left = (b.margin - a.margin) / (b.t - a.t);
    const double right = (c.margin - b.margin) / (c.t - b.t);
    const double fraction = left / (left - right);
    return a.t + (b.t - a.t) / 2 + fraction * (c.t - a.t) / 2;
}

// Takes the forces in the order of time.
class Watcher {
  public:
    Watcher(const Scene& scene, const SteppedRolling& motion) : scene_(scene), motion_(motion) {}

    void take(double t, const ContactForce& force) {
        note_extremes(t, force);
        if (watch_.holds_until < infinity) return;
        looks_ = {looks_[1], looks_[2], Look{t, margin(scene_, force)}};
        ++count_;
        note_violation();
    }

    const ContactWatch& result() const { return watch_; }

  private:
    void note_extremes(double t, const ContactForce& force) {
        const double friction = std::abs(force.friction);
        const double needed = friction == 0      ? 0.0
                              : force.normal > 0 ? friction / force.normal
                                                 : infinity;
        if (force.normal < watch_.smallest_normal_force) {
            watch_.smallest_normal_force = force.normal;
            watch_.smallest_normal_force_time = t;
        }
        if (needed > watch_.largest_friction_needed) {
            watch_.largest_friction_needed = needed;
            watch_.largest_friction_needed_time = t;
        }
    }

    void note_violation() {
        const auto& [before, middle, now] = looks_;
        if (now.margin < 0) {
            watch_.holds_until =
                count_ == 1 ? now.t : first_negative(scene_, motion_, middle.t, now.t);
        } else if (count_ > 2 && middle.margin < before.margin && middle.margin <= now.margin) {
            const double between = lowest(before, middle, now);
            if (margin_at(scene_, motion_, between) < 0) {
                const double good = between < middle.t ? before.t : middle.t;
                watch_.holds_until = first_negative(scene_, motion_, good, between);
            }
        }
    }

    const Scene& scene_;
    const SteppedRolling& motion_;
    ContactWatch watch_{infinity, 0.0, 0.0, 0.0, infinity};
    std::array<Look, 3> looks_{};
    long count_ = 0;
};

}  // namespace

ContactWatch watch_contact(const Scene& scene, const SteppedRolling& motion,
                           const Checkpoint& checkpoint) {
    constexpr std::size_t steps_between_checks = 1024;
    Watcher watcher(scene, motion);
    const std::vector<RollingKnot>& knots = motion.knots;
    std::array<double, looks_per_step> times{};
    std::array<FlowSample, looks_per_step> states{};
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const bool is_end = i + 1 == knots.size();
        const double h = is_end ? 0.0 : (knots[i + 1].t - knots[i].t) / looks_per_step;
        const int looks = is_end ? 1 : looks_per_step;
        for (int j = 0; j < looks; ++j) times[j] = knots[i].t + j * h;
        sample(motion, times.data(), looks, states.data());
        for (int j = 0; j < looks; ++j) {
            watcher.take(times[j], rolling_force(scene, states[j].theta, states[j].omega));
        }
        if (i % steps_between_checks == 0) checkpoint();
    }
    return watcher.result();
}

}  // namespace rolling_ellipse
