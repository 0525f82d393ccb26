// States and events of the core as rows of NumPy arrays.
#pragma once

#include "bindings/arrays.hpp"
#include "contact/segments.hpp"
#include "geometry/constraints.hpp"
#include "rolling/level/many_times.hpp"

namespace rolling_ellipse::bindings {

// q and q_dot, (n, 5) each; returns n.
py::ssize_t require_coordinates(const Array& q, const Array& q_dot);

// A row of q and q_dot, (n, 5); and the only one.
CoordinateState state_at(const Array& q, const Array& q_dot, py::ssize_t row);
CoordinateState single_state(const Array& q, const Array& q_dot);

// theta, omega, x, z, x_dot, z_dot; returns the place behind them.
double* store_state(const State& state, double* to);

// t, the code of the kind, and the states before and after, each with the code of its mode.
inline constexpr py::ssize_t event_numbers = 16;
double* store_event(const Event& event, double* to);

// theta, omega, x as arrays.
FlowColumns columns(std::vector<Array>& arrays);

}  // namespace rolling_ellipse::bindings
