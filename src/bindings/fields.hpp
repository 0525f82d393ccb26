// Tables of fields (scene/field.hpp) for Python: dictionaries by name, and columns.
#pragma once

#include <array>

#include "bindings/arrays.hpp"
#include "contact/segments.hpp"

namespace rolling_ellipse::bindings {

inline constexpr Field<FlowSample> flow_fields[] = {
    {"theta", &FlowSample::theta, unit::angle},
    {"omega", &FlowSample::omega, unit::angular_velocity},
    {"x", &FlowSample::x, unit::length}};

// A named count.
struct Figure {
    const char* name;
    std::int64_t value;
};

// The counts of a solver.
inline std::array<Figure, 4> stats_of(py::ssize_t segments, const StepCounts& counts) {
    return {Figure{"segments", segments}, Figure{"steps", counts.steps},
            Figure{"rejected_steps", counts.rejected}, Figure{"evaluations", counts.evaluations}};
}

// Calls an action with each field of some tables.
template <class Action, class... Tables>
void for_each(const Action& action, const Tables&... tables) {
    const auto all = [&](const auto& table) {
        for (const auto& field : table) action(field);
    };
    (all(tables), ...);
}

template <class... Tables>
py::tuple names_of(const Tables&... tables) {
    py::list names;
    for_each([&](const auto& field) { names.append(field.name); }, tables...);
    return names;
}

// The symbols of the units by the names of the fields.
template <class... Tables>
py::dict units_of(const Tables&... tables) {
    py::dict units;
    for_each([&](const auto& field) { units[field.name] = field.unit.symbol; }, tables...);
    return units;
}

// The numbers of a start by the names of their fields.
inline py::dict numbers_of(const InitialState& start) {
    py::dict numbers;
    for (const auto& field : state_fields) numbers[field.name] = start.state.*field.number;
    for (const auto& field : start_fields) numbers[field.name] = start.*field.number;
    return numbers;
}

// Reads the numbers of a struct from a row; returns the place behind them.
template <class Struct, std::size_t N>
const double* read(Struct& to, const Field<Struct> (&table)[N], const double* from) {
    for (const Field<Struct>& field : table) to.*field.number = *from++;
    return from;
}

}  // namespace rolling_ellipse::bindings
