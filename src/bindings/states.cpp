// Functions of individual states: geometry, constraints, forces and accelerations.
#include <map>

#include "bindings/bindings.hpp"
#include "multipliers/equations.hpp"
#include "rolling/stepped/equation.hpp"

namespace rolling_ellipse::bindings {
namespace {

// The state in one row of q and q_dot, (n, 5).
CoordinateState state_at(const Array& q, const Array& q_dot, py::ssize_t row) {
    return {Eigen::Map<const Coordinates>(q.data(row, 0)),
            Eigen::Map<const Coordinates>(q_dot.data(row, 0))};
}

// Calls function(state), which returns a tuple, for each row of q and q_dot, (n, 5). Returns one
// array for each element of this tuple.
template <class Function>
py::tuple computed_at(const Array& q, const Array& q_dot, const Function& function) {
    const py::ssize_t n = require_matrix("q", q, 5);
    require_matrix("q_dot", q_dot, 5, n);
    return computed(n, [&](py::ssize_t i) { return function(state_at(q, q_dot, i)); });
}

// The constraint matrix, row by row, and the drift term.
py::tuple constraint_system(const Array& q, const Array& q_dot, double a, double b) {
    validate_axes(a, b);
    return computed_at(q, q_dot, [&](const CoordinateState& state) {
        const auto& [at, rate] = state;
        const Eigen::Matrix<double, 5, 4> columns = constraint_matrix({a, b}, at).transpose();
        return std::tuple(columns, constraint_drift({a, b}, at, rate));
    });
}

// Residuals of the constraints on positions and on velocities, with gap and slip.
py::tuple constraint_arrays(const Array& q, const Array& q_dot, double a, double b) {
    validate_axes(a, b);
    return computed_at(q, q_dot, [&](const CoordinateState& state) {
        const auto& [at, rate] = state;
        const ConstraintResiduals found = constraints({a, b}, at, rate);
        return std::tuple(found.position, found.velocity, found.gap, found.slip);
    });
}

// Returns q and q_dot of a rolling body.
py::tuple kinematics_arrays(py::ssize_t n, const Array& theta, const Array& omega, double a,
                            double b) {
    validate_axes(a, b);
    return computed_from<2>(n, {"theta", "omega"}, {theta, omega}, [&](double angle, double speed) {
        const CoordinateState at = kinematics({a, b}, angle, speed);
        return std::tuple(at.q, at.q_dot);
    });
}

// Binds a function of the ellipse and theta to arrays theta, a, b, each with n elements or one.
template <class Function>
void define_geometry(py::module_& module, const char* name, Function function) {
    module.def(
        name,
        [function](py::ssize_t n, const std::array<Array, 3>& arguments) -> py::object {
            const auto row = [function](double theta, double a, double b) {
                validate_axes(a, b);
                return std::tuple(function(Axes{a, b}, theta));
            };
            return computed_from<3>(n, {"theta", "a", "b"}, arguments, row)[0];
        },
        "n"_a, "arguments"_a);
}

// Returns q, q_dot, q_ddot and multipliers of the contact model, from its samples by column name.
py::dict contact_arrays(const Scene& scene, const std::map<std::string, Array>& samples) {
    const py::ssize_t n = samples.at("theta").size();
    std::vector<const double*> columns;
    const auto add = [&](const auto& field) {
        const Array& column = samples.at(field.name);
        require_length(field.name, column, n);
        columns.push_back(column.data());
    };
    for_each(add, state_fields, force_fields);
    const auto row = [&](py::ssize_t i) {
        State state{};
        ContactForce force{};
        auto column = columns.begin();
        for (const auto& field : state_fields) state.*field.number = (*column++)[i];
        for (const auto& field : force_fields) force.*field.number = (*column++)[i];
        const CoordinateState at = coordinate_state(scene.axes(), state);
        const MultiplierSolution found = accelerations(scene, at, force);
        return std::tuple(at.q, at.q_dot, found.q_ddot, found.multipliers);
    };
    return named({"q", "q_dot", "q_ddot", "multipliers"}, computed(n, row));
}

// Returns q_ddot and multipliers of the multiplier model at each row of q and q_dot.
py::tuple multiplier_arrays(const Scene& scene, const Settings& settings, const Array& q,
                            const Array& q_dot) {
    const ConstrainedBody body(scene);
    return computed_at(q, q_dot, [&](const CoordinateState& state) {
        const MultiplierSolution found = accelerations(body, settings, state);
        return std::tuple(found.q_ddot, found.multipliers);
    });
}

// The nearest state that satisfies the constraints, as q and q_dot.
py::tuple projected(const Scene& scene, const Array& q, const Array& q_dot) {
    CoordinateState state = single_state(q, q_dot);
    ConstrainedBody(scene).project(state);
    return py::make_tuple(Array(5, state.q.data()), Array(5, state.q_dot.data()));
}

// Returns q (with the given x), q_dot, q_ddot and multipliers of rolling.
py::dict rolling_arrays(const Scene& scene, const Array& theta, const Array& omega,
                        const Array& x) {
    const auto row = [&](double angle, double speed, double position) {
        RollingDetail detail = rolling_detail(scene, angle, speed);
        detail.state.q[coordinate::x] = position;
        return std::tuple(detail.state.q, detail.state.q_dot, detail.q_ddot, detail.multipliers);
    };
    return named({"q", "q_dot", "q_ddot", "multipliers"},
                 computed_from<3>(theta.size(), {"theta", "omega", "x"}, {theta, omega, x}, row));
}

// Returns z, x_dot, z_dot, normal and friction force of rolling.
py::dict rolling_contact_arrays(const Scene& scene, const Array& theta, const Array& omega) {
    const RollingEquation rolling(scene.body(), scene.slope);
    const auto row = [&](double angle, double speed) {
        const Geometry at = geometry(scene.axes(), angle);
        const ContactForce force = rolling.force(scene.mass, at, speed);
        const State state = without_slip(at, angle, speed, 0.0, Mode::rolling);
        return std::tuple(state.z, state.x_dot, state.z_dot, force.normal, force.friction);
    };
    return named({"z", "x_dot", "z_dot", "normal_force", "friction_force"},
                 computed_from<2>(theta.size(), {"theta", "omega"}, {theta, omega}, row));
}

// Returns theta'' of rolling and its derivatives with respect to theta and omega.
py::tuple rolling_equation_arrays(const Scene& scene, const Array& theta, const Array& omega) {
    require_no_resistance(scene, "a rolling equation", "simulate has it");
    const RollingEquation equation(scene.body(), scene.slope);
    const auto row = [&](double angle, double speed) {
        const Vector<2> y{angle, speed};
        const Vector<2> derivatives = equation.jacobian(0.0, y).row(1);
        return std::tuple(equation(0.0, y)[1], derivatives);
    };
    return computed_from<2>(theta.size(), {"theta", "omega"}, {theta, omega}, row);
}

}  // namespace

CoordinateState single_state(const Array& q, const Array& q_dot) {
    require_length("q", q, 5);
    require_length("q_dot", q_dot, 5);
    return {Eigen::Map<const Coordinates>(q.data()), Eigen::Map<const Coordinates>(q_dot.data())};
}

void bind_states(py::module_& m) {
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
    m.def("multiplier_detail", multiplier_arrays, "scene"_a, "settings"_a, "q"_a, "q_dot"_a);
    m.def("contact_detail", contact_arrays, "scene"_a, "samples"_a);
    m.def("project", projected, "scene"_a, "q"_a, "q_dot"_a);
    m.def("rolling_contact", rolling_contact_arrays, "scene"_a, "theta"_a, "omega"_a);
    m.def("rolling_detail", rolling_arrays, "scene"_a, "theta"_a, "omega"_a, "x"_a);
    m.def("rolling_equation", rolling_equation_arrays, "scene"_a, "theta"_a, "omega"_a);
}

}  // namespace rolling_ellipse::bindings
