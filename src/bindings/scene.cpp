#include "bindings/bindings.hpp"
#include "reason.hpp"

namespace rolling_ellipse::bindings {
namespace {

// theta, x_dot, z_dot, omega, a, b, gyration2, friction, restitution, each with n elements, or one:
// x_dot, z_dot, omega just after the collision of a touching body.
py::tuple collide_arrays(py::ssize_t n, const std::array<Array, 9>& arguments, Restitution law) {
    std::vector<Array> out = empty_arrays(3, n);
    double* const columns[] = {out[0].mutable_data(), out[1].mutable_data(), out[2].mutable_data()};
    const std::array<Argument, 9> of = arguments_of<9>(
        {"theta", "x_dot", "z_dot", "omega", "a", "b", "gyration2", "friction", "restitution"},
        arguments, n);
    run_interruptible(n, 1, [&](py::ssize_t begin, py::ssize_t end) {
        const auto& [theta, x_dot, z_dot, omega, a, b, gyration2, friction, restitution] = of;
        Scene scene{};
        scene.mass = scene.gravity = 1.0;  // which do not matter
        for (py::ssize_t i = begin; i < end; ++i) {
            scene.a = a[i];
            scene.b = b[i];
            scene.inertia = gyration2[i];
            scene.friction = friction[i];
            scene.restitution = restitution[i];
            scene.theta = theta[i];
            scene.omega = omega[i];
            scene.z = above_ground(scene.axes());  // where it may move down
            scene.x_dot = x_dot[i];
            scene.z_dot = z_dot[i];
            validate(scene.body());                // by its own names: k^2 is no inertia
            validate(scene, most_energy_reached);  // beside a gravity that does not matter
            const State before = state_before_impulse(scene);
            const double approach = gap_rate(before, geometry(scene.axes(), before.theta));
            const State after = collision(scene, before, approach, law).after;
            columns[0][i] = after.x_dot;
            columns[1][i] = after.z_dot;
            columns[2][i] = after.omega;
        }
    });
    return py::make_tuple(out[0], out[1], out[2]);
}

// By theta, omega, x, z, x_dot, z_dot just before and just after a collision.
double energy_lost_between(const Scene& scene, const std::array<double, 6>& before,
                           const std::array<double, 6>& after) {
    const auto state = [](const std::array<double, 6>& of) {
        return State{of[0], of[1], of[2], of[3], of[4], of[5], Mode::flight};
    };
    return energy_lost(scene, state(before), state(after));
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
        .def(py::init(
                 [](double a, double b, double mass, double gravity, std::optional<double> inertia,
                    double slope, double friction, double restitution, double theta, double omega,
                    double x, std::optional<double> z, std::optional<double> x_dot,
                    std::optional<double> z_dot, std::optional<Impulse> impulse, bool reached) {
                     Scene scene{};
                     scene.a = a;
                     scene.b = b;
                     scene.mass = mass;
                     scene.gravity = gravity;
                     scene.inertia = inertia.value_or(mass * uniform_disc_gyration2(a, b));
                     scene.slope = slope;
                     scene.friction = friction;
                     scene.restitution = restitution;
                     scene.theta = theta;
                     scene.omega = omega;
                     scene.x = x;
                     scene.z = z;
                     scene.x_dot = x_dot;
                     scene.z_dot = z_dot;
                     scene.impulse = impulse;
                     validate(scene, reached ? most_energy_reached : most_energy);
                     return scene;
                 }),
             "a"_a, "b"_a, "mass"_a, "gravity"_a, "inertia"_a, "slope"_a, "friction"_a,
             "restitution"_a, "theta"_a, "omega"_a, "x"_a, "z"_a, "x_dot"_a, "z_dot"_a, "impulse"_a,
             "reached"_a)
        .def_property_readonly("gyration2", [](const Scene& s) { return s.body().gyration2; });
    bind_class<State>(m, "State")
        .def_readonly("theta", &State::theta)
        .def_readonly("omega", &State::omega)
        .def_readonly("x", &State::x)
        .def_readonly("z", &State::z)
        .def_readonly("x_dot", &State::x_dot)
        .def_readonly("z_dot", &State::z_dot)
        .def_readonly("mode", &State::mode);
    py::native_enum<Restitution>(m, "Restitution", "enum.Enum", "What restitution means.")
        .value("STRONGE", Restitution::stronge)
        .value("POISSON", Restitution::poisson)
        .value("NEWTON", Restitution::newton)
        .finalize();
    bind_class<InitialState>(m, "InitialState")
        .def_readonly("state", &InitialState::state)
        .def_readonly("reaction_x", &InitialState::reaction_x)
        .def_readonly("reaction_z", &InitialState::reaction_z)
        .def_readonly("free_omega", &InitialState::free_omega)
        .def_readonly("energy_lost", &InitialState::energy_lost)
        .def_readonly("touching", &InitialState::touching)
        .def_property_readonly("slip_removal", slip_removal);
    bind_class<Continuation>(m, "Continuation")
        .def_readonly("mode", &Continuation::mode)
        .def_readonly("paradox", &Continuation::paradox)
        .def_property_readonly("why_it_rolls", why_it_rolls);
    m.def("initial_state", initial_state, "scene"_a);
    m.def(
        "first_continuation",
        [](const Scene& scene, const State& start) { return first_continuation(scene, start); },
        "scene"_a, "start"_a);
    m.def("energy_lost", energy_lost_between, "scene"_a, "before"_a, "after"_a);
    m.def("collide_arrays", collide_arrays, "n"_a, "arguments"_a, "law"_a);
}

}  // namespace rolling_ellipse::bindings
