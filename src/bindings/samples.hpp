// States of the core as rows of NumPy arrays.
#pragma once

#include "bindings/arrays.hpp"
#include "geometry/constraints.hpp"
#include "rolling/flow_table.hpp"

namespace rolling_ellipse::bindings {

// q and q_dot, (n, 5) each; returns n.
py::ssize_t require_coordinates(const Array& q, const Array& q_dot);

// A row of q and q_dot, (n, 5); and the only one.
CoordinateState state_at(const Array& q, const Array& q_dot, py::ssize_t row);
CoordinateState single_state(const Array& q, const Array& q_dot);

// theta, omega, x as arrays.
FlowColumns columns(std::vector<Array>& arrays);

}  // namespace rolling_ellipse::bindings
