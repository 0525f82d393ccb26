#include "arrays.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

namespace rolling_ellipse::bindings {

void check_signals() {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void run_interruptible(py::ssize_t n, int workers, const Range& body) {
    if (n <= chunk) return body(0, n);
    constexpr py::ssize_t most_threads = 256;
    workers = static_cast<int>(std::min({py::ssize_t{workers}, most_threads, n / chunk + 1}));
    const py::gil_scoped_release release;
    std::atomic<py::ssize_t> next{0};
    std::vector<std::exception_ptr> failures(workers);
    const auto work = [&](int worker, bool interruptible) {
        try {
            for (py::ssize_t begin; (begin = next.fetch_add(chunk)) < n;) {
                body(begin, std::min(begin + chunk, n));
                if (interruptible) check_signals();
            }
        } catch (...) {
            failures[worker] = std::current_exception();
            next = n;
        }
    };
    std::vector<std::thread> threads;
    for (int worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker, false);
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

Array matrix(py::ssize_t rows, py::ssize_t columns) {
    return Array(std::vector<py::ssize_t>{rows, columns});
}

void store(Array& array, py::ssize_t row, const double* values) {
    std::copy_n(values, array.shape(1), array.mutable_data(row, 0));
}

Argument argument(const Array& array) { return {array.data(), array.size() == 1 ? 0 : 1}; }

CoordinateState state_at(const Array& q, const Array& q_dot, py::ssize_t row) {
    return {Eigen::Map<const Coordinates>(q.data(row, 0)),
            Eigen::Map<const Coordinates>(q_dot.data(row, 0))};
}

}  // namespace rolling_ellipse::bindings
