#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>

#include "scene/impact.hpp"

namespace rolling_ellipse {
namespace {

constexpr double aspect_limit = 1e3;
constexpr double blow_margin = 1e-12;  // allowed for rounding, as a fraction of the long semi-axis

// Rejects a moment of inertia, or k^2, if k^2 is out of bounds relative to the square of the long
// semi-axis. The k^2 of a valid scene is therefore valid for a body, too.
void require_inertia(std::string_view name, std::string_view kind, double value, const Body& body,
                     std::string_view unit_name) {
    constexpr double least = 1e-6;
    constexpr double most = 1e6;
    if (!(value > 0 && std::isfinite(value)))
        refuse(name, "a positive finite " + std::string(kind), value);
    const double share = body.gyration2 / square(std::max(body.a, body.b));
    constexpr double rounding = equal_ulps * epsilon;
    if (!(share >= least * (1 - rounding) && share <= most * (1 + rounding))) {
        refuse(name, "between 1e-6 and 1e6 times " + std::string(unit_name), value);
    }
}

// Rejects a blow whose line of action misses the body. The tangents parallel to that line are at
// the distance `reach` from the centre: h of physics (1), in the direction across the line.
void require_reach(const Scene& scene, const Geometry& at, const Impulse& blow,
                   const std::string& name) {
    const double larger = std::max(std::abs(blow.jx), std::abs(blow.jz));
    if (larger == 0) return;
    const double jx = blow.jx / larger;  // scaled so that its square does not overflow
    const double jz = blow.jz / larger;
    const double size = root_of_squares(jx, jz);
    const double across_x = -jz / size;
    const double across_z = jx / size;
    const double reach = root_of_squares(scene.a * (across_x * at.cos - across_z * at.sin),
                                         scene.b * (across_x * at.sin + across_z * at.cos));
    const double distance = std::abs(blow.dx * across_x + blow.dz * across_z);
    if (distance <= reach + blow_margin * std::max(scene.a, scene.b)) return;
    refuse(name,
           "along a line that meets the body, at most " + text(reach) +
               " [m] from its centre at this angle and direction",
           distance);
}

// Rejects a start in which the body touches the ground and moves into it.
void require_no_approach(const State& start, const Geometry& at) {
    const double rolling = at.dh * start.omega;
    if (start.z != at.h || start.z_dot >= rolling) return;
    refuse("z_dot",
           "at least h'(theta)*omega = " + text(rolling) +
               " [m/s] while touching the ground (a smaller value moves into it)",
           start.z_dot);
}

void require_in_size(const char* name, const Unit& unit, std::optional<double> value, double most) {
    if (!value) return;
    require_finite(name, unit, *value);
    if (std::abs(*value) <= most) return;
    refuse(name, "at most +-" + text(most) + in_brackets(unit) + " for this body", *value);
}

}  // namespace

double* SceneField::of(Scene& scene) const {
    if (const auto* at = std::get_if<double Scene::*>(&number)) return &(scene.**at);
    auto& given = scene.*std::get<std::optional<double> Scene::*>(number);
    return given ? &*given : nullptr;
}

void SceneField::set(Scene& scene, std::optional<double> value) const {
    if (!value && otherwise) value = otherwise(scene);
    if (const auto* at = std::get_if<double Scene::*>(&number)) {
        scene.** at = value.value_or(std::nan(""));
    } else {
        scene.*std::get<std::optional<double> Scene::*>(number) = value;
    }
}

Scene scene_of(const SceneNumbers& numbers, const std::optional<Impulse>& impulse) {
    Scene scene{};
    scene.impulse = impulse;
    auto number = numbers.begin();
    for (const SceneField& field : scene_fields) field.set(scene, *number++);
    return scene;
}

Scene level_scene(const Body& body, double friction) {
    Scene scene = scene_of();
    scene.a = body.a;
    scene.b = body.b;
    scene.mass = 1.0;
    scene.gravity = body.gravity;
    scene.inertia = body.gyration2;
    scene.slope = 0.0;
    scene.friction = friction;
    scene.rolling_resistance = 0.0;
    return scene;
}

bool is_held(const Scene& scene, const Geometry& at) {
    const double incline = std::tan(scene.slope);
    return is_within(scene.rolling_resistance, at.dh, -incline * at.h) ||
           is_equilibrium(at, incline);
}

Units natural_units(const Body& body, double mass) {
    const double long_axis = std::max(body.a, body.b);
    const int time2 = std::ilogb(long_axis / body.gravity);
    return {std::ldexp(1.0, std::ilogb(long_axis)), std::ldexp(1.0, time2 >> 1),
            std::ldexp(1.0, std::ilogb(mass))};
}

Scene in_units(Scene scene, const Units& units) {
    const Units inverse = units.inverse();
    for (const SceneField& field : scene_fields) {
        if (double* const number = field.of(scene)) *number *= inverse.of(field.unit);
    }
    return scene;
}

State in_units(const State& state, const Units& units) { return in_si(state, units.inverse()); }

void validate_length(std::string_view name, double value) {
    require_positive(name, "length [m]", value);
}

void validate_axes(double a, double b) {
    validate_length("a", a);
    validate_length("b", b);
    const double ratio = a / b;
    if (!(ratio <= aspect_limit * (1 + epsilon) && ratio * aspect_limit >= 1 - epsilon)) {
        refuse("a/b", "between 1e-3 and 1e3", ratio);
    }
}

void validate(const Body& body) {
    validate_axes(body.a, body.b);
    require_positive("gravity", "acceleration [m/s^2]", body.gravity);
    require_inertia("gyration2", "area [m^2]", body.gyration2, body, "max(a, b)^2");
}

void validate_motion(const Body& body, double theta, double omega, double most) {
    require_finite("theta", unit::angle, theta);
    const double axis = std::max(body.a, body.b);
    const double energy = most * (body.gravity * axis);
    require_in_size("omega", unit::angular_velocity, omega,
                    std::sqrt(energy / (body.gyration2 + square(axis))));
}

void validate_friction(double friction) {
    constexpr double most = 1e6;
    if (!(friction >= 0 && (friction <= most || friction == infinity))) {
        refuse("friction", "a coefficient from 0 to 1e6, or inf", friction);
    }
}

void require_no_resistance(const Scene& scene, std::string_view who, std::string_view instead) {
    if (scene.rolling_resistance == 0) return;
    refuse("rolling_resistance", "0 for " + std::string(who) + " (" + std::string(instead) + ")",
           scene.rolling_resistance);
}

void validate(const Impulse& impulse) {
    for (const auto& [name, number, unit] : impulse_fields) {
        require_finite(name, unit, impulse.*number);
    }
}

void validate_slope(double slope) {
    constexpr double steepest = 1.5;
    if (std::abs(slope) <= steepest) return;
    const char* const hint = std::abs(slope) <= 90 ? " (degrees? times pi/180)" : "";
    refuse("slope", std::string("an angle [rad] from -1.5 to 1.5") + hint, slope);
}

void validate(const Scene& scene, Origin origin) {
    const double most = origin == Origin::typed ? most_energy : 1e100;
    validate_axes(scene.a, scene.b);
    require_positive("mass", "mass [kg]", scene.mass);
    require_positive("gravity", "acceleration [m/s^2]", scene.gravity);
    require_inertia("inertia", "moment of inertia [kg m^2]", scene.inertia, scene.body(),
                    "mass max(a, b)^2");
    validate_slope(scene.slope);
    validate_friction(scene.friction);
    if (!(scene.restitution >= 0 && scene.restitution <= 1)) {
        refuse("restitution", "between 0 and 1", scene.restitution);
    }
    const double most_lever = 0.5 * std::min(scene.a, scene.b);
    if (!(scene.rolling_resistance >= 0 && scene.rolling_resistance <= most_lever)) {
        refuse("rolling_resistance",
               "a lever [m] from 0 to half the short semi-axis, " + text(most_lever),
               scene.rolling_resistance);
    }
    const Body body = scene.body();
    validate_motion(body, scene.theta, scene.omega, most);
    require_finite("x", unit::length, scene.x);
    const double axis = std::max(scene.a, scene.b);
    const double most_speed = std::sqrt(most * scene.gravity * axis);
    require_in_size("z", unit::length, scene.z, most * axis);
    require_in_size("x_dot", unit::speed, scene.x_dot, most_speed);
    require_in_size("z_dot", unit::speed, scene.z_dot, most_speed);
    const Geometry at = geometry(scene.axes(), scene.theta);
    validate_blow(scene, at);
    const State start = state_before_impulse(scene, at);
    if (origin == Origin::typed) require_no_approach(start, at);
}

void validate_blow(const Scene& scene, const Geometry& at, const std::string& name) {
    if (!scene.impulse) return;
    validate(*scene.impulse);
    require_reach(scene, at, *scene.impulse, name);
    const double energy = energy_after_impulse(scene, at);
    if (energy <= most_energy) return;
    refuse(name,
           "weak enough to leave the body, were it free, a kinetic energy of at most 1e12 times "
           "mass gravity max(a, b)",
           energy);
}

Scene reached(Scene scene, const State& state) {
    scene.impulse.reset();
    for (auto* number : {&scene.z, &scene.x_dot, &scene.z_dot}) number->reset();
    if (!rolls(state)) scene.x_dot = state.x_dot;
    if (state.mode == Mode::flight) {
        scene.z = state.z;
        scene.z_dot = state.z_dot;
    }
    scene.theta = state.theta;
    scene.omega = state.omega;
    scene.x = state.x;
    return scene;
}

State state_before_impulse(const Scene& scene, const Geometry& at) {
    State state{scene.theta, zero_if_negligible(scene.omega), scene.x, at.h, 0.0, 0.0,
                Mode::flight};
    const double z = scene.z.value_or(at.h);
    if (!nearly_equal(z, at.h)) {
        if (z < at.h) {
            refuse("z",
                   "at least h(theta) = " + text(at.h) +
                       " [m], the height at which the "
                       "ellipse touches the ground",
                   z);
        }
        state.z = z;
        state.x_dot = scene.x_dot.value_or(0.0);
        state.z_dot = scene.z_dot.value_or(0.0);
        return state;
    }
    const double rolling_x_dot = at.h * state.omega;  // physics (12)
    const double rolling_z_dot = at.dh * state.omega;
    const double x_dot = scene.x_dot.value_or(rolling_x_dot);
    const double z_dot = scene.z_dot.value_or(rolling_z_dot);
    state.x_dot = is_rolling_speed(x_dot, rolling_x_dot) ? rolling_x_dot : x_dot;
    state.z_dot = nearly_equal(z_dot, rolling_z_dot) ? rolling_z_dot : z_dot;
    if (state.z_dot == rolling_z_dot) {
        const bool at_rest = state.omega == 0 && state.x_dot == 0 && is_held(scene, at);
        state.mode = at_rest                        ? Mode::rest
                     : state.x_dot == rolling_x_dot ? Mode::rolling
                                                    : Mode::sliding;
    }
    return state;
}

}  // namespace rolling_ellipse
