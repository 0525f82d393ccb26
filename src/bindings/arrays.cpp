#include "bindings/arrays.hpp"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace rolling_ellipse::bindings {

namespace {

std::atomic<unsigned long> main_thread;

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

GilRelease::~GilRelease() {
    try {
        PyEval_RestoreThread(state_);
    } catch (...) {  // pthread_exit unwinds the stack: wait for the process to end
        for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
    }
}

SignalWatch::SignalWatch() : in_main_thread_(PyThread_get_thread_ident() == main_thread) {}

void SignalWatch::operator()() {
    if (!in_main_thread_) return;
    constexpr std::chrono::milliseconds between_checks(50);
    const Clock::time_point now = Clock::now();
    if (now - last_check_ < between_checks) return;
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    last_check_ = Clock::now();
}

void watch_main_thread() {
    const py::object found = py::module_::import("threading").attr("main_thread")();
    main_thread = found.attr("ident").cast<unsigned long>();
    const py::module_ os = py::module_::import("os");
    if (!py::hasattr(os, "register_at_fork")) return;  // only Unix can fork
    const py::cpp_function forked([] { main_thread = PyThread_get_thread_ident(); });
    os.attr("register_at_fork")(py::arg("after_in_child") = forked);
}

void run_each(py::ssize_t n, int workers, const Piece& body) {
    workers = static_cast<int>(std::min<py::ssize_t>(workers, n));
    if (workers == 0) return;
    const GilRelease release;
    struct Stopped {};
    struct Failure {
        py::ssize_t piece = -1;  // -1 for an interrupt between two pieces
        std::exception_ptr exception;
    };
    std::vector<Failure> failures(workers);
    std::atomic<py::ssize_t> next{0};
    std::atomic<bool> stopped{false};
    std::mutex mutex;
    std::condition_variable ended;
    std::size_t idle = 0;  // threads with no work left
    const auto guarded = [&](int worker, const auto& action) {
        try {
            action();
        } catch (const Stopped&) {
        } catch (...) {
            failures[worker].exception = std::current_exception();
            stopped = true;
        }
    };
    // Every thread starts the piece that it claims. When a piece fails, all earlier pieces have
    // therefore been started.
    const auto take = [&](int worker, const std::function<void()>& checkpoint) {
        py::ssize_t& piece = failures[worker].piece;
        for (;;) {
            checkpoint();
            const py::ssize_t taken = next++;
            if (taken >= n) return;
            piece = taken;
            body(taken, checkpoint);
            piece = -1;
        }
    };
    const auto check_for_stop = [&] {
        if (stopped) throw Stopped{};
    };
    const auto work = [&](int worker) {
        guarded(worker, [&] { take(worker, check_for_stop); });
        const std::lock_guard<std::mutex> lock(mutex);
        ++idle;
        ended.notify_one();
    };
    std::vector<std::thread> threads;
    try {
        for (int worker = 1; worker < workers; ++worker) threads.emplace_back(work, worker);
    } catch (const std::exception&) {
        // The system cannot start another thread; the started ones do all the work.
    }
    SignalWatch check_for_signals;
    guarded(0, [&] {
        take(0, [&] {
            check_for_stop();
            check_for_signals();
        });
        std::unique_lock<std::mutex> lock(mutex);  // waits until all other threads are idle
        while (!ended.wait_for(lock, std::chrono::milliseconds(50),
                               [&] { return idle == threads.size(); })) {
            lock.unlock();
            check_for_signals();
            lock.lock();
        }
    });
    for (std::thread& thread : threads) thread.join();
    const Failure* first = nullptr;
    for (const Failure& failure : failures) {
        if (!failure.exception) continue;
        if (first == nullptr || failure.piece < first->piece) first = &failure;
    }
    if (first != nullptr) std::rethrow_exception(first->exception);
}

void run_interruptible(py::ssize_t n, int workers, const Range& body) {
    if (n <= chunk) return body(0, n);
    run_each((n + chunk - 1) / chunk, workers,
             [&](py::ssize_t i, const auto&) { body(i * chunk, std::min((i + 1) * chunk, n)); });
}

py::array read_only(py::array array) {
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return array;
}

Array vector(py::ssize_t n) {
    const auto& numpy = py::detail::npy_api::get();
    PyObject* const type = py::dtype::of<double>().release().ptr();
    const auto array = py::reinterpret_steal<Array>(numpy.PyArray_NewFromDescr_(
        numpy.PyArray_Type_, type, 1, &n, nullptr, nullptr, 0, nullptr));
    if (!array) throw py::error_already_set();  // MemoryError
    return array;
}

Array matrix(py::ssize_t rows, py::ssize_t columns) {
    return Array(std::vector<py::ssize_t>{rows, columns});
}

void store(Array& matrix, py::ssize_t row, const double* values) {
    std::copy_n(values, matrix.shape(1), matrix.mutable_data(row, 0));
}

void require_length(const std::string& name, const Array& array, py::ssize_t n) {
    if (array.ndim() == 1 && array.size() == n) return;
    refuse_shape(name, "(" + std::to_string(n) + ",)", array);
}

py::ssize_t require_matrix(const std::string& name, const Array& array, py::ssize_t columns,
                           std::optional<py::ssize_t> rows) {
    if (array.ndim() == 2 && array.shape(1) == columns &&
        array.shape(0) == rows.value_or(array.shape(0))) {
        return array.shape(0);
    }
    const std::string wanted = rows ? std::to_string(*rows) : "n";
    refuse_shape(name, "(" + wanted + ", " + std::to_string(columns) + ")", array);
}

std::string with_index(const std::string& message, py::ssize_t index, const Argument* arguments,
                       std::size_t count) {
    // The message starts with the name of one argument, or with two names, "a/b".
    const std::size_t end = message.find(' ');
    std::string named;
    for (std::size_t begin = 0; begin < end;) {
        const std::size_t stop = std::min(message.find('/', begin), end);
        const std::string name = message.substr(begin, stop - begin);
        named += (begin == 0 ? "" : "/") + name;
        for (std::size_t k = 0; k < count; ++k) {
            if (name == arguments[k].name && arguments[k].stride != 0) {
                named += "[" + std::to_string(index) + "]";
            }
        }
        begin = stop + 1;
    }
    return named + message.substr(end);
}

}  // namespace rolling_ellipse::bindings
