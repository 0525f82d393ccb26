// States and events of the core as rows of NumPy arrays.
#pragma once

#include "bindings/fields.hpp"
#include "geometry/constraints.hpp"
#include "rolling/level/many_times.hpp"

namespace rolling_ellipse::bindings {

// q and q_dot, (n, 5) each; returns n.
py::ssize_t require_coordinates(const Array& q, const Array& q_dot);

// The state in a row of q and q_dot, (n, 5).
CoordinateState state_at(const Array& q, const Array& q_dot, py::ssize_t row);

// The state of q and q_dot, (1, 5); refuses other shapes.
CoordinateState single_state(const Array& q, const Array& q_dot);

// An event as a row: t, the code of its kind, and the states before and after, each with the code
// of its mode.
inline constexpr std::size_t event_numbers = 2 + 2 * (std::size(state_fields) + 1);
using EventRow = std::array<double, event_numbers>;
py::tuple event_columns();
Array event_rows(const std::vector<Event>& events);
Event event_of(const EventRow& row);

// theta, omega, x of n samples.
struct FlowArrays {
    explicit FlowArrays(py::ssize_t n) : theta(n), omega(n), x(n) {}

    FlowColumns columns() { return {theta.mutable_data(), omega.mutable_data(), x.mutable_data()}; }
    py::tuple tuple() const { return py::make_tuple(theta, omega, x); }

    Array theta, omega, x;
};

// Columns of contact samples: for each number of state_fields and force_fields, and for the modes.
struct ContactColumns {
    std::vector<double*> numbers;
    std::int8_t* modes;

    // Stores the samples begin .. end, which stand from `samples` on.
    void store(const ContactSample* samples, py::ssize_t begin, py::ssize_t end) const;
};

}  // namespace rolling_ellipse::bindings
