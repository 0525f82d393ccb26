#include "bindings/bindings.hpp"
#include "outcome/classify.hpp"
#include "outcome/thresholds.hpp"
#include "simulate.hpp"

namespace rolling_ellipse::bindings {
namespace {

// a, b, omega, theta, friction, gravity, gyration2, each with n elements, or one.
py::array_t<std::int8_t> classify_array(py::ssize_t n, const std::array<Array, 7>& arguments,
                                        int workers) {
    py::array_t<std::int8_t> out(n);
    std::int8_t* const outcomes = out.mutable_data();
    const std::array<Argument, 7> of = arguments_of<7>(
        {"a", "b", "omega", "theta", "friction", "gravity", "gyration2"}, arguments, n);
    run_interruptible(n, workers, [&](py::ssize_t begin, py::ssize_t end) {
        for (py::ssize_t i = begin; i < end; ++i) {
            const Body body{of[0][i], of[1][i], of[6][i], of[5][i]};
            const double omega = of[2][i], theta = of[3][i], friction = of[4][i];
            validate(body);
            validate_motion(body, theta, omega);
            validate_friction(friction);
            outcomes[i] = static_cast<std::int8_t>(classify(body, friction, theta, omega));
        }
    });
    return out;
}

}  // namespace

void bind_certificate(py::module_& m) {
    py::native_enum<Validity>(m, "Validity", "enum.Enum", "Is rolling valid for the whole motion?")
        .value("VALID", Validity::valid)
        .value("INVALID", Validity::invalid)
        .value("EDGE", Validity::edge)
        .value("NO_PROOF", Validity::no_proof)
        .finalize();
    py::native_enum<Outcome>(m, "Outcome", "enum.IntEnum", "What a rolling body comes to first.")
        .value("RESTS", Outcome::rests)
        .value("ROCKS", Outcome::rocks)
        .value("ROLLS_OVER", Outcome::rolls_over)
        .value("SLIPS", Outcome::slips)
        .value("LOSES_CONTACT", Outcome::loses_contact)
        .value("JAMS", Outcome::jams)
        .value("EDGE", Outcome::edge)
        .finalize();
    m.def("classify_array", classify_array, "n"_a, "arguments"_a, "workers"_a);
    m.def("certify", [](const Scene& scene) {
        const CertifiedScene certified = certify(scene);
        const Certificate& c = certified.certificate;
        return py::make_tuple(c.end.validity, c.smallest_normal_force,
                              c.smallest_normal_force_angle, c.largest_friction_needed,
                              c.largest_friction_needed_angle, c.end.angle, certified.reason);
    });
    m.def("roll_over_speed", [](const Scene& scene) { return roll_over_speed(scene.body()); });
    m.def(
        "thresholds",
        [](double a, double b, double gravity, std::optional<double> gyration2, double friction) {
            const Body body{a, b, gyration2.value_or(uniform_disc_gyration2(a, b)), gravity};
            validate(body);
            validate_friction(friction);
            const Thresholds t = [&] {
                const py::gil_scoped_release release;
                return thresholds(body, friction, SignalWatch());
            }();
            py::tuple jam_speeds(t.lift_off.jam_speeds.size());
            for (std::size_t i = 0; i < jam_speeds.size(); ++i) {
                const auto [from, to] = t.lift_off.jam_speeds[i];
                jam_speeds[i] = py::make_tuple(from, to);
            }
            return py::make_tuple(t.roll_over_speed, t.contact_loss_speed, t.contact_loss_angle,
                                  t.slip_speed, t.slip_angle, t.lift_off.speed, jam_speeds,
                                  t.friction_to_roll_over, t.painleve_friction, t.painleve_angle,
                                  t.rocking_rate, t.tip_rate);
        },
        "a"_a, "b"_a, "gravity"_a, "gyration2"_a, "friction"_a);
}

}  // namespace rolling_ellipse::bindings
