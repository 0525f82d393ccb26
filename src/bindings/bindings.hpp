// The parts of the Python module. Only this folder depends on Python; it converts values to NumPy
// arrays and back and leaves the mechanics to the core.
#pragma once

#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <array>
#include <cmath>
#include <string>

#include "bindings/arrays.hpp"
#include "contact/segments.hpp"
#include "geometry/constraints.hpp"
#include "simulate.hpp"

namespace rolling_ellipse::bindings {

// Binds a class of the core. Its objects cannot be pickled or copied; the Python objects that own
// them create new ones instead. Without `__reduce__`, pybind11 would abort the process under pickle
// protocols 0 and 1.
template <class T>
py::class_<T> bind_class(py::module_& m, const char* name) {
    py::class_<T> bound(m, name);
    bound.def("__reduce__", [name = std::string(name)](const py::object&) -> py::object {
        throw py::type_error("_core." + name + " cannot be pickled or copied");
    });
    return bound;
}

// Binds an enum with the names of its values.
template <class Enum>
void bind_enum(py::module_& m, const char* name, const char* base, const char* doc) {
    py::native_enum<Enum> bound(m, name, base, doc);
    int code = 0;
    for (const char* each : names<Enum>) bound.value(each, static_cast<Enum>(code++));
    bound.finalize();
}

// An integer and its name.
struct Figure {
    const char* name;
    std::int64_t value;
};

// The counts of an integration, with their names.
inline std::array<Figure, 4> stats_of(py::ssize_t segments, const StepCounts& counts) {
    return {Figure{"segments", segments}, Figure{"steps", counts.steps},
            Figure{"rejected_steps", counts.rejected}, Figure{"evaluations", counts.evaluations}};
}

// Calls an action with each field of the given tables.
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

// The unit symbols by field name.
template <class... Tables>
py::dict units_of(const Tables&... tables) {
    py::dict units;
    for_each([&](const auto& field) { units[field.name] = field.unit.symbol; }, tables...);
    return units;
}

// The values of an initial state by field name.
inline py::dict numbers_of(const InitialState& start) {
    py::dict numbers;
    for (const auto& field : state_fields) numbers[field.name] = start.state.*field.number;
    for (const auto& field : start_fields) numbers[field.name] = start.*field.number;
    return numbers;
}

// Reads the fields of a struct from a row; returns a pointer to the value after them.
template <class Struct, std::size_t N>
const double* read(Struct& to, const Field<Struct> (&table)[N], const double* from) {
    for (const Field<Struct>& field : table) to.*field.number = *from++;
    return from;
}

// The numbers that determine a body's energies and impulses: mass, moment of inertia, k^2,
// gravity, cosine and sine of the slope, friction.
inline std::array<double, 7> body_of(const Scene& scene) {
    const double cosine = std::cos(scene.slope), sine = std::sin(scene.slope);
    const double k2 = scene.body().gyration2;
    return {scene.mass, scene.inertia, k2, scene.gravity, cosine, sine, scene.friction};
}

// The state given by arrays q and q_dot of shape (5,); other shapes are rejected.
CoordinateState single_state(const Array& q, const Array& q_dot);

// An event as a row of numbers: t, the code of its kind, the states before and after, each with the
// code of its mode, and the start_fields.
inline constexpr std::size_t event_numbers =
    2 + 2 * (std::size(state_fields) + 1) + std::size(start_fields);
using EventRow = std::array<double, event_numbers>;
py::tuple event_columns();
Array event_rows(const std::vector<Event>& events);
Event event_of(const EventRow& row);

// How many of the ascending times lie within the solution.
py::ssize_t reached(const Solution& solution, const double* times, py::ssize_t n);

// Arrays of theta, omega and x for n samples.
struct FlowArrays {
    explicit FlowArrays(py::ssize_t n) : theta(vector(n)), omega(vector(n)), x(vector(n)) {}

    py::tuple tuple() const { return py::make_tuple(theta, omega, x); }

    Array theta, omega, x;
    const FlowColumns columns{theta.mutable_data(), omega.mutable_data(), x.mutable_data()};
};

// Columns of contact samples: one for each of state_fields and force_fields, and the modes.
struct ContactColumns {
    std::vector<double*> numbers;
    std::int8_t* modes;

    // Stores samples begin .. end - 1 in the columns; samples[0] is sample `begin`.
    void store(const ContactSample* samples, py::ssize_t begin, py::ssize_t end) const;
};

void bind_states(py::module_& m);
void bind_scene(py::module_& m);
void bind_certificate(py::module_& m);
void bind_flow(py::module_& m);
void bind_solution(py::module_& m);
void bind_batch(py::module_& m);

}  // namespace rolling_ellipse::bindings
