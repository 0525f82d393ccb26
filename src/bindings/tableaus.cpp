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

template <class T>
py::dict gauss_tableau() {
    return py::dict("c"_a = array(T::c), "b"_a = array(T::b), "mu"_a = array(T::mu),
                    "nu"_a = array(T::nu));
}

template <class T>
py::dict radau_tableau() {
    return py::dict("c"_a = array(T::c), "a"_a = array(T::a), "gamma"_a = T::gamma,
                    "alpha"_a = T::alpha, "beta"_a = T::beta, "transform"_a = array(T::transform),
                    "inverse_transform"_a = array(T::inverse_transform));
}

}  // namespace

void bind_tableaus(py::module_& m) {
    m.def("tableaus", [] {
        return py::dict("rk4"_a = explicit_tableau<RungeKutta4>(),
                        "dopri5"_a = explicit_tableau<DormandPrince5>(),
                        "dop853"_a = explicit_tableau<DormandPrince853>(),
                        "gauss2"_a = gauss_tableau<GaussCoefficients<2>>(),
                        "gauss3"_a = gauss_tableau<GaussCoefficients<3>>(),
                        "gauss4"_a = gauss_tableau<GaussCoefficients<4>>(),
                        "radau"_a = radau_tableau<RadauCoefficients>());
    });
}

}  // namespace rolling_ellipse::bindings
