#include <stdexcept>

#include "bindings/bindings.hpp"
#include "describe.hpp"

namespace rolling_ellipse::bindings {
namespace {

std::int8_t code(Outcome outcome) { return static_cast<std::int8_t>(outcome); }

// Outcomes for a, b, omega, theta, friction, gravity, gyration2, each with n elements or one.
py::object classify_array(py::ssize_t n, const std::array<Array, 7>& arguments, int workers) {
    const Arguments<7> of({"a", "b", "omega", "theta", "friction", "gravity", "gyration2"},
                          arguments, n);
    const auto outcome_at = [of](py::ssize_t i) {
        return of.naming(i, [&] {
            const auto [a, b, omega, theta, friction, gravity, gyration2] = of[i];
            const Body body{a, b, gyration2, gravity};
            validate(body);
            validate_motion(body, theta, omega);
            validate_friction(friction);
            return std::tuple(code(classify(body, friction, theta, omega)));
        });
    };
    return computed(n, outcome_at, workers)[0];
}

// Outcomes of a scene on level ground, with each of n blows (jx, jz, dx, dz) in place of its own.
py::object outcome_array(const Scene& scene, py::ssize_t n, const std::array<Array, 4>& impulses) {
    const Arguments<4> of({"jx", "jz", "dx", "dz"}, impulses, n);
    const Geometry at = geometry(scene.axes(), scene.theta);
    return computed(n, [&](py::ssize_t i) {
        Scene struck = scene;
        const auto [jx, jz, dx, dz] = of[i];
        struck.impulse = Impulse{jx, jz, dx, dz};
        try {
            validate_blow(struck, at);
            return std::tuple(code(outcome(struck, [] {})));
        } catch (const std::invalid_argument& error) {
            throw std::invalid_argument(error.what() + (", by blow " + std::to_string(i)));
        }
    })[0];
}

using Maybe = std::optional<double>;

// The fields of a certificate by name. The validity is a code, since creating Python enums is slow.
py::dict certificate(const Scene& scene) {
    const Certificate c = certify(scene);
    py::dict fields;
    fields["validity"] = static_cast<int>(c.end.validity);
    fields["smallest_normal_force"] = c.smallest_normal_force;
    fields["smallest_normal_force_angle"] = c.smallest_normal_force_angle;
    fields["largest_friction_needed"] = c.largest_friction_needed;
    fields["largest_friction_needed_angle"] = c.largest_friction_needed_angle;
    fields["ends_at"] = c.end.angle;
    return fields;
}

// The first outcome of a motion, its headline and its reasons.
py::tuple description(const Scene& scene, const Solution& solution) {
    Description found;
    {
        const GilRelease release;
        found = describe(scene, solution, SignalWatch());
    }
    return py::make_tuple(found.first, found.headline, found.reasons);
}

Body valid_body(double a, double b, double gravity, std::optional<double> gyration2) {
    const Body found = body(a, b, gyration2, gravity);
    validate(found);
    return found;
}

py::tuple pairs(const std::vector<SpeedRange>& ranges) {
    py::tuple found(ranges.size());
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        found[i] = py::make_tuple(ranges[i].lower, ranges[i].upper);
    }
    return found;
}

py::dict thresholds_by_name(double a, double b, double gravity, std::optional<double> gyration2,
                            double friction) {
    const Body of = valid_body(a, b, gravity, gyration2);
    validate_friction(friction);
    const Thresholds t = thresholds(of, friction);
    py::dict found;
    found["roll_over_speed"] = t.roll_over_speed;
    found["contact_loss_speed"] = t.contact_loss_speed;
    found["contact_loss_angle"] = t.contact_loss_angle;
    found["slip_speed"] = t.slip_speed();
    found["slip_angle"] = t.slip_angle;
    found["slip_windows"] = pairs(t.slip_windows);
    found["friction_to_roll_over"] = t.friction_to_roll_over;
    found["painleve_friction"] = t.painleve_friction;
    found["painleve_angle"] = t.painleve_angle;
    found["rocking_rate"] = t.rocking_rate;
    found["tip_rate"] = t.tip_rate;
    return found;
}

// Lift-off speed and the ranges of speeds at which the body jams, given slip_speed and
// painleve_friction.
py::tuple lift_off_interruptible(double a, double b, double gravity,
                                 std::optional<double> gyration2, double friction,
                                 double slip_speed, double painleve_friction) {
    const Body of = valid_body(a, b, gravity, gyration2);
    LiftOff found;
    {
        const GilRelease release;
        found = lift_off(of, friction, slip_speed, painleve_friction, SignalWatch());
    }
    return py::make_tuple(found.speed, pairs(found.jam_speeds));
}

}  // namespace

void bind_certificate(py::module_& m) {
    bind_enum<Validity>(m, "Validity", "enum.Enum", "Whether rolling is valid throughout.");
    bind_enum<Outcome>(m, "Outcome", "enum.IntEnum",
                       "The first event in the motion of a rolling body.");
    m.def("classify_array", classify_array, "n"_a, "arguments"_a, "workers"_a);
    m.def("outcome_array", outcome_array, "scene"_a, "n"_a, "impulses"_a);
    m.def(
        "outcome", [](const Scene& scene) { return outcome(scene, SignalWatch()); },
        py::call_guard<GilRelease>(), "scene"_a);
    m.def("required_friction", required_friction, "scene"_a);
    m.def("friction_to_rest", friction_to_rest, "scene"_a);
    m.def("sticking_friction", sticking_friction, "scene"_a);
    m.def("press_to", press_to, "scene"_a, "distance"_a, "omega"_a);
    m.def("speed_to_the_tip", py::vectorize([](Scene scene, double theta) {
              scene.theta = theta;
              return speed_to_the_tip(scene);
          }),
          "scene"_a, "theta"_a);
    m.def("certify", certificate, "scene"_a);
    m.def("describe", description, "scene"_a, "solution"_a);
    m.def(
        "describe_proof",
        [](const Scene& scene, Validity validity, Maybe normal, Maybe normal_angle, Maybe friction,
           Maybe friction_angle, Maybe end) {
            return describe_proof(
                scene, {{validity, end}, normal, normal_angle, friction, friction_angle});
        },
        "_of"_a, "validity"_a, "smallest_normal_force"_a, "smallest_normal_force_angle"_a,
        "largest_friction_needed"_a, "largest_friction_needed_angle"_a, "ends_at"_a);
    m.def(
        "roll_over_speed", [](const Scene& scene) { return roll_over_speed(scene.body()); },
        "scene"_a);
    m.def("thresholds", thresholds_by_name, "a"_a, "b"_a, "gravity"_a, "gyration2"_a, "friction"_a);
    m.def("lift_off", lift_off_interruptible, "a"_a, "b"_a, "gravity"_a, "gyration2"_a,
          "friction"_a, "slip_speed"_a, "painleve_friction"_a);
}

}  // namespace rolling_ellipse::bindings
