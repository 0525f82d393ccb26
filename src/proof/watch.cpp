#include <array>
#include <cmath>

#include "integrator/system.hpp"
#include "numerics/bisect.hpp"
#include "proof/certificate.hpp"

namespace rolling_ellipse {
namespace {

constexpr int samples_per_step = 8;

// The law of the contact at samples in ascending time. A dip below zero between two positive
// margins is found by the parabola through three samples.
class Watcher {
  public:
    Watcher(double friction, const ForcesAt& forces_at)
        : friction_(friction), forces_at_(forces_at) {}

    void take(double t, const ContactForce& force) {
        note_extremes(t, force);
        if (watch.holds_until < infinity) return;
        samples_ = {samples_[1], samples_[2], Sample{t, law_margin(force, friction_)}};
        ++count_;
        watch.holds_until = first_negative();
    }

    ContactWatch watch{infinity, 0.0, 0.0, 0.0, infinity};

  private:
    struct Sample {
        double t;
        double margin;
    };

    Sample sample(double t) const {
        ContactForce force{};
        forces_at_(&t, 1, &force);
        return {t, law_margin(force, friction_)};
    }

    void note_extremes(double t, const ContactForce& force) {
        const double needed = friction_needed(force);
        if (force.normal < watch.smallest_normal_force) {
            watch.smallest_normal_force = force.normal;
            watch.smallest_normal_force_time = t;
        }
        if (needed > watch.largest_friction_needed) {
            watch.largest_friction_needed = needed;
            watch.largest_friction_needed_time = t;
        }
    }

    // The first time, up to the last sample, at which the margin is negative.
    double first_negative() const {
        const auto& [before, middle, now] = samples_;
        if (now.margin < 0) return count_ == 1 ? now.t : crossing(middle.t, now.t);
        const bool dips = middle.margin < before.margin && middle.margin <= now.margin;
        if (count_ < 3 || !dips) return infinity;
        const Sample bottom = sample(lowest(before, middle, now));
        if (!(bottom.margin < 0)) return infinity;
        return crossing(bottom.t < middle.t ? before.t : middle.t, bottom.t);
    }

    // The first double with a negative margin between a time with a positive and one with a
    // negative margin.
    double crossing(double good, double bad) const {
        return bisect(good, bad, [this](double t) { return sample(t).margin < 0; }).high;
    }

    // The time of the minimum by the parabola through three samples, then by one through closer
    // samples.
    double lowest(const Sample& a, const Sample& b, const Sample& c) const {
        const double rough = bottom_of_parabola(a, b, c);
        if (!std::isfinite(rough)) return b.t;  // the margins have overflowed
        const double beside = 0.05 * (c.t - a.t);
        if (!(a.t < rough - beside && rough + beside < c.t)) return rough;
        const double fine =
            bottom_of_parabola(sample(rough - beside), sample(rough), sample(rough + beside));
        return std::abs(fine - rough) < beside ? fine : rough;
    }

    static double bottom_of_parabola(const Sample& a, const Sample& b, const Sample& c) {
        const double left = (b.margin - a.margin) / (b.t - a.t);
        const double right = (c.margin - b.margin) / (c.t - b.t);
        return 0.5 * (a.t + b.t) + left / (left - right) * 0.5 * (c.t - a.t);
    }

    const double friction_;
    const ForcesAt& forces_at_;
    std::array<Sample, 3> samples_{};
    long count_ = 0;
};

}  // namespace

ContactWatch watch_contact(double friction, const std::vector<double>& times,
                           const ForcesAt& forces_at, const Checkpoint& checkpoint) {
    Watcher watcher(friction, forces_at);
    std::array<double, samples_per_step> at{};
    std::array<ContactForce, samples_per_step> forces{};
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool is_end = i + 1 == times.size();
        const double h = is_end ? 0.0 : (times[i + 1] - times[i]) / samples_per_step;
        const int count = is_end ? 1 : samples_per_step;
        for (int j = 0; j < count; ++j) at[j] = times[i] + j * h;
        forces_at(at.data(), count, forces.data());
        for (int j = 0; j < count; ++j) watcher.take(at[j], forces[j]);
        if (i % steps_between_checks == 0) checkpoint();
    }
    return watcher.watch;
}

}  // namespace rolling_ellipse
