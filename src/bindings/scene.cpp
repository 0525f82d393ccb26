#include <algorithm>

#include "bindings/bindings.hpp"
#include "describe.hpp"
#include "multipliers/steps.hpp"

namespace rolling_ellipse::bindings {
namespace {

// Returns x_dot, z_dot, omega just after a collision with the ground. The arguments, in the order
// of `row`, each have n elements or one.
py::tuple collide_arrays(py::ssize_t n, const std::array<Array, 9>& arguments, Restitution law) {
    const auto row = [&](double theta, double x_dot, double z_dot, double omega, double a, double b,
                         double gyration2, double friction, double restitution) {
        constexpr double gravity = 1.0;  // any value: the velocities do not depend on it
        Scene scene = level_scene({a, b, gyration2, gravity}, friction);
        scene.restitution = restitution;
        scene.theta = theta;
        scene.omega = omega;
        scene.x = 0.0;
        scene.z = a + b;  // above the ground at any angle, so that any velocity is valid
        scene.x_dot = x_dot;
        scene.z_dot = z_dot;
        validate(scene.body());            // first, so that errors mention gyration2
        validate(scene, Origin::reached);  // with the widest limits: gravity is arbitrary here
        const Geometry at = geometry(scene.axes(), theta);
        const State before = state_before_impulse(scene, at);
        const State after = collision(scene, at, before, gap_rate(before, at), law).after;
        return std::tuple(after.x_dot, after.z_dot, after.omega);
    };
    return computed_from<9>(
        n, {"theta", "x_dot", "z_dot", "omega", "a", "b", "gyration2", "friction", "restitution"},
        arguments, row);
}

bool may_be_absent(const SceneField& field) {
    return field.otherwise || std::holds_alternative<std::optional<double> Scene::*>(field.number);
}

// Creates a scene from values by field name, with None for an absent optional value. Returns no
// scene if a required value is absent or any value is not a Python float.
struct SceneMaker {
    std::vector<py::str> names;  // interned, so that dictionaries find them by address

    SceneMaker() {
        for (const auto& field : scene_fields) {
            names.push_back(py::reinterpret_steal<py::str>(PyUnicode_InternFromString(field.name)));
        }
    }

    std::optional<Scene> operator()(const py::dict& fields, const std::optional<Impulse>& impulse,
                                    bool reached) const {
        SceneNumbers numbers;
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            PyObject* const given = PyDict_GetItemWithError(fields.ptr(), names[i].ptr());
            if (given == nullptr) throw py::key_error(scene_fields[i].name);
            const bool absent = given == Py_None && may_be_absent(scene_fields[i]);
            if (!absent && !PyFloat_CheckExact(given)) return {};
            if (!absent) numbers[i] = PyFloat_AS_DOUBLE(given);
        }
        const Scene scene = scene_of(numbers, impulse);
        validate(scene, reached ? Origin::reached : Origin::typed);
        return scene;
    }
};

// The state just after the blow, the mode that the forces allow, and sentences about both.
py::dict start_of(const Scene& scene) {
    const Start start(scene);
    py::dict fields = numbers_of(start);
    fields["mode"] = start.next.mode;
    fields["reason"] = describe_start(scene, start);
    return fields;
}

// Reads a setting; an enum is given by name.
template <class Value>
void take(py::handle given, Value& value) {
    if constexpr (std::is_enum_v<Value>) {
        const auto& known = names<Value>;
        const auto at = std::find(known.begin(), known.end(), given.cast<std::string>());
        value = static_cast<Value>(at - known.begin());
    } else if constexpr (std::is_same_v<Value, std::vector<Blow>>) {
        for (const auto& [t, impulse] : given.cast<std::vector<std::pair<double, Impulse>>>()) {
            value.push_back({t, impulse});
        }
    } else if constexpr (std::is_same_v<Value, Stop>) {
        for (const std::string& each : given.cast<std::vector<std::string>>()) {
            const auto& known = names<EventKind>;
            const auto at = std::find(known.begin(), known.end(), each);
            if (at == known.end())
                value.decided = true;
            else
                value.kinds |= 1L << (at - known.begin());
        }
    } else {
        value = given.cast<Value>();
    }
}

// Whether two tuples contain the same objects; faster than a comparison in Python.
bool hold_the_same(const py::tuple& x, const py::tuple& y) {
    const auto is = [](const py::handle one, const py::handle other) { return one.is(other); };
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), is);
}

Settings settings_of(const py::dict& fields) {
    Settings settings{};
    std::apply([&](const auto&... each) { (take(fields[each.first], settings.*each.second), ...); },
               settings_fields);
    return settings;
}

}  // namespace

void bind_scene(py::module_& m) {
    bind_enum<Mode>(m, "Mode", "enum.IntEnum", "Mode of motion; one code per sample.");
    bind_class<Impulse>(m, "Impulse")
        .def(py::init([](double jx, double jz, double dx, double dz) {
                 const Impulse impulse{jx, jz, dx, dz};
                 validate(impulse);
                 return impulse;
             }),
             "jx"_a, "jz"_a, "dx"_a, "dz"_a);
    bind_class<Scene>(m, "Scene")
        .def_property_readonly("body", body_of)
        .def_property_readonly("gyration2", [](const Scene& s) { return s.body().gyration2; });
    m.def("scene_of", SceneMaker(), "numbers"_a, "impulse"_a, "reached"_a);
    bind_enum<Restitution>(m, "Restitution", "enum.Enum", "Law of restitution.");
    m.attr("FIELDS") =
        py::dict("Scene"_a = units_of(scene_fields), "Impulse"_a = units_of(impulse_fields),
                 "State"_a = units_of(state_fields),
                 "InitialState"_a = units_of(state_fields, start_fields));
    m.attr("MODELS") = py::tuple(py::cast(names<Model>));
    m.attr("METHODS") = py::tuple(py::cast(names<Method>));
    m.attr("STABILIZATIONS") = py::tuple(py::cast(names<Stabilization>));
    bind_class<Settings>(m, "Settings").def(py::init(&settings_of), "fields"_a);
    m.def("hold_the_same", hold_the_same, "x"_a, "y"_a);
    m.def("require_no_resistance", require_no_resistance, "scene"_a, "who"_a, "instead"_a);
    m.def("feedback_growth", feedback_growth, "settings"_a);
    m.def("initial_state", start_of, "scene"_a);
    m.def("collide_arrays", collide_arrays, "n"_a, "arguments"_a, "law"_a);
}

}  // namespace rolling_ellipse::bindings
