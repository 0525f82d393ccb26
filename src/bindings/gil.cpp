#include "bindings/gil.hpp"

#include <atomic>
#include <thread>

namespace rolling_ellipse::bindings {

namespace {

std::atomic<unsigned long> main_thread;

}  // namespace

GilRelease::~GilRelease() {
    try {
        PyEval_RestoreThread(state_);
    } catch (...) {  // pthread_exit, which must not be swallowed
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
    if (!py::hasattr(os, "register_at_fork")) return;  // only Unix forks
    const py::cpp_function forked([] { main_thread = PyThread_get_thread_ident(); });
    os.attr("register_at_fork")(py::arg("after_in_child") = forked);
}

}  // namespace rolling_ellipse::bindings
