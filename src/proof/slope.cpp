#include "proof/slope.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numerics/bisect.hpp"
#include "numerics/quadrature.hpp"
#include "rolling/stepped/equation.hpp"

namespace rolling_ellipse {
namespace {

// The scene, viewed so that angles grow downhill and the body lies flat at angle 0.
Scene downhill(Scene scene) {
    if (scene.a < scene.b) std::swap(scene.a, scene.b);
    scene.slope = std::abs(scene.slope);
    return scene;
}

// The potential well between two upright equilibria, half a turn apart: W = D omega^2/2 rises up to
// the lying equilibrium and falls beyond it, since dW = (g sin(alpha) h - g cos(alpha) h') dtheta
// by physics (18).
class Well {
  public:
    // The well of a body that rolls from a state.
    Well(const Scene& asked, const State& from)
        : scene_(downhill(asked)),
          axes_(scene_.axes()),
          gravity_(scene_.ground_gravity()),
          gyration2_(scene_.body().gyration2),
          rolling_(scene_.body(), scene_.slope),
          theta_(from.theta),
          side_(std::copysign(1.0, asked.slope)) {
        const auto equilibrium = equilibria(axes_, std::tan(scene_.slope));
        if (!equilibrium) return;
        upright_ = half_pi + equilibrium->upright;
        lying_ = equilibrium->lying;
        const FlatView at = flat_view(asked.axes(), theta_);
        const double angle = side_ * std::atan2(at.sin, at.cos);
        start_ = angle < upright_ ? angle : angle - pi;
        energy_ = 0.5 * inertia(geometry(axes_, start_)) * square(from.omega);
        holds_ = energy(upright_) < 0;
    }

    // Whether the body cannot leave the well.
    bool holds() const { return holds_; }

    void add_extremes(Certificate& certificate) const {
        const double first = bisect(upright_ - pi, std::min(start_, lying_), [&](double at) {
                                 return energy(at) >= 0;
                             }).high;
        const double last = bisect(std::max(start_, lying_), upright_, [&](double at) {
                                return energy(at) < 0;
                            }).low;
        const std::vector<double> at = places(first, last);
        const double light = highest(at, [&](double angle) { return -force(angle).normal; });
        const double rough = highest(at, [&](double angle) { return needed(angle); });
        certificate.smallest_normal_force = force(light).normal;
        certificate.smallest_normal_force_angle = theta_ + side_ * (light - start_);
        certificate.largest_friction_needed = needed(rough);
        certificate.largest_friction_needed_angle = theta_ + side_ * (rough - start_);
    }

  private:
    double inertia(const Geometry& at) const { return inertia_about_contact(gyration2_, at); }

    double energy(double angle) const { return energy_ + gained(angle); }

    // W at an angle minus W at the start. Over small angles, a difference of two heights or paths
    // would be inaccurate, and physics (62) is integrated instead.
    double gained(double angle) const {
        const double turned = angle - start_;
        const Geometry from = geometry(axes_, start_);
        const auto [a, b] = axes_;
        if (std::abs(turned) < 0.1 * b / a) {
            const double pull = scene_.gravity * (a - b) * (a + b);
            const auto rate = [&](double at) {
                const double swung = std::sin(at - lying_) * std::sin(upright_ - at);
                return -pull * swung / geometry(axes_, at).h;
            };
            return double(integrate(gauss_rule(20), start_, angle, rate));
        }
        const double path = centre_path(axes_, angle) - centre_path(axes_, start_);
        const double rise = axes_.c2() * std::sin(angle + start_) * std::sin(turned) /
                            (geometry(axes_, angle).h + from.h);
        return gravity_.along * path - gravity_.into * rise;
    }

    ContactForce force(double angle) const {
        const Geometry at = geometry(axes_, angle);
        const double omega2 = 2 * std::max(energy(angle), 0.0) / inertia(at);
        return rolling_.force(scene_.mass, at, std::sqrt(omega2));
    }

    double needed(double angle) const { return friction_needed(force(angle)); }

    // Evenly spaced angles from first to last, and more angles near the axes of a thin body, where
    // the forces change over angles of b/a and (b/a)^2.
    std::vector<double> places(double first, double last) const {
        constexpr int count = 512;
        std::vector<double> angles{first, last};
        const double thin = axes_.b / axes_.a;
        const double reach = std::asinh(half_pi / (thin * thin));
        for (int i = 1; i < count; ++i) {
            angles.push_back(first + (last - first) * i / count);
            const double offset = thin * thin * std::sinh(reach * (2.0 * i / count - 1));
            for (const double axis : {-pi, -half_pi, 0.0, half_pi}) angles.push_back(axis + offset);
        }
        const auto outside = [&](double at) { return !(at >= first && at <= last); };
        angles.erase(std::remove_if(angles.begin(), angles.end(), outside), angles.end());
        std::sort(angles.begin(), angles.end());
        return angles;
    }

    // The angle at which a measure is largest, from a golden-section search around every angle at
    // which it is at least as large as at both neighbours.
    template <class Measure>
    static double highest(const std::vector<double>& at, const Measure& measure) {
        std::vector<double> values(at.size());
        std::transform(at.begin(), at.end(), values.begin(), measure);
        double place = at.front();
        double most = values.front();
        const auto take = [&](double here, double value) {
            if (!(value > most)) return;
            most = value;
            place = here;
        };
        const std::size_t last = at.size() - 1;
        for (std::size_t i = 0; i <= last; ++i) {
            take(at[i], values[i]);
            const std::size_t low = i == 0 ? 0 : i - 1;
            const std::size_t high = std::min(i + 1, last);
            if (values[low] > values[i] || values[high] > values[i]) continue;
            const double top = golden_section(at[low], at[high], [&](double left, double right) {
                return measure(left) > measure(right);
            });
            take(top, measure(top));
        }
        return place;
    }

    const Scene scene_;
    const Axes axes_;
    const GroundGravity gravity_;
    const double gyration2_;
    const RollingEquation rolling_;
    const double theta_;  // theta of the start
    const double side_;   // +1, or -1 if the slope falls towards negative x
    double upright_ = 0.0;
    double lying_ = 0.0;
    double start_ = 0.0;
    double energy_ = 0.0;  // W at the start
    bool holds_ = false;
};

// The friction needed by a body in equilibrium or by a circle, whose forces are constant; empty for
// all others.
std::optional<double> constant_friction(const Scene& scene, const State& start) {
    const double incline = std::tan(scene.slope);
    const Geometry here = geometry(scene.axes(), start.theta);
    if (start.omega == 0 && is_equilibrium(here, incline)) return std::abs(incline);
    if (scene.a != scene.b) return std::nullopt;
    const double k2 = scene.body().gyration2;
    return std::abs(incline) * k2 / (k2 + square(scene.a));
}

}  // namespace

bool may_hold_for_ever(const Scene& scene, const State& start) {
    return constant_friction(scene, start) || Well(scene, start).holds();
}

Certificate certify_on_slope(const Scene& scene, const State& start, const EndOfRolling& end) {
    if (const auto needed = constant_friction(scene, start)) {
        const double weight = scene.mass * scene.ground_gravity().into;
        return {end, weight, start.theta, *needed, start.theta};
    }
    Certificate found{end, -infinity, std::nullopt, infinity, std::nullopt};
    const Well well(scene, start);
    if (well.holds()) well.add_extremes(found);
    return found;
}

}  // namespace rolling_ellipse
