#include "bindings/bindings.hpp"

// The module does not declare py::mod_gil_not_used(), so a free-threaded Python turns its lock on.
// It could: the core shares only two constants made on first use (tests/core/threads_test.cpp,
// under ThreadSanitizer), bound objects never change, and every array is filled before it is
// returned. But this was never run without the lock.
PYBIND11_MODULE(_core, m) {
    using namespace rolling_ellipse::bindings;
    m.doc() = "C++ core of rolling_ellipse; see the Python package for the documented interface.";
    watch_main_thread();
    bind_geometry(m);
    bind_scene(m);
    bind_certificate(m);
    bind_flow(m);
    bind_settings(m);
    bind_solution(m);
    bind_batch(m);
    bind_details(m);
    bind_tableaus(m);
    m.def("build", [] {
        return py::dict("compiler"_a = ROLLING_ELLIPSE_COMPILER, "flags"_a = ROLLING_ELLIPSE_FLAGS);
    });
}
