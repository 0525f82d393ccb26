// The state of a body on or over the ground, and the force of the ground on it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

#include "geometry/ellipse.hpp"
#include "scene/field.hpp"

namespace rolling_ellipse {

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

inline constexpr Field<State> state_fields[] = {
    {"theta", &State::theta, unit::angle}, {"omega", &State::omega, unit::angular_velocity},
    {"x", &State::x, unit::length},        {"z", &State::z, unit::length},
    {"x_dot", &State::x_dot, unit::speed}, {"z_dot", &State::z_dot, unit::speed}};

inline bool is_finite(const State& state) {
    return std::all_of(std::begin(state_fields), std::end(state_fields),
                       [&](const auto& field) { return std::isfinite(state.*field.number); });
}

// Whether the contact has no slip.
inline bool rolls(const State& state) {
    return state.mode == Mode::rolling || state.mode == Mode::rest;
}

struct ContactForce {
    double normal;    // [N]
    double friction;  // [N], on the body, along x
};

inline constexpr Field<ContactForce> force_fields[] = {
    {"normal_force", &ContactForce::normal, unit::force},
    {"friction_force", &ContactForce::friction, unit::force}};

struct ContactSample {
    State state;
    ContactForce force;
};

// An angular velocity below 1e-100 rad/s counts as rest. An angle of that size counts as 0 if its
// square matters, which is not a normal double.
inline double zero_if_negligible(double value) {
    return value > -1e-100 && value < 1e-100 ? 0.0 : value;
}

// Whether two numbers are equal within the rounding of a few operations.
inline bool nearly_equal(double value, double target) {
    const double ulp =
        std::max(epsilon * std::abs(target), std::numeric_limits<double>::denorm_min());
    return std::abs(value - target) <= equal_ulps * ulp;
}

// Velocity along the ground of the material point at the contact.
inline double slip_velocity(const State& state, const Geometry& at) {
    return state.x_dot - at.h * state.omega;
}

// The state of a body that stays in contact.
inline State in_contact(const Geometry& at, double theta, double omega, double x, double slip,
                        Mode mode) {
    return {theta, omega, x, at.h, slip + at.h * omega, at.dh * omega, mode};
}

// The acceleration c into the ground that the lowest point has without a contact force: gravity
// into the ground and h'' omega^2, physics (43, 53).
inline double free_acceleration(const Geometry& at, double gravity_into_ground, double omega) {
    return gravity_into_ground + at.ddh * omega * omega;
}

// Whether the free acceleration is 0 within rounding.
inline bool is_weightless(const Geometry& at, double gravity_into_ground, double omega) {
    return nearly_equal(-at.ddh * omega * omega, gravity_into_ground);
}

}  // namespace rolling_ellipse
