#include "bindings/arrays.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <stdexcept>
#include <thread>

namespace rolling_ellipse::bindings {

namespace {

std::string shape_of(const Array& array) {
    std::string text = "(";
    for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
        text += (axis == 0 ? "" : ", ") + std::to_string(array.shape(axis));
    }
    return text + (array.ndim() == 1 ? ",)" : ")");
}

[[noreturn]] void refuse_shape(const std::string& name, const std::string& wanted,
                               const Array& array) {
    throw std::invalid_argument(name + " must have shape " + wanted + ", got " + shape_of(array));
}

}  // namespace

void SignalWatch::operator()() {
    constexpr std::chrono::milliseconds between_looks(50);
    const Clock::time_point now = Clock::now();
    if (now - last_look_ < between_looks) return;
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    last_look_ = Clock::now();
}

void run_interruptible(py::ssize_t n, int workers, const Range& body) {
    if (n <= chunk) return body(0, n);
    workers = static_cast<int>(std::min<py::ssize_t>(workers, n / chunk + 1));
    const py::gil_scoped_release release;
    std::atomic<py::ssize_t> next{0};
    std::vector<std::exception_ptr> failures(workers);
    const auto work = [&](int worker, bool interruptible) {
        try {
            SignalWatch look_for_signals;
            for (py::ssize_t begin; (begin = next.fetch_add(chunk)) < n;) {
                body(begin, std::min(begin + chunk, n));
                if (interruptible) look_for_signals();
            }
        } catch (...) {
            failures[worker] = std::current_exception();
            next = n;
        }
    };
    std::vector<std::thread> threads;
    try {
        for (int worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker, false);
    } catch (const std::exception&) {
        // The system has no room for one more thread: nothing is lost, the others take its chunks.
    }
    work(0, true);
    for (std::thread& thread : threads) thread.join();
    for (const std::exception_ptr& failure : failures) {
        if (failure) std::rethrow_exception(failure);
    }
}

std::vector<Array> empty_arrays(int count, py::ssize_t n) {
    std::vector<Array> arrays;
    for (int i = 0; i < count; ++i) arrays.emplace_back(n);
    return arrays;
}

py::array read_only(py::array array) {
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

Array matrix(py::ssize_t rows, py::ssize_t columns) {
    return Array(std::vector<py::ssize_t>{rows, columns});
}

void store(Array& array, py::ssize_t row, const double* values) {
    std::copy_n(values, array.shape(1), array.mutable_data(row, 0));
}

void require_length(const std::string& name, const Array& array, py::ssize_t n) {
    if (array.ndim() == 1 && array.size() == n) return;
    refuse_shape(name, "(" + std::to_string(n) + ",)", array);
}

void require_matrix(const std::string& name, const Array& array, py::ssize_t rows,
                    py::ssize_t columns) {
    if (array.ndim() == 2 && array.shape(0) == rows && array.shape(1) == columns) return;
    refuse_shape(name, "(" + std::to_string(rows) + ", " + std::to_string(columns) + ")", array);
}

py::ssize_t require_matrix(const std::string& name, const Array& array, py::ssize_t columns) {
    if (array.ndim() != 2 || array.shape(1) != columns) {
        refuse_shape(name, "(n, " + std::to_string(columns) + ")", array);
    }
    return array.shape(0);
}

Argument argument(const std::string& name, const Array& array, py::ssize_t n) {
    if (array.size() == 1) return {array.data(), 0};
    require_length(name, array, n);
    return {array.data(), 1};
}

}  // namespace rolling_ellipse::bindings
