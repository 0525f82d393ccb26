// Python functions whose commonest calls take a short way through C++.
#pragma once

#include "bindings/arrays.hpp"

namespace rolling_ellipse::bindings {

// Answers a call from the values of all arguments, in the order of the signature, and the defaults
// (null for an argument that has none). Declines it by returning null, without a Python error.
using ShortWay = PyObject* (*)(PyObject* const* values, PyObject* const* defaults);

// The given function with a short way for calls with one positional argument, which neither have
// wrong names nor lack an argument. The function itself takes all calls that are declined, and so
// gives their errors. Its attributes, signature, help, source and pickle stay those of the
// function.
py::object shortened(const py::function& function, ShortWay way);

}  // namespace rolling_ellipse::bindings
