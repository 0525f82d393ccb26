// Long work without the GIL, Ctrl-C, and threads that outlive Python.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>

namespace rolling_ellipse::bindings {

namespace py = pybind11;

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

}  // namespace rolling_ellipse::bindings
