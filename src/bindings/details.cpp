#include <algorithm>
#include <map>

#include "bindings/bindings.hpp"
#include "bindings/samples.hpp"
#include "rolling/stepped/equation.hpp"
#include "solution.hpp"

namespace rolling_ellipse::bindings {
namespace {

// q, q_dot, q_ddot and multipliers of the contact model, from its samples by name.
py::dict contact_arrays(const Scene& scene, const std::map<std::string, Array>& samples) {
    const py::ssize_t n = samples.at("theta").size();
    std::vector<const double*> columns;
    const auto add = [&](const auto& field) {
        const Array& column = samples.at(field.name);
        require_length(field.name, column, n);
        columns.push_back(column.data());
    };
    for_each(add, state_fields, force_fields);
    Array q = matrix(n, 5);
    Array q_dot = matrix(n, 5);
    Array q_ddot = matrix(n, 5);
    Array multipliers = matrix(n, 4);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            State state{};
            ContactForce force{};
            auto column = columns.begin();
            for (const auto& field : state_fields) state.*field.number = (*column++)[i];
            for (const auto& field : force_fields) force.*field.number = (*column++)[i];
            const CoordinateState at = coordinate_state(scene.axes(), state);
            const MultiplierSolution found = accelerations(scene, at, force);
            store(q, i, at.q.data());
            store(q_dot, i, at.q_dot.data());
            store(q_ddot, i, found.q_ddot.data());
            store(multipliers, i, found.multipliers.data());
        }
    });
    return py::dict("q"_a = q, "q_dot"_a = q_dot, "q_ddot"_a = q_ddot,
                    "multipliers"_a = multipliers);
}

// q_ddot and multipliers of the multiplier model.
py::tuple multiplier_arrays(const Scene& scene, const Settings& settings, const Array& q,
                            const Array& q_dot) {
    const py::ssize_t n = require_coordinates(q, q_dot);
    const ConstrainedBody body(scene);
    Array q_ddot = matrix(n, 5);
    Array multipliers = matrix(n, 4);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const MultiplierSolution solution =
                accelerations(body, settings, state_at(q, q_dot, i));
            store(q_ddot, i, solution.q_ddot.data());
            store(multipliers, i, solution.multipliers.data());
        }
    });
    return py::make_tuple(q_ddot, multipliers);
}

// The nearest state that meets the constraints.
py::tuple projected(const Scene& scene, const Array& q, const Array& q_dot) {
    CoordinateState state = single_state(q, q_dot);
    ConstrainedBody(scene).project(state);
    return py::make_tuple(Array(5, state.q.data()), Array(5, state.q_dot.data()));
}

// q (its x replaced by the one given), q_dot, q_ddot, normal and friction force, multipliers.
py::dict rolling_arrays(const Scene& scene, const Array& theta, const Array& omega,
                        const Array& x) {
    const py::ssize_t n = theta.size();
    require_length("theta", theta, n);
    require_length("omega", omega, n);
    require_length("x", x, n);
    Array q = matrix(n, 5);
    Array q_dot = matrix(n, 5);
    Array q_ddot = matrix(n, 5);
    Array multipliers = matrix(n, 4);
    Array normal(n);
    Array friction(n);
    double* const normals = normal.mutable_data();
    double* const frictions = friction.mutable_data();
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            RollingDetail detail = rolling_detail(scene, theta.data()[i], omega.data()[i]);
            detail.state.q[coordinate::x] = x.data()[i];
            store(q, i, detail.state.q.data());
            store(q_dot, i, detail.state.q_dot.data());
            store(q_ddot, i, detail.q_ddot.data());
            store(multipliers, i, detail.multipliers.data());
            normals[i] = detail.force.normal;
            frictions[i] = detail.force.friction;
        }
    });
    return py::dict("q"_a = q, "q_dot"_a = q_dot, "q_ddot"_a = q_ddot, "normal_force"_a = normal,
                    "friction_force"_a = friction, "multipliers"_a = multipliers);
}

// z, x_dot, z_dot, normal and friction force of rolling.
py::dict rolling_contact_arrays(const Scene& scene, const Array& theta, const Array& omega) {
    const py::ssize_t n = theta.size();
    require_length("theta", theta, n);
    require_length("omega", omega, n);
    const RollingEquation rolling(scene.body(), scene.slope);
    std::vector<Array> out = empty_arrays(5, n);
    std::array<double*, 5> columns{};
    std::transform(out.begin(), out.end(), columns.begin(),
                   [](Array& array) { return array.mutable_data(); });
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const double speed = omega.data()[i];
            const double angle = theta.data()[i];
            const Geometry at = geometry(scene.axes(), angle);
            const ContactForce force = rolling.force(scene.mass, at, speed);
            const State state = in_contact(at, angle, speed, 0.0, 0.0, Mode::rolling);
            const double row[] = {state.z, state.x_dot, state.z_dot, force.normal, force.friction};
            for (std::size_t column = 0; column < columns.size(); ++column) {
                columns[column][i] = row[column];
            }
        }
    });
    return py::dict("z"_a = out[0], "x_dot"_a = out[1], "z_dot"_a = out[2],
                    "normal_force"_a = out[3], "friction_force"_a = out[4]);
}

// theta'' of rolling at each angle and angular velocity, and its derivatives by both.
py::tuple rolling_equation_arrays(const Scene& scene, const Array& theta, const Array& omega) {
    const RollingEquation equation(scene.body(), scene.slope);
    const py::ssize_t n = theta.size();
    require_length("theta", theta, n);
    require_length("omega", omega, n);
    Array acceleration(n);
    Array jacobian = matrix(n, 2);
    double* const accelerations = acceleration.mutable_data();
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const Vector<2> y{theta.data()[i], omega.data()[i]};
            accelerations[i] = equation(0.0, y)[1];
            const Vector<2> row = equation.jacobian(0.0, y).row(1);
            store(jacobian, i, row.data());
        }
    });
    return py::make_tuple(acceleration, jacobian);
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
