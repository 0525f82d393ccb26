#include "bindings/bindings.hpp"

PYBIND11_MODULE(_core, m) {
    using namespace rolling_ellipse::bindings;
    m.doc() = "C++ core of rolling_ellipse; see the Python package for the documented interface.";
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
