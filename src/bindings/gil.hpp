// Long work without the GIL, Ctrl-C, and threads that outlive Python.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>

namespace rolling_ellipse::bindings {

namespace py = pybind11;

// Releases the GIL for a scope. In a daemon thread the scope may end while Python does: CPython
// before 3.14 then ends the thread by pthread_exit, which would unwind our frames and release
// Python objects in them without the GIL. The thread waits for the end of the process instead, as
// CPython 3.14 has it.
class GilRelease {
  public:
    GilRelease() : state_(PyEval_SaveThread()) {}
    GilRelease(const GilRelease&) = delete;
    GilRelease& operator=(const GilRelease&) = delete;
    ~GilRelease();

  private:
    PyThreadState* state_;
};

// Looks for Ctrl-C whenever 50 ms have passed since it last did, and throws it as the exception
// that Python knows. It asks by time, because a look takes the GIL, for which a busy Python thread
// makes it wait 5 ms. Python handles signals in its main thread only, so no other one asks.
class SignalWatch {
  public:
    SignalWatch();
    void operator()();

  private:
    using Clock = std::chrono::steady_clock;
    bool in_main_thread_;
    Clock::time_point last_look_ = Clock::now();
};

// Finds Python's main thread, now and after each fork.
void watch_main_thread();

}  // namespace rolling_ellipse::bindings
