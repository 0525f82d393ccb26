// What is physically there, as plain numbers, and the rules these numbers must obey.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// What the motion on level ground depends on: semi-axes [m], k^2 = I/m [m^2], gravity [m/s^2].
struct Body {
    double a;
    double b;
    double gyration2;
    double gravity;
};

// Applied impulse [N s] at the body point (dx, dz) [m] from the centre, in ground axes.
struct Impulse {
    double jx = 0.0;
    double jz = 0.0;
    double dx = 0.0;
    double dz = 0.0;
};

enum class Mode : std::int8_t { rolling, sliding, flight, rest };

struct State {
    double theta;
    double omega;
    double x;
    double z;
    double x_dot;
    double z_dot;
    Mode mode;
};

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
    // Absent: touching the ground, and moving as rolling does (or at rest, when in the air).
    std::optional<double> z;
    std::optional<double> x_dot;
    std::optional<double> z_dot;
    std::optional<Impulse> impulse;

    Body body() const { return {a, b, inertia / mass, gravity}; }
};

// physics (16)
inline double uniform_disc_gyration2(double a, double b) { return (a * a + b * b) / 4; }

// Slower than 1e-100 rad/s is at rest: its energy is no longer a normal double.
inline double noticeable(double omega) { return omega > -1e-100 && omega < 1e-100 ? 0.0 : omega; }

// "name must be requirement, got value" as the exception that Python shows as ValueError.
[[noreturn]] void refuse(const std::string& name, const std::string& requirement, double value);

// A double as Python prints it.
std::string text(double value);

// Throw std::invalid_argument naming the argument, what was required and what came.
void validate_length(const std::string& name, double value);
void validate_axes(double a, double b);
void validate(const Body& body);
void validate_motion(const Body& body, double theta, double omega);
void validate_velocity(const Body& body, double x_dot, double z_dot);
void validate_friction(double friction);
void validate(const Impulse& impulse);
void validate(const Scene& scene);

// The state before any impulse: absent values filled in; values within 8 ulp of touching or of
// rolling set exactly. Throws where the body is under the ground or moves into it.
State state_before_impulse(const Scene& scene);

}  // namespace rolling_ellipse
