// The parts of the Python module. Only this folder knows Python: numbers in, NumPy arrays out, no
// arithmetic.
#pragma once

#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <string>

#include "bindings/arrays.hpp"

namespace rolling_ellipse::bindings {

// A class of the core. It is neither pickled nor copied, since the Python objects that hold it make
// it again: left to itself, pybind11 ends the process where the old protocols 0 and 1 ask it for an
// instance of the base of all its classes.
template <class T>
py::class_<T> bind_class(py::module_& m, const char* name) {
    py::class_<T> bound(m, name);
    bound.def("__reduce__", [name = std::string(name)](const py::object&) -> py::object {
        throw py::type_error("_core." + name + " cannot be pickled or copied");
    });
    return bound;
}

void bind_geometry(py::module_& m);
void bind_scene(py::module_& m);
void bind_certificate(py::module_& m);
void bind_flow(py::module_& m);
void bind_settings(py::module_& m);
void bind_solution(py::module_& m);
void bind_batch(py::module_& m);
void bind_details(py::module_& m);
void bind_tableaus(py::module_& m);
void bind_build(py::module_& m);

}  // namespace rolling_ellipse::bindings
