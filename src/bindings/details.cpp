#include <algorithm>
#include <map>

#include "bindings/bindings.hpp"
#include "bindings/samples.hpp"
#include "multipliers/equations.hpp"
#include "solution.hpp"

namespace rolling_ellipse::bindings {
namespace {

// q, q_dot, q_ddot and multipliers of the contact model, from its samples by the names of their
// columns.
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

// q_ddot and multipliers of the multiplier model.
py::tuple multiplier_arrays(const Scene& scene, const Settings& settings, const Array& q,
                            const Array& q_dot) {
    const ConstrainedBody body(scene);
    return computed(require_coordinates(q, q_dot), [&](py::ssize_t i) {
        const MultiplierSolution found = accelerations(body, settings, state_at(q, q_dot, i));
        return std::tuple(found.q_ddot, found.multipliers);
    });
}

// The nearest state that satisfies the constraints.
py::tuple projected(const Scene& scene, const Array& q, const Array& q_dot) {
    CoordinateState state = single_state(q, q_dot);
    ConstrainedBody(scene).project(state);
    return py::make_tuple(Array(5, state.q.data()), Array(5, state.q_dot.data()));
}

// q, with the x that is given, q_dot, q_ddot, normal and friction force, multipliers of rolling.
py::dict rolling_arrays(const Scene& scene, const Array& theta, const Array& omega,
                        const Array& x) {
    const py::ssize_t n = theta.size();
    const Arguments<3> of({"theta", "omega", "x"}, {theta, omega, x}, n);
    const auto row = [&](py::ssize_t i) {
        const auto [angle, speed, position] = of[i];
        RollingDetail found = rolling_detail(scene, angle, speed);
        found.state.q[coordinate::x] = position;
        return std::tuple(found.state.q, found.state.q_dot, found.q_ddot, found.force.normal,
                          found.force.friction, found.multipliers);
    };
    return named({"q", "q_dot", "q_ddot", "normal_force", "friction_force", "multipliers"},
                 computed(n, row));
}

// z, x_dot, z_dot, normal and friction force of rolling.
py::dict rolling_contact_arrays(const Scene& scene, const Array& theta, const Array& omega) {
    const py::ssize_t n = theta.size();
    const Arguments<2> of({"theta", "omega"}, {theta, omega}, n);
    const RollingEquation rolling(scene.body(), scene.slope);
    const auto row = [&](py::ssize_t i) {
        const auto [angle, speed] = of[i];
        const Geometry at = geometry(scene.axes(), angle);
        const ContactForce force = rolling.force(scene.mass, at, speed);
        const State state = in_contact(at, angle, speed, 0.0, 0.0, Mode::rolling);
        return std::tuple(state.z, state.x_dot, state.z_dot, force.normal, force.friction);
    };
    return named({"z", "x_dot", "z_dot", "normal_force", "friction_force"}, computed(n, row));
}

// theta'' of rolling, and its derivatives by theta and omega.
py::tuple rolling_equation_arrays(const Scene& scene, const Array& theta, const Array& omega) {
    const py::ssize_t n = theta.size();
    const Arguments<2> of({"theta", "omega"}, {theta, omega}, n);
    const RollingEquation equation(scene.body(), scene.slope);
    return computed(n, [&](py::ssize_t i) {
        const auto [angle, speed] = of[i];
        const Vector<2> y{angle, speed};
        const Vector<2> derivatives = equation.jacobian(0.0, y).row(1);
        return std::tuple(equation(0.0, y)[1], derivatives);
    });
}

}  // namespace

void bind_details(py::module_& m) {
    m.def("multiplier_detail", multiplier_arrays, "scene"_a, "settings"_a, "q"_a, "q_dot"_a);
    m.def("contact_detail", contact_arrays, "scene"_a, "samples"_a);
    m.def("project", projected, "scene"_a, "q"_a, "q_dot"_a);
    m.def("rolling_contact", rolling_contact_arrays, "scene"_a, "theta"_a, "omega"_a);
    m.def("rolling_detail", rolling_arrays, "scene"_a, "theta"_a, "omega"_a, "x"_a);
    m.def("rolling_equation", rolling_equation_arrays, "scene"_a, "theta"_a, "omega"_a);
}

}  // namespace rolling_ellipse::bindings
