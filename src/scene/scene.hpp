// Body, ground, start and state as plain structs, and the rules that they must obey.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>
#include <variant>

#include "geometry/ellipse.hpp"
#include "numerics/names.hpp"
#include "scene/field.hpp"

namespace rolling_ellipse {

// A rolling body: semi-axes [m], k^2 = I/m [m^2], gravity [m/s^2].
struct Body {
    double a;
    double b;
    double gyration2;
    double gravity;

    Axes axes() const { return {a, b}; }
};

// An applied impulse (jx, jz) [N s] and its point of application (dx, dz) [m] from the centre, in
// ground axes.
struct Impulse {
    double jx = 0.0;
    double jz = 0.0;
    double dx = 0.0;
    double dz = 0.0;
};

inline constexpr Field<Impulse> impulse_fields[] = {{"jx", &Impulse::jx, unit::impulse},
                                                    {"jz", &Impulse::jz, unit::impulse},
                                                    {"dx", &Impulse::dx, unit::length},
                                                    {"dz", &Impulse::dz, unit::length}};

// Gravity into the ground, g cos(slope), and along it, g sin(slope) [m/s^2].
struct GroundGravity {
    double into;
    double along;
};

inline GroundGravity ground_gravity(double gravity, double slope) {
    return {gravity * std::cos(slope), gravity * std::sin(slope)};
}

// k^2 of a uniform elliptical disc, physics (16): the default for every body.
inline double uniform_disc_gyration2(double a, double b) { return (a * a + b * b) / 4; }

struct Scene {
    double a;
    double b;
    double mass;
    double gravity;
    double inertia;
    double slope;
    double friction;
    double restitution;
    double rolling_resistance;  // lever of the normal force ahead of the contact [m]
    double theta;
    double omega;
    double x;
    // If z is absent, the body touches the ground. An absent velocity is that of rolling, or 0 in
    // the air.
    std::optional<double> z;
    std::optional<double> x_dot;
    std::optional<double> z_dot;
    std::optional<Impulse> impulse;

    Axes axes() const { return {a, b}; }
    Body body() const { return {a, b, inertia / mass, gravity}; }
    GroundGravity ground_gravity() const { return rolling_ellipse::ground_gravity(gravity, slope); }
};

// A field of a Scene, and its default value if it follows from the fields before it.
struct SceneField {
    const char* name;
    std::variant<double Scene::*, std::optional<double> Scene::*> number;
    Unit unit;
    double (*otherwise)(const Scene&) = nullptr;

    // A pointer to the value in the scene; null if the value is absent.
    double* of(Scene& scene) const;
    // A required value that is absent becomes NaN, which `validate` rejects.
    void set(Scene& scene, std::optional<double> value) const;
};

// The fields of a scene, in the column order of tables of scenes and of the files that
// `simulate_many` writes.
inline constexpr SceneField scene_fields[] = {
    {"a", &Scene::a, unit::length},
    {"b", &Scene::b, unit::length},
    {"mass", &Scene::mass, unit::mass},
    {"gravity", &Scene::gravity, unit::acceleration},
    {"slope", &Scene::slope, unit::angle},
    {"friction", &Scene::friction, unit::none},
    {"restitution", &Scene::restitution, unit::none},
    {"rolling_resistance", &Scene::rolling_resistance, unit::length},
    {"theta", &Scene::theta, unit::angle},
    {"omega", &Scene::omega, unit::angular_velocity},
    {"x", &Scene::x, unit::length},
    {"inertia", &Scene::inertia, unit::inertia,
     [](const Scene& s) { return s.mass * uniform_disc_gyration2(s.a, s.b); }},
    {"z", &Scene::z, unit::length},
    {"x_dot", &Scene::x_dot, unit::speed},
    {"z_dot", &Scene::z_dot, unit::speed}};

// The scene with these values, which are in the order of `scene_fields` and are not validated.
// Without arguments, every required value is NaN.
using SceneNumbers = std::array<std::optional<double>, std::size(scene_fields)>;
Scene scene_of(const SceneNumbers& numbers = {}, const std::optional<Impulse>& impulse = {});

// A body of unit mass on level ground; restitution, theta, omega and x are NaN.
Scene level_scene(const Body& body, double friction);

enum class Mode : std::int8_t { rolling, sliding, flight, rest };

template <>
inline constexpr std::array names<Mode>{"ROLLING", "SLIDING", "FLIGHT", "REST"};

struct State {
    double theta;
    double omega;
    double x;
    double z;
    double x_dot;
    double z_dot;
    Mode mode;
};

inline constexpr Field<State> state_fields[] = {
    {"theta", &State::theta, unit::angle}, {"omega", &State::omega, unit::angular_velocity},
    {"x", &State::x, unit::length},        {"z", &State::z, unit::length},
    {"x_dot", &State::x_dot, unit::speed}, {"z_dot", &State::z_dot, unit::speed}};

inline bool is_finite(const State& state) {
    return std::all_of(std::begin(state_fields), std::end(state_fields),
                       [&](const auto& field) { return std::isfinite(state.*field.number); });
}

// Whether the body moves without slip.
inline bool rolls(const State& state) {
    return state.mode == Mode::rolling || state.mode == Mode::rest;
}

struct ContactForce {
    double normal;    // normal force [N]
    double friction;  // friction force on the body, along x [N]
};

inline constexpr Field<ContactForce> force_fields[] = {
    {"normal_force", &ContactForce::normal, unit::force},
    {"friction_force", &ContactForce::friction, unit::force}};

struct ContactSample {
    State state;
    ContactForce force;
};

// Returns 0 for an angular velocity below 1e-100 rad/s in magnitude, which counts as rest. Where
// the square of an angle matters, an angle below 1e-100 rad counts as 0, too.
inline double zero_if_negligible(double value) {
    return value > -1e-100 && value < 1e-100 ? 0.0 : value;
}

// Whether two values are equal to within the rounding errors of a few operations.
inline bool nearly_equal(double value, double target, double ulps = equal_ulps) {
    const double ulp =
        std::max(epsilon * std::abs(target), std::numeric_limits<double>::denorm_min());
    return std::abs(value - target) <= ulps * ulp;
}

// Whether x_dot is h omega, as in rolling, to within eight times the possible rounding error: half
// an ulp each of x_dot and omega, and 3 ulp of the product.
inline bool is_rolling_speed(double x_dot, double h_omega) {
    constexpr double ulps_of_terms = 4;
    return nearly_equal(x_dot, h_omega, equal_ulps * ulps_of_terms);
}

// The largest angle [rad] for which the h and h' of a state on the ground are computed from the
// rounded angle, whose error is then up to 6e-8 rad.
inline constexpr double most_turned = 1e9;

// Eight rounding errors of an angle [rad], of half an ulp each; constant beyond `most_turned`.
inline double angle_roundings(double theta) {
    const double size = std::min(std::abs(resolved(theta)), most_turned);
    return 0.5 * equal_ulps * (std::nextafter(size, infinity) - size);
}

// Velocity along the ground of the material point at the contact.
inline double slip_velocity(const State& state, const Geometry& at) {
    return state.x_dot - at.h * state.omega;
}

// The state of a body that moves on the ground with the velocity x_dot.
inline State on_ground(const Geometry& at, double theta, double omega, double x, double x_dot,
                       Mode mode) {
    return {theta, omega, x, at.h, x_dot, at.dh * omega, mode};
}

inline State without_slip(const Geometry& at, double theta, double omega, double x, Mode mode) {
    return on_ground(at, theta, omega, x, at.h * omega, mode);
}
inline State without_slip(const Axes& axes, double theta, double omega, double x, Mode mode) {
    return without_slip(geometry(axes, theta), theta, omega, x, mode);
}

// The acceleration c of the lowest point into the ground without a contact force: gravity into the
// ground plus h'' omega^2, physics (43, 53).
inline double free_acceleration(const Geometry& at, double gravity_into_ground, double omega) {
    return gravity_into_ground + at.ddh * omega * omega;
}

// The magnitude of dc/dtheta, from h''' = -(3 rho/h + 1) h'.
inline double free_acceleration_rate(const Geometry& at, double omega) {
    return (3 * at.rho / at.h + 1) * std::abs(at.dh) * square(omega);
}

// Whether the free acceleration is 0 to within rounding and an uncertainty `blur` of theta [rad].
inline bool is_weightless(const Geometry& at, double gravity_into_ground, double omega,
                          double blur = 0.0) {
    return std::abs(free_acceleration(at, gravity_into_ground, omega)) <=
           equal_ulps * epsilon * gravity_into_ground + free_acceleration_rate(at, omega) * blur;
}

// Units of a motion: SI units or natural units. Natural units are powers of two near the size, the
// time scale and the mass of the body, which keeps conversions exact and results within the range
// of doubles.
struct Units {
    double length = 1.0;  // unit of length [m]
    double time = 1.0;    // unit of time [s]
    double mass = 1.0;    // unit of mass [kg]

    double speed() const { return length / time; }
    double of(const Unit& unit) const {
        return power(length, unit.length) * power(time, unit.time) * power(mass, unit.mass);
    }
    Units inverse() const { return {1 / length, 1 / time, 1 / mass}; }
    bool are_si() const { return length == 1 && time == 1 && mass == 1; }
};

// The powers of two near the long semi-axis L, sqrt(L/g) and the mass.
Units natural_units(const Body& body, double mass = 1.0);

// Converts a scene, except its impulse, to other units.
Scene in_units(Scene scene, const Units& units);

State in_units(const State& state, const Units& units);

// Converts a state to SI units; written out and inline, since it is called for every sample.
inline State in_si(const State& state, const Units& units) {
    const auto& [theta, omega, x, z, x_dot, z_dot, mode] = state;
    const auto& [length, time, mass] = units;
    const double rate = 1 / time;
    const double speed = length * rate;
    return {theta, omega * rate, x * length, z * length, x_dot * speed, z_dot * speed, mode};
}

inline Body body(double a, double b, std::optional<double> gyration2, double gravity) {
    return {a, b, gyration2.value_or(uniform_disc_gyration2(a, b)), gravity};
}

// Whether a user typed a scene or a motion reached it. In a reached state, the body may have gained
// energy on its way down a slope, and may be about to hit the ground that it touches.
enum class Origin { typed, reached };

// Whether rolling resistance with the lever `resistance` can balance the lever `one` + `other`, to
// within rounding.
inline bool is_within(double resistance, double one, double other) {
    const double rounding = equal_ulps * epsilon * (std::abs(one) + std::abs(other));
    return resistance > 0 && std::abs(one + other) <= resistance + rounding;
}

// Whether a body that neither slips nor turns stays in place, physics (63): its centre must lie
// vertically above the contact patch, which extends from the contact to either side by the lever of
// rolling resistance.
bool is_held(const Scene& scene, const Geometry& at);

// The lever of rolling resistance against a rotation, even one that is only about to start;
// positive if the rotation is clockwise.
inline double lever_against(const Scene& scene, double rotation) {
    return scene.rolling_resistance > 0 ? std::copysign(scene.rolling_resistance, rotation) : 0.0;
}

// The largest energy that a user's scene may have, in units of m g times the long semi-axis.
inline constexpr double most_energy = 1e12;

// These throw std::invalid_argument, naming the argument, the requirement and the value given.
void validate_length(std::string_view name, double value);
void validate_axes(double a, double b);
void validate(const Body& body);
void validate_motion(const Body& body, double theta, double omega, double most = most_energy);
void validate_slope(double slope);
void validate_friction(double friction);
// Throws if there is rolling resistance, which `who` does not support; `instead` names what does.
void require_no_resistance(const Scene& scene, std::string_view who, std::string_view instead);
void validate(const Impulse& impulse);
void validate(const Scene& scene, Origin origin = Origin::typed);

// Throws unless the impulse is finite, its line of action meets the body and the resulting motion
// is not too fast. The error message uses the given name.
void validate_blow(const Scene& scene, const Geometry& at, const std::string& name = "impulse");

// The scene of a body that continues, without an impulse, from a state that its motion has reached.
Scene reached(Scene scene, const State& state);

// The state before any impulse, given the geometry at the scene's angle. Absent values are filled
// in. A height or velocity that matches contact or rolling to within rounding is set to match
// exactly. A body that touches the ground and moves into it counts as flying, since it hits the
// ground at once. Throws if the body is below the ground.
State state_before_impulse(const Scene& scene, const Geometry& at);

}  // namespace rolling_ellipse
