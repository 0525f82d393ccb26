#include "bindings/bindings.hpp"
#include "bindings/samples.hpp"
#include "geometry/constraints.hpp"
#include "geometry/ellipse.hpp"

namespace rolling_ellipse::bindings {
namespace {

// The constraint matrix, row after row, and the drift term.
py::tuple constraint_system(const Array& q, const Array& q_dot, double a, double b) {
    validate_axes(a, b);
    return computed(require_coordinates(q, q_dot), [&](py::ssize_t i) {
        const auto [at, rate] = state_at(q, q_dot, i);
        const Eigen::Matrix<double, 5, 4> columns = constraint_matrix({a, b}, at).transpose();
        return std::tuple(columns, constraint_drift({a, b}, at, rate));
    });
}

// Residuals of the constraints on positions and on velocities, gap and slip.
py::tuple constraint_arrays(const Array& q, const Array& q_dot, double a, double b) {
    validate_axes(a, b);
    return computed(require_coordinates(q, q_dot), [&](py::ssize_t i) {
        const auto [at, rate] = state_at(q, q_dot, i);
        const ConstraintResiduals found = constraints({a, b}, at, rate);
        return std::tuple(found.position, found.velocity, found.gap, found.slip);
    });
}

// q and q_dot of a rolling body.
py::tuple kinematics_arrays(py::ssize_t n, const Array& theta, const Array& omega, double a,
                            double b) {
    validate_axes(a, b);
    const Arguments<2> of({"theta", "omega"}, {theta, omega}, n);
    return computed(n, [&](py::ssize_t i) {
        const auto [angle, speed] = of[i];
        const CoordinateState at = kinematics({a, b}, angle, speed);
        return std::tuple(at.q, at.q_dot);
    });
}

// Binds a function of the ellipse and theta to arrays theta, a, b, each with n elements, or one.
template <class Function>
void define_geometry(py::module_& module, const char* name, Function function) {
    module.def(
        name,
        [function](py::ssize_t n, const std::array<Array, 3>& arguments) -> py::object {
            const Arguments<3> of({"theta", "a", "b"}, arguments, n);
            return computed(n, [of, function](py::ssize_t i) {
                const auto [theta, a, b] = of[i];
                validate_axes(a, b);
                return std::tuple(function(Axes{a, b}, theta));
            })[0];
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
