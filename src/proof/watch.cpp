#include "proof/watch.hpp"

#include <array>
#include <cmath>

#include "integrator/first_negative.hpp"
#include "integrator/system.hpp"
#include "proof/law.hpp"

namespace rolling_ellipse {
namespace {

// Takes the forces in the order of time.
class Watcher {
  public:
    Watcher(double friction, const ForcesAt& forces_at)
        : friction_(friction), forces_at_(forces_at) {}

    void take(double t, const ContactForce& force) {
        note_extremes(t, force);
        if (violation_.found() < infinity) return;
        violation_.look(t, [this](double time) { return std::array<double, 1>{margin_at(time)}; });
        watch_.holds_until = violation_.found();
    }

    const ContactWatch& result() const { return watch_; }

  private:
    double margin_at(double t) const {
        ContactForce force{};
        forces_at_(&t, 1, &force);
        return law_margin(force, friction_);
    }

    void note_extremes(double t, const ContactForce& force) {
        const double needed = friction_needed(force);
        if (force.normal < watch_.smallest_normal_force) {
            watch_.smallest_normal_force = force.normal;
            watch_.smallest_normal_force_time = t;
        }
        if (needed > watch_.largest_friction_needed) {
            watch_.largest_friction_needed = needed;
            watch_.largest_friction_needed_time = t;
        }
    }

    const double friction_;
    const ForcesAt& forces_at_;
    ContactWatch watch_{infinity, 0.0, 0.0, 0.0, infinity};
    FirstNegative<1> violation_;
};

}  // namespace

ContactWatch watch_contact(double friction, const std::vector<double>& times,
                           const ForcesAt& forces_at, const Checkpoint& checkpoint) {
    Watcher watcher(friction, forces_at);
    std::array<double, looks_per_step> looks{};
    std::array<ContactForce, looks_per_step> forces{};
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool is_end = i + 1 == times.size();
        const double h = is_end ? 0.0 : (times[i + 1] - times[i]) / looks_per_step;
        const int count = is_end ? 1 : looks_per_step;
        for (int j = 0; j < count; ++j) looks[j] = times[i] + j * h;
        forces_at(looks.data(), count, forces.data());
        for (int j = 0; j < count; ++j) watcher.take(looks[j], forces[j]);
        if (i % steps_between_checks == 0) checkpoint();
    }
    return watcher.result();
}

}  // namespace rolling_ellipse
