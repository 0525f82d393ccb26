#include "bindings/bindings.hpp"

namespace rolling_ellipse::bindings {

void bind_build(py::module_& m) {
    m.def(
        "build",
        [] {
            return py::dict("compiler"_a = ROLLING_ELLIPSE_COMPILER,
                            "flags"_a = ROLLING_ELLIPSE_FLAGS);
        },
        "What the core was compiled with: compiler and flags.");
}

}  // namespace rolling_ellipse::bindings
