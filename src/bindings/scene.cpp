#include "bindings/bindings.hpp"
#include "bindings/fields.hpp"
#include "reason.hpp"

namespace rolling_ellipse::bindings {
namespace {

// x_dot, z_dot, omega just after the collision of a touching body. The arguments are theta, x_dot,
// z_dot, omega, a, b, gyration2, friction, restitution, each with n elements, or one.
py::tuple collide_arrays(py::ssize_t n, const std::array<Array, 9>& arguments, Restitution law) {
    const Arguments<9> of(
        {"theta", "x_dot", "z_dot", "omega", "a", "b", "gyration2", "friction", "restitution"},
        arguments, n);
    return computed(n, [&](py::ssize_t i) {
        Scene scene{};
        scene.mass = scene.gravity = 1.0;  // which do not matter
        const auto [theta, x_dot, z_dot, omega, a, b, gyration2, friction, restitution] = of[i];
        scene.a = a;
        scene.b = b;
        scene.inertia = gyration2;
        scene.friction = friction;
        scene.restitution = restitution;
        scene.theta = theta;
        scene.omega = omega;
        scene.z = above_ground(scene.axes());  // where it may move down
        scene.x_dot = x_dot;
        scene.z_dot = z_dot;
        validate(scene.body());                // by its own names: k^2 is no inertia
        validate(scene, most_energy_reached);  // the gravity above does not matter
        const State before = state_before_impulse(scene);
        const double approach = gap_rate(before, geometry(scene.axes(), before.theta));
        const State after = collision(scene, before, approach, law).after;
        return std::tuple(after.x_dot, after.z_dot, after.omega);
    });
}

// The names of a table as interned Python strings, which dictionaries find by their address.
template <class Table>
std::vector<py::str> interned(const Table& table) {
    std::vector<py::str> names;
    for (const auto& field : table) {
        names.push_back(py::reinterpret_steal<py::str>(PyUnicode_InternFromString(field.name)));
    }
    return names;
}

// Makes a scene from numbers by the names of its fields; None stands for an absent one.
class SceneMaker {
  public:
    Scene operator()(const py::dict& fields, const std::optional<Impulse>& impulse,
                     bool reached) const {
        SceneNumbers numbers;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            PyObject* const given = PyDict_GetItemWithError(fields.ptr(), names_[i].ptr());
            if (given == nullptr) throw py::key_error(scene_fields[i].name);
            if (given != Py_None) numbers[i] = PyFloat_AsDouble(given);
        }
        const Scene scene = scene_of(numbers, impulse);
        validate(scene, reached ? most_energy_reached : most_energy);
        return scene;
    }

  private:
    std::vector<py::str> names_ = interned(scene_fields);
};

// The state just after the blow, the mode that forces allow, and sentences about both.
py::dict start_of(const Scene& scene) {
    const InitialState start = initial_state(scene);
    const Continuation next = first_continuation(scene, start.state);
    py::dict found = numbers_of(start);
    found["touching"] = start.touching;
    found["slip_removal"] = slip_removal(start);
    found["mode_by_velocity"] = start.state.mode;
    found["mode"] = next.mode;
    found["paradox"] = next.paradox;
    found["why_it_rolls"] = why_it_rolls(next);
    return found;
}

}  // namespace

void bind_scene(py::module_& m) {
    py::native_enum<Mode>(m, "Mode", "enum.IntEnum", "Mode of motion; one code per sample.")
        .value("ROLLING", Mode::rolling)
        .value("SLIDING", Mode::sliding)
        .value("FLIGHT", Mode::flight)
        .value("REST", Mode::rest)
        .finalize();
    py::native_enum<Painleve>(m, "Painleve", "enum.Enum", "Is there exactly one possible motion?")
        .value("DETERMINED", Painleve::determined)
        .value("NO_MOTION", Painleve::no_motion)
        .value("TWO_MOTIONS", Painleve::two_motions)
        .finalize();
    bind_class<Impulse>(m, "Impulse")
        .def(py::init([](double jx, double jz, double dx, double dz) {
                 const Impulse impulse{jx, jz, dx, dz};
                 validate(impulse);
                 return impulse;
             }),
             "jx"_a, "jz"_a, "dx"_a, "dz"_a);
    bind_class<Scene>(m, "Scene")
        .def(py::init(SceneMaker()), "numbers"_a, "impulse"_a, "reached"_a)
        .def_property_readonly("gyration2", [](const Scene& s) { return s.body().gyration2; });
    py::native_enum<Restitution>(m, "Restitution", "enum.Enum", "Law of restitution.")
        .value("STRONGE", Restitution::stronge)
        .value("POISSON", Restitution::poisson)
        .value("NEWTON", Restitution::newton)
        .finalize();
    m.attr("FIELDS") =
        py::dict("Scene"_a = units_of(scene_fields), "Impulse"_a = units_of(impulse_fields),
                 "State"_a = units_of(state_fields),
                 "InitialState"_a = units_of(state_fields, start_fields));
    m.def("initial_state", start_of, "scene"_a);
    m.def("collide_arrays", collide_arrays, "n"_a, "arguments"_a, "law"_a);
}

}  // namespace rolling_ellipse::bindings
