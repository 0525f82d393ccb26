// NumPy arrays in and out; loops over them without the GIL, which Ctrl-C stops.
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

// An array of doubles that are contiguous and aligned. Any other argument (a field of a record,
// part of a buffer) is copied first.
using Array = py::array_t<double, py::array::c_style | py::array::forcecast |
                                      py::detail::npy_api::NPY_ARRAY_ALIGNED_>;

// Releases the GIL for a scope. In a daemon thread the scope may end while Python shuts down. Then
// CPython before 3.14 ends the thread by pthread_exit, which would unwind our frames and release
// Python objects in them without the GIL. Our thread waits for the end of the process instead, as
// in CPython 3.14.
class GilRelease {
  public:
    GilRelease() : state_(PyEval_SaveThread()) {}
    GilRelease(const GilRelease&) = delete;
    GilRelease& operator=(const GilRelease&) = delete;
    ~GilRelease();

  private:
    PyThreadState* state_;
};

// Checks for Ctrl-C at most every 50 ms, and throws it as Python's exception. More checks would be
// slow: each takes the GIL, for which a busy Python thread makes it wait 5 ms. Python handles
// signals in its main thread only: in any other thread nothing is checked.
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

// Runs body(i, checkpoint) for each i of 0 .. n, without the GIL. Ctrl-C stops each thread at its
// next checkpoint. Where the system cannot start as many threads as requested, those that there are
// do all of the work. If several pieces fail, the exception of the earliest one is thrown.
using Piece = std::function<void(py::ssize_t, const std::function<void()>&)>;
void run_each(py::ssize_t n, int workers, const Piece& body);

// Runs body(begin, end) over 0 .. n in chunks, as `run_each` does its pieces. The results of a
// chunk do not depend on the thread that takes it.
inline constexpr py::ssize_t chunk = 1024;
using Range = std::function<void(py::ssize_t, py::ssize_t)>;
void run_interruptible(py::ssize_t n, int workers, const Range& body);

// Makes an array read-only. `flags.writeable` of NumPy would take as long as all else.
py::array read_only(py::array array);

// A new array of n numbers, in half the time that pybind11 takes to make one.
Array vector(py::ssize_t n);
Array matrix(py::ssize_t rows, py::ssize_t columns);
void store(Array& matrix, py::ssize_t row, const double* values);

template <class Number>
py::array_t<Number> array_of(const std::vector<Number>& values) {
    return py::array_t<Number>(static_cast<py::ssize_t>(values.size()), values.data());
}

// Refuse an array of another shape: std::invalid_argument with its name. require_matrix takes any
// number of rows unless one is given, and returns the number.
void require_length(const std::string& name, const Array& array, py::ssize_t n);
py::ssize_t require_matrix(const std::string& name, const Array& array, py::ssize_t columns,
                           std::optional<py::ssize_t> rows = {});

// A named argument: an array of n numbers, or one number for all.
struct Argument {
    const char* name;
    const double* data;
    py::ssize_t stride;

    double operator[](py::ssize_t i) const { return data[i * stride]; }
};

// The message of a refusal with the index behind each argument that is an array: "a[3]/b must be
// ...".
std::string with_index(const std::string& message, py::ssize_t index, const Argument* arguments,
                       std::size_t count);

// Several arguments, each an array or one number; [i] gives the element i of each, in their order.
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

    // Calls an action that reads the elements i; a refusal names their index.
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

// The results of n calls as an array: (n,) for a number, (n, K) for a vector or matrix of K
// numbers.
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

// Calls function(i), which returns a tuple, for each i of 0 .. n. Returns an array for each part of
// the tuple, as a Python tuple.
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

// `computed` for a function of named arguments, each with n elements, or one.
template <std::size_t Count, class Function>
py::tuple computed_from(py::ssize_t n, const std::array<const char*, Count>& names,
                        const std::array<Array, Count>& arrays, const Function& function) {
    const Arguments<Count> of(names, arrays, n);
    return computed(n, [&](py::ssize_t i) { return std::apply(function, of[i]); });
}

// The arrays of `computed` by names.
template <std::size_t Count>
py::dict named(const char* const (&names)[Count], const py::tuple& arrays) {
    py::dict found;
    for (std::size_t i = 0; i < Count; ++i) found[names[i]] = arrays[i];
    return found;
}

}  // namespace rolling_ellipse::bindings
