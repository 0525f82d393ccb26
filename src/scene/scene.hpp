// The body, its ground and its start as plain numbers, and the rules that these must obey.
#pragma once

#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>
#include <variant>

#include "geometry/ellipse.hpp"
#include "scene/field.hpp"
#include "scene/state.hpp"

namespace rolling_ellipse {

// The body on level ground: semi-axes [m], k^2 = I/m [m^2], gravity [m/s^2].
struct Body {
    double a;
    double b;
    double gyration2;
    double gravity;

    Axes axes() const { return {a, b}; }
};

// Applied impulse [N s] at the body point (dx, dz) [m] from the centre, in ground axes.
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

// k^2 of a uniform disc, physics (16): the default wherever a body is given.
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
    double theta;
    double omega;
    double x;
    // If absent, the body touches the ground and moves as rolling does (in the air: is at rest).
    std::optional<double> z;
    std::optional<double> x_dot;
    std::optional<double> z_dot;
    std::optional<Impulse> impulse;

    Axes axes() const { return {a, b}; }
    Body body() const { return {a, b, inertia / mass, gravity}; }
    GroundGravity ground_gravity() const { return rolling_ellipse::ground_gravity(gravity, slope); }
};

// A number of a Scene, and its default if that follows from the fields before it.
struct SceneField {
    const char* name;
    std::variant<double Scene::*, std::optional<double> Scene::*> number;
    Unit unit;
    double (*otherwise)(const Scene&) = nullptr;

    std::optional<double> of(const Scene& scene) const;
    // A number that must be given and is absent becomes NaN, which `validate` refuses.
    void set(Scene& scene, std::optional<double> value) const;
};

// The fields of a scene, in the order of the columns of a table of scenes and of the files of
// `simulate_many`.
inline constexpr SceneField scene_fields[] = {
    {"a", &Scene::a, unit::length},
    {"b", &Scene::b, unit::length},
    {"mass", &Scene::mass, unit::mass},
    {"gravity", &Scene::gravity, unit::acceleration},
    {"slope", &Scene::slope, unit::angle},
    {"friction", &Scene::friction, unit::none},
    {"restitution", &Scene::restitution, unit::none},
    {"theta", &Scene::theta, unit::angle},
    {"omega", &Scene::omega, unit::angular_velocity},
    {"x", &Scene::x, unit::length},
    {"inertia", &Scene::inertia, unit::inertia,
     [](const Scene& s) { return s.mass * uniform_disc_gyration2(s.a, s.b); }},
    {"z", &Scene::z, unit::length},
    {"x_dot", &Scene::x_dot, unit::speed},
    {"z_dot", &Scene::z_dot, unit::speed}};

// The scene by its numbers in the order of the table; not validated.
using SceneNumbers = std::array<std::optional<double>, std::size(scene_fields)>;
Scene scene_of(const SceneNumbers& numbers, const std::optional<Impulse>& impulse);

// Units of a body's own size, powers of two: a number in them keeps its bits. Results computed in
// them do not depend on the units of the input and stay in the range of doubles.
struct Units {
    double length = 1.0;  // [m]
    double time = 1.0;    // [s]
    double mass = 1.0;    // [kg]

    double speed() const { return length / time; }
    double of(const Unit& unit) const {
        return power(length, unit.length) * power(time, unit.time) * power(mass, unit.mass);
    }
    bool are_si() const { return length == 1 && time == 1 && mass == 1; }
};

// The powers of two next to the long semi-axis L, sqrt(L/g) and the mass.
Units natural_units(const Body& body, double mass = 1.0);

// A scene in other units, except its impulse.
Scene in_units(const Scene& scene, const Units& units);

State in_units(const State& state, const Units& units);

// Written out and inline, since every sample goes through it.
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

// The largest energies, by m g times the long semi-axis: of a scene that is typed, and of a state
// that a motion has reached, which may have gained energy down a slope.
inline constexpr double most_energy = 1e12;
inline constexpr double most_energy_reached = 1e100;

// Throw std::invalid_argument naming the argument, what was required and what came.
void validate_length(std::string_view name, double value);
void validate_axes(double a, double b);
void validate(const Body& body);
void validate_motion(const Body& body, double theta, double omega, double most = most_energy);
void validate_friction(double friction);
void validate(const Impulse& impulse);
void validate(const Scene& scene, double most = most_energy);

// The impulse must be finite, meet the body and not make it too fast.
void validate_blow(const Scene& scene);

// A height at which the ellipse does not touch the ground, whatever its angle.
inline double above_ground(const Axes& axes) { return axes.a + axes.b; }

// The state before any impulse. Absent values are filled in; values within 8 ulp of touching or of
// rolling are set exactly. Throws if the body is under the ground or moves into it.
State state_before_impulse(const Scene& scene);

}  // namespace rolling_ellipse
