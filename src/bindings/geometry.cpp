#include "bindings/bindings.hpp"
#include "bindings/samples.hpp"
#include "geometry/constraints.hpp"
#include "geometry/ellipse.hpp"

namespace rolling_ellipse::bindings {
namespace {

// The constraint matrix, row after row, and the drift term.
py::tuple constraint_system(const Array& q, const Array& q_dot, double a, double b) {
    validate_axes(a, b);
    const py::ssize_t n = require_coordinates(q, q_dot);
    Array rows = matrix(n, 20);
    Array drift = matrix(n, 4);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const CoordinateState state = state_at(q, q_dot, i);
            const Eigen::Matrix<double, 5, 4> columns =
                constraint_matrix({a, b}, state.q).transpose();
            store(rows, i, columns.data());
            store(drift, i, constraint_drift({a, b}, state.q, state.q_dot).data());
        }
    });
    return py::make_tuple(rows, drift);
}

py::tuple constraint_arrays(const Array& q, const Array& q_dot, double a, double b) {
    validate_axes(a, b);
    const py::ssize_t n = require_coordinates(q, q_dot);
    Array position = matrix(n, 3);
    Array velocity = matrix(n, 4);
    Array gap(n);
    Array slip(n);
    double* const gaps = gap.mutable_data();
    double* const slips = slip.mutable_data();
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const ConstraintResiduals residuals =
                constraints({a, b}, Eigen::Map<const Coordinates>(q.data(i, 0)),
                            Eigen::Map<const Coordinates>(q_dot.data(i, 0)));
            store(position, i, residuals.position.data());
            store(velocity, i, residuals.velocity.data());
            gaps[i] = residuals.gap;
            slips[i] = residuals.slip;
        }
    });
    return py::make_tuple(position, velocity, gap, slip);
}

py::tuple kinematics_arrays(py::ssize_t n, const Array& theta, const Array& omega, double a,
                            double b) {
    validate_axes(a, b);
    const Argument thetas = argument("theta", theta, n);
    const Argument omegas = argument("omega", omega, n);
    Array q = matrix(n, 5);
    Array q_dot = matrix(n, 5);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const CoordinateState state = kinematics({a, b}, thetas[i], omegas[i]);
            store(q, i, state.q.data());
            store(q_dot, i, state.q_dot.data());
        }
    });
    return py::make_tuple(q, q_dot);
}

// A function of theta, a, b, each with n elements, or one.
template <class Function>
void define_geometry(py::module_& module, const char* name, Function function) {
    module.def(
        name,
        [function](py::ssize_t n, const std::array<Array, 3>& arguments) {
            const auto [theta, a, b] = arguments_of<3>({"theta", "a", "b"}, arguments, n);
            Array out(n);
            double* const values = out.mutable_data();
            run_interruptible(n, 1,
                              [&, theta = theta, a = a, b = b](py::ssize_t begin, py::ssize_t end) {
                                  for (py::ssize_t i = begin; i < end; ++i) {
                                      validate_axes(a[i], b[i]);
                                      values[i] = function(Axes{a[i], b[i]}, theta[i]);
                                  }
                              });
            return out;
        },
        "n"_a, "arguments"_a);
}

}  // namespace

void bind_geometry(py::module_& m) {
    m.def("validate_length", validate_length, "name"_a, "value"_a);
    define_geometry(m, "support", [](const Axes& e, double t) { return geometry(e, t).h; });
    define_geometry(m, "support_slope", [](const Axes& e, double t) { return geometry(e, t).dh; });
    define_geometry(m, "support_curvature",
                    [](const Axes& e, double t) { return geometry(e, t).ddh; });
    define_geometry(m, "curvature_radius",
                    [](const Axes& e, double t) { return geometry(e, t).rho; });
    define_geometry(m, "contact_distance",
                    [](const Axes& e, double t) { return contact_distance(e, geometry(e, t)); });
    define_geometry(m, "contact_angle", contact_angle);
    define_geometry(m, "centre_path", centre_path);
    define_geometry(m, "arc_length", arc_length);
    m.def("constraints", constraint_arrays, "q"_a, "q_dot"_a, "a"_a, "b"_a);
    m.def("constraint_system", constraint_system, "q"_a, "q_dot"_a, "a"_a, "b"_a);
    m.def("kinematics", kinematics_arrays, "n"_a, "theta"_a, "omega"_a, "a"_a, "b"_a);
}

}  // namespace rolling_ellipse::bindings
