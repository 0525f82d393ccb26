// Python functions whose most common calls take a shortcut through C++.
#pragma once

#include "bindings/arrays.hpp"

namespace rolling_ellipse::bindings {

// Returns the result of a call, given the values of all arguments, in the order of the signature,
// and their defaults (null for an argument without a default). Returns null, without setting a
// Python error, to decline the call.
using ShortWay = PyObject* (*)(PyObject* const* values, PyObject* const* defaults);

// The given function with a shortcut for calls with one positional argument, no unknown names and
// no missing arguments. Calls that are declined go to the function itself, which raises any errors.
// Attributes, signature, help, source and pickle are those of the function.
py::object shortened(const py::function& function, ShortWay way);

}  // namespace rolling_ellipse::bindings
