// NumPy arrays in and out, and loops over them without the GIL.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bindings/gil.hpp"

namespace rolling_ellipse::bindings {

namespace py = pybind11;
using namespace pybind11::literals;

// An argument that is not aligned (a field of a record, part of a buffer) is copied on its way in:
// loads through a `const double*` may count on it.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast |
                                      py::detail::npy_api::NPY_ARRAY_ALIGNED_>;
using Range = std::function<void(py::ssize_t, py::ssize_t)>;

// Run body(begin, end) over 0 .. n in chunks, without the GIL; Ctrl-C stops it between chunks.
// What a chunk computes does not depend on which thread takes it: where fewer threads can be
// started than asked for, those that there are do all of the work.
inline constexpr py::ssize_t chunk = 1024;
void run_interruptible(py::ssize_t n, int workers, const Range& body);

// Run body(i, checkpoint) for each i of 0 .. n, one at a time, without the GIL: for work of which
// each piece may be long. Ctrl-C stops all threads at their next checkpoint.
using Piece = std::function<void(py::ssize_t, const std::function<void()>&)>;
void run_each(py::ssize_t n, int workers, const Piece& body);

std::vector<Array> empty_arrays(int count, py::ssize_t n);

// The array, from now on never to be written to by Python: `flags.writeable` takes it as long as
// all else about an array.
py::array read_only(py::array array);

Array matrix(py::ssize_t rows, py::ssize_t columns);
void store(Array& array, py::ssize_t row, const double* values);

// Throws std::invalid_argument naming an array that has not the shape that a function reads.
void require_length(const std::string& name, const Array& array, py::ssize_t n);
void require_matrix(const std::string& name, const Array& array, py::ssize_t rows,
                    py::ssize_t columns);

// Of any number of rows, which is returned.
py::ssize_t require_matrix(const std::string& name, const Array& array, py::ssize_t columns);

// An argument that is an array of n numbers, or one number for all.
struct Argument {
    const double* data;
    py::ssize_t stride;

    double operator[](py::ssize_t i) const { return data[i * stride]; }
};

Argument argument(const std::string& name, const Array& array, py::ssize_t n);

// Arguments by their names.
template <std::size_t Count>
std::array<Argument, Count> arguments_of(const std::array<const char*, Count>& names,
                                         const std::array<Array, Count>& arrays, py::ssize_t n) {
    std::array<Argument, Count> found{};
    for (std::size_t i = 0; i < Count; ++i) found[i] = argument(names[i], arrays[i], n);
    return found;
}

// The same message with the place behind the arguments that are arrays: "a[3]/b must be ...".
std::string at_place(const std::string& message, py::ssize_t place, const char* const* names,
                     const Argument* arguments, std::size_t count);

// Runs what reads the element i of such arguments, and names it in what is refused.
template <std::size_t Count, class Action>
void name_the_place(py::ssize_t i, const std::array<const char*, Count>& names,
                    const std::array<Argument, Count>& of, const Action& action) {
    try {
        action();
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(at_place(error.what(), i, names.data(), of.data(), Count));
    }
}

}  // namespace rolling_ellipse::bindings
