#include "scene/state.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace rolling_ellipse {

bool is_finite(const State& state) {
    return std::all_of(std::begin(state_fields), std::end(state_fields),
                       [&](const auto& field) { return std::isfinite(state.*field.number); });
}

bool nearly_equal(double value, double target) {
    const double ulp =
        std::max(epsilon * std::abs(target), std::numeric_limits<double>::denorm_min());
    return std::abs(value - target) <= equal_ulps * ulp;
}

double slip_velocity(const State& state, const Geometry& at) {
    return state.x_dot - at.h * state.omega;
}

double slip_beyond_rounding(const State& state, const Geometry& at) {
    const double slip = slip_velocity(state, at);
    return std::abs(slip) <= equal_ulps * epsilon * std::abs(state.x_dot) ? 0.0 : slip;
}

State with_angle(const Axes& axes, State state, const Axes& new_axes, double theta) {
    const Geometry before = geometry(axes, state.theta);
    const Geometry after = geometry(new_axes, theta);
    const double omega = state.omega;
    state.theta = theta;
    if (state.z == before.h) state.z = after.h;
    if (state.x_dot == before.h * omega) state.x_dot = after.h * omega;
    if (state.z_dot == before.dh * omega) state.z_dot = after.dh * omega;
    return state;
}

State in_contact(const Geometry& at, double theta, double omega, double x, double slip, Mode mode) {
    return {theta, omega, x, at.h, slip + at.h * omega, at.dh * omega, mode};
}

}  // namespace rolling_ellipse
