// Conversion to and from NumPy arrays, and interruptible loops over them that run without the GIL.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace rolling_ellipse::bindings {

namespace py = pybind11;
using namespace pybind11::literals;

// An array of contiguous, aligned doubles. Any other argument (a field of a record, part of a
// buffer) is copied first.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast |
                                      py::detail::npy_api::NPY_ARRAY_ALIGNED_>;

// Releases the GIL for a scope. In a daemon thread the scope may end while Python shuts down.
// CPython before 3.14 then ends the thread with pthread_exit, which would unwind our frames and
// release the Python objects in them without the GIL. Our thread waits for the process to end
// instead, as in CPython 3.14.
class GilRelease {
  public:
    GilRelease() : state_(PyEval_SaveThread()) {}
    GilRelease(const GilRelease&) = delete;
    GilRelease& operator=(const GilRelease&) = delete;
    ~GilRelease();

  private:
    PyThreadState* state_;
};

// Checks for Ctrl-C at most every 50 ms and throws Python's exception for it. Checking more often
// would be slow: each check takes the GIL, and waits 5 ms for it if a Python thread is busy. Python
// handles signals only in its main thread, so no other thread checks for them.
class SignalWatch {
  public:
    SignalWatch();
    void operator()();

  private:
    using Clock = std::chrono::steady_clock;
    bool in_main_thread_;
    Clock::time_point last_check_ = Clock::now();
};

// Finds Python's main thread, now and after each fork.
void watch_main_thread();

// Runs body(i, checkpoint) for 0 <= i < n (the pieces), without the GIL. Ctrl-C stops each thread
// at its next checkpoint. If the system cannot start all requested threads, the started ones do all
// the work. If several pieces fail, the exception of the piece with the smallest i is thrown.
using Piece = std::function<void(py::ssize_t, const std::function<void()>&)>;
void run_each(py::ssize_t n, int workers, const Piece& body);

// Splits 0 .. n into chunks and runs body(begin, end) on each; several chunks are the pieces of a
// `run_each`. The results of a chunk do not depend on the thread that computes it.
inline constexpr py::ssize_t chunk = 1024;
using Range = std::function<void(py::ssize_t, py::ssize_t)>;
void run_interruptible(py::ssize_t n, int workers, const Range& body);

// Makes an array read-only. NumPy's `flags.writeable` would double the time of a call.
py::array read_only(py::array array);

// A new array of n doubles, created in half the time that pybind11 takes.
Array vector(py::ssize_t n);
Array matrix(py::ssize_t rows, py::ssize_t columns);
void store(Array& matrix, py::ssize_t row, const double* values);

template <class Number>
py::array_t<Number> array_of(const std::vector<Number>& values) {
    py::array_t<Number> array(static_cast<py::ssize_t>(values.size()));
    std::copy(values.begin(), values.end(), array.mutable_data());
    return array;
}

// Both throw std::invalid_argument, naming the array, if its shape is wrong. require_matrix returns
// the number of rows; it accepts any number unless `rows` is given.
void require_length(const std::string& name, const Array& array, py::ssize_t n);
py::ssize_t require_matrix(const std::string& name, const Array& array, py::ssize_t columns,
                           std::optional<py::ssize_t> rows = {});

// A named argument: an array of n values, or a single value that is used n times.
struct Argument {
    const char* name;
    const double* data;
    py::ssize_t stride;

    double operator[](py::ssize_t i) const { return data[i * stride]; }
};

// An error message with the index inserted after each argument that is an array: "a[3]/b must be
// ...".
std::string with_index(const std::string& message, py::ssize_t index, const Argument* arguments,
                       std::size_t count);

// Several arguments, each an array or a single value; [i] gives element i of each, in order.
template <std::size_t Count>
class Arguments {
  public:
    Arguments(const std::array<const char*, Count>& names, const std::array<Array, Count>& arrays,
              py::ssize_t n) {
        for (std::size_t k = 0; k < Count; ++k) {
            const bool is_one = arrays[k].size() == 1;
            if (!is_one) require_length(names[k], arrays[k], n);
            each_[k] = {names[k], arrays[k].data(), is_one ? 0 : 1};
        }
    }

    std::array<double, Count> operator[](py::ssize_t i) const {
        return std::apply([i](const auto&... each) { return std::array{each[i]...}; }, each_);
    }

    // Calls an action that reads element i of each argument; error messages name the index.
    template <class Action>
    auto naming(py::ssize_t i, const Action& action) const {
        try {
            return action();
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(with_index(error.what(), i, each_.data(), Count));
        }
    }

  private:
    std::array<Argument, Count> each_{};
};

// The results of n calls as an array: (n,) for a number, (n, K) for a vector or matrix with K
// elements.
template <class Number>
struct Results {
    explicit Results(py::ssize_t n) : array(n), to(array.mutable_data()) {}
    void set(py::ssize_t i, Number value) { to[i] = value; }

    py::array_t<Number> array;
    Number* to;
};

template <int Rows, int Columns>
struct Results<Eigen::Matrix<double, Rows, Columns>> {
    static constexpr py::ssize_t size = Rows * Columns;
    using Value = Eigen::Matrix<double, Rows, Columns>;

    explicit Results(py::ssize_t n) : array(matrix(n, size)), to(array.mutable_data()) {}
    void set(py::ssize_t i, const Value& value) { std::copy_n(value.data(), size, to + i * size); }

    Array array;
    double* to;
};

// Calls function(i), which returns a tuple, for 0 <= i < n. Returns a Python tuple of arrays, one
// for each element of the function's tuple.
template <class Function>
py::tuple computed(py::ssize_t n, const Function& function, int workers = 1) {
    using Row = decltype(function(0));
    return std::apply(
        [&](const auto&... part) {
            std::tuple results{Results<std::decay_t<decltype(part)>>(n)...};
            run_interruptible(n, workers, [&results, function](py::ssize_t begin, py::ssize_t end) {
                for (py::ssize_t i = begin; i < end; ++i) {
                    const Row row = function(i);
                    std::apply(
                        [&](auto&... to) {
                            std::apply([&](const auto&... value) { (to.set(i, value), ...); }, row);
                        },
                        results);
                }
            });
            return std::apply([](auto&... each) { return py::make_tuple(each.array...); }, results);
        },
        Row{});
}

// Like `computed`, for a function of named arguments, each with n elements or one.
template <std::size_t Count, class Function>
py::tuple computed_from(py::ssize_t n, const std::array<const char*, Count>& names,
                        const std::array<Array, Count>& arrays, const Function& function) {
    const Arguments<Count> of(names, arrays, n);
    return computed(n, [&](py::ssize_t i) { return std::apply(function, of[i]); });
}

// The arrays that `computed` returns, as a dict by name.
template <std::size_t Count>
py::dict named(const char* const (&names)[Count], const py::tuple& arrays) {
    py::dict found;
    for (std::size_t i = 0; i < Count; ++i) found[names[i]] = arrays[i];
    return found;
}

}  // namespace rolling_ellipse::bindings
