// NumPy arrays in and out, and loops over them without the GIL.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <functional>
#include <vector>

#include "flow_table.hpp"
#include "multipliers.hpp"

namespace rolling_ellipse::bindings {

namespace py = pybind11;
using namespace pybind11::literals;

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Range = std::function<void(py::ssize_t, py::ssize_t)>;

// Ctrl-C, as the exception that Python knows.
void check_signals();

// Run body(begin, end) over 0 .. n in chunks, without the GIL; Ctrl-C stops it between chunks.
// What a chunk computes does not depend on which thread takes it.
inline constexpr py::ssize_t chunk = 1024;
void run_interruptible(py::ssize_t n, int workers, const Range& body);

std::vector<Array> empty_arrays(int count, py::ssize_t n);
Array matrix(py::ssize_t rows, py::ssize_t columns);
void store(Array& array, py::ssize_t row, const double* values);

// One argument : an array of n numbers, or one number for all.
struct Argument {
    const double* data;
    py::ssize_t stride;

    double operator[](py::ssize_t i) const { return data[i * stride]; }
};

Argument argument(const Array& array);

// A row of q and q_dot, (n, 5).
CoordinateState state_at(const Array& q, const Array& q_dot, py::ssize_t row);

// theta, omega, x at the times begin .. end.
template <class Sampler>
void store_samples(const Sampler& sampler, const double* times, py::ssize_t begin, py::ssize_t end,
                   double* const columns[3]) {
    std::array<FlowSample, chunk> samples;
    sampler(times + begin, end - begin, samples.data());
    for (py::ssize_t i = begin; i < end; ++i) {
        columns[0][i] = samples[i - begin].theta;
        columns[1][i] = samples[i - begin].omega;
        columns[2][i] = samples[i - begin].x;
    }
}

}  // namespace rolling_ellipse::bindings
