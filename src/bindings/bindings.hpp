// The parts of the Python module. Only this folder knows Python. It converts numbers to NumPy
// arrays and back, and computes nothing.
#pragma once

#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include <string>

#include "bindings/arrays.hpp"

namespace rolling_ellipse::bindings {

// Binds a class of the core. Its objects refuse to be pickled or copied: the Python objects that
// hold them make them again. Without the refusal, pybind11 would end the process under the pickle
// protocols 0 and 1.
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

}  // namespace rolling_ellipse::bindings
