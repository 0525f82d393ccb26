#include "bindings/bindings.hpp"
#include "integrator/collocation.hpp"
#include "integrator/explicit_tableaus.hpp"

namespace rolling_ellipse::bindings {
namespace {

// The coefficients of a method as an array.
template <std::size_t N>
Array array(const double (&values)[N]) {
    return Array(N, values);
}

template <std::size_t Rows, std::size_t Columns>
Array array(const double (&values)[Rows][Columns]) {
    return Array(std::vector<py::ssize_t>{Rows, Columns}, values[0]);
}

template <class T>
py::dict explicit_tableau() {
    return py::dict("order"_a = T::order, "stages"_a = T::stages, "c"_a = array(T::c),
                    "a"_a = array(T::a), "error_estimates"_a = T::error_estimates,
                    "error"_a = array(T::error), "dense_terms"_a = T::dense_terms,
                    "dense"_a = array(T::dense));
}

template <int Stages>
py::dict gauss_tableau() {
    using T = GaussCoefficients<Stages>;
    return py::dict("c"_a = array(T::c), "b"_a = array(T::b), "mu"_a = array(T::mu),
                    "nu"_a = array(T::nu));
}

py::dict radau_tableau() {
    using T = RadauCoefficients;
    return py::dict("c"_a = array(T::c), "gamma"_a = T::gamma, "alpha"_a = T::alpha,
                    "beta"_a = T::beta, "transform"_a = array(T::transform),
                    "inverse_transform"_a = array(T::inverse_transform));
}

py::dict tableaus() {
    return py::dict("rk4"_a = explicit_tableau<RungeKutta4>(),
                    "dopri5"_a = explicit_tableau<DormandPrince5>(),
                    "dop853"_a = explicit_tableau<DormandPrince853>(),
                    "gauss2"_a = gauss_tableau<2>(), "gauss3"_a = gauss_tableau<3>(),
                    "gauss4"_a = gauss_tableau<4>(), "radau"_a = radau_tableau());
}

}  // namespace
}  // namespace rolling_ellipse::bindings

// The module runs without the GIL: the core shares only constants that are computed on first use
// (tests/core/threads_test.cpp, under ThreadSanitizer), bound objects never change, and every array
// is filled before it is returned.
PYBIND11_MODULE(_core, m, pybind11::mod_gil_not_used()) {
    using namespace rolling_ellipse::bindings;
    m.doc() = "C++ core of rolling_ellipse; see the Python package for the documented interface.";
    watch_main_thread();
    bind_states(m);
    bind_scene(m);
    bind_certificate(m);
    bind_flow(m);
    bind_solution(m);
    bind_batch(m);
    m.def("tableaus", tableaus);
    m.def("build", [] {
        return py::dict("compiler"_a = ROLLING_ELLIPSE_COMPILER, "flags"_a = ROLLING_ELLIPSE_FLAGS);
    });
}
