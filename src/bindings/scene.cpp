#include "bindings/bindings.hpp"
#include "contact/continuation.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse::bindings {
namespace {

// theta, x_dot, z_dot, omega, a, b, gyration2, friction, restitution, each with n elements, or one:
// x_dot, z_dot, omega just after the collision of a touching body, by the law of scene/impact.hpp.
py::tuple collide_arrays(py::ssize_t n, const std::array<Array, 9>& arguments) {
    std::vector<Array> out = empty_arrays(3, n);
    double* const columns[] = {out[0].mutable_data(), out[1].mutable_data(), out[2].mutable_data()};
    const std::array<Argument, 9> of = arguments_of<9>(
        {"theta", "x_dot", "z_dot", "omega", "a", "b", "gyration2", "friction", "restitution"},
        arguments, n);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            // Neither mass nor gravity nor height matters; a scene may move down only in the air.
            const double mass = 1.0, gravity = 1.0, slope = 0.0, x = 0.0, z = of[4][i] + of[5][i];
            const Scene scene{of[4][i], of[5][i], mass,     gravity,  of[6][i],
                              slope,    of[7][i], of[8][i], of[0][i], of[3][i],
                              x,        z,        of[1][i], of[2][i], std::nullopt};
            validate(scene.body());  // by its own names: k^2 is no inertia
            validate(scene);
            const State after = after_collision(scene, state_before_impulse(scene));
            columns[0][i] = after.x_dot;
            columns[1][i] = after.z_dot;
            columns[2][i] = after.omega;
        }
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

}  // namespace

void bind_scene(py::module_& m) {
    py::native_enum<Mode>(m, "Mode", "enum.IntEnum", "What the body does, one code a sample.")
        .value("ROLLING", Mode::rolling)
        .value("SLIDING", Mode::sliding)
        .value("FLIGHT", Mode::flight)
        .value("REST", Mode::rest)
        .finalize();
    py::native_enum<Painleve>(m, "Painleve", "enum.Enum", "Does exactly one motion go on?")
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
        .def(py::init([](double a, double b, double mass, double gravity,
                         std::optional<double> inertia, double slope, double friction,
                         double restitution, double theta, double omega, double x,
                         std::optional<double> z, std::optional<double> x_dot,
                         std::optional<double> z_dot, std::optional<Impulse> impulse) {
                 const Scene scene{a,
                                   b,
                                   mass,
                                   gravity,
                                   inertia.value_or(mass * uniform_disc_gyration2(a, b)),
                                   slope,
                                   friction,
                                   restitution,
                                   theta,
                                   omega,
                                   x,
                                   z,
                                   x_dot,
                                   z_dot,
                                   impulse};
                 validate(scene);
                 return scene;
             }),
             py::kw_only(), "a"_a, "b"_a, "mass"_a, "gravity"_a, "inertia"_a, "slope"_a,
             "friction"_a, "restitution"_a, "theta"_a, "omega"_a, "x"_a, "z"_a, "x_dot"_a,
             "z_dot"_a, "impulse"_a)
        .def_property_readonly("gyration2", [](const Scene& s) { return s.body().gyration2; });
    m.def("initial_state", [](const Scene& scene) {
        const InitialState initial = initial_state(scene);
        const State& s = initial.state;
        const Continuation next = first_continuation(scene, s);
        return py::make_tuple(s.theta, s.omega, s.x, s.z, s.x_dot, s.z_dot, next.mode,
                              initial.reaction_x, initial.reaction_z, initial.free_omega, s.mode,
                              next.paradox);
    });
    m.def("collide_arrays", collide_arrays, "n"_a, "arguments"_a);
}

}  // namespace rolling_ellipse::bindings
