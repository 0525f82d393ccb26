// The parts of the Python module. Only this folder knows Python: numbers in, NumPy arrays out, no
// arithmetic.
#pragma once

#include <pybind11/native_enum.h>
#include <pybind11/stl.h>

#include "arrays.hpp"

namespace rolling_ellipse::bindings {

void bind_geometry(py::module_& m);
void bind_scene(py::module_& m);
void bind_certificate(py::module_& m);
void bind_flow(py::module_& m);
void bind_motion(py::module_& m);
void bind_details(py::module_& m);
void bind_tableaus(py::module_& m);

}  // namespace rolling_ellipse::bindings
