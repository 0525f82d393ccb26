#include "bindings/bindings.hpp"

// Not declared is py::mod_gil_not_used(), by which a free-threaded Python would run it without its
// lock. Nothing speaks against it: the core shares nothing but two constants made on first use
// (tests/core/threads_test.cpp, under ThreadSanitizer), what is bound never changes once it is
// made, and every array is filled before anybody else has it. But nobody has run it so.
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
    bind_build(m);
}
