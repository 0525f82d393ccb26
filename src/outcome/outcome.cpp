#include "outcome/outcome.hpp"

#include <algorithm>
#include <cmath>

#include "contact/sliding.hpp"
#include "proof/slope.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse {
namespace {

// The alternative named in the error message for a body with rolling resistance.
constexpr const char* instead = "the events of simulate show how the body moves with it";

// `jams` never follows rolling, since slip after rolling never starts with B <= 0. Let |F| exceed
// mu N > 0, so that the body starts to slide to the side s = -sign F. Since c = Gnn N + Gtn F holds
// in rolling, too, physics (50), B = Gnn - mu s Gtn is positive: if s Gtn <= 0, it is a sum of
// positive terms; otherwise B > 0 follows from c <= N B with c > 0, which N > 0 implies (N D = c
// (k^2 + h^2) - omega^2 h h'^2 per mass). Where N <= 0 and c > 0, a body without slip has a side on
// which B > 0. On level ground, a rolling body cannot leave the ground before it slips: where N
// vanishes, c is positive, and the body starts to slide even with infinite friction.

// The outcome for a body that rolls up to the top: it passes the tip or turns back; `edge` if
// rounding hides which.
Outcome at_the_top(const RollingStart& from) {
    const FlatView& at = from.view;
    const EnergyHeight& height = from.height;
    const double to_tip = at.c2 * square(at.cos) / (at.long_axis + at.short_axis);
    const Sign over = sign({height.over_tip, std::abs(height.over_tip) + to_tip});
    if (over == Sign::undecided) return Outcome::edge;
    return over == Sign::positive ? Outcome::rolls_over : Outcome::rocks;
}

// A polynomial of the law of rolling, on the range of heights from x to the top.
template <int N>
Bernstein<N> from_place(const Polynomial<N>& law, double x) {
    const Bernstein<N> whole = bernstein(law);
    return x > 0 ? divided(whole, x).right : whole;
}

// The outcome for a rolling circle, which has no tip, within half a turn.
Outcome outcome_of_circle(const SlopeFlow& flow) {
    const double omega = flow.start.omega;
    if (omega >= 0) return Outcome::rolls_over;
    return square(omega) < 2 * pi * flow.acceleration ? Outcome::rocks : Outcome::rolls_over;
}

// The outcome for a body that rolls on a slope, from its power series.
Outcome outcome_on_slope(const Scene& scene, const State& start, const Checkpoint& checkpoint) {
    constexpr int most_pieces = 100'000;
    constexpr int pieces_between_checks = 64;
    SlopeFlow flow = slope_flow(scene.body(), scene.slope, start.theta, start.omega, start.x);
    if (flow.body.c2 == 0 && !flow.rests) {
        const LawMeetings met = law_meetings(flow, scene.friction);
        if (met.touched) return Outcome::edge;
        return met.broken ? Outcome::slips : outcome_of_circle(flow);
    }
    LawWatch watch(flow, scene.friction);
    SlopePlace place = flow.start;
    for (int i = 0; i < most_pieces; ++i) {
        if (i % pieces_between_checks == 0) checkpoint();
        const SlopePiece piece = piece_from(flow.body, place);
        if (std::isinf(piece.lasts)) return Outcome::edge;
        const SlopePlace next = place_after(flow.body, flow.datum, piece);
        const double turns = double(time_of_turning(piece));
        const double tips = time_of_tip(piece);
        const bool breaks = watch.examine(piece);
        const LawMeetings met = watch.met();
        const double first = std::min(turns, tips);
        const auto before = [&](const std::optional<Meeting>& meeting) {
            return meeting && meeting->time <= first * flow.body.time;
        };
        if (before(met.touched)) return Outcome::edge;
        if (breaks && before(met.broken)) return after_rolling(scene, met.broken->time);
        if (first < infinity) return turns < tips ? Outcome::rocks : Outcome::rolls_over;
        place = next;
    }
    return Outcome::edge;
}

}  // namespace

Outcome classify(const Body& body, double friction, double theta, double omega) {
    const RollingStart from = rolling_start(body, theta, omega);
    const FlatView& at = from.view;
    if (from.rests) return Outcome::rests;
    if (at.c2 == 0) return friction > 0 ? Outcome::rolls_over : Outcome::slips;

    // The view drops the half turns of the angle, which change only the signs of sin and cos: h,
    // h'' and rho are even in both.
    const bool a_is_long = body.a >= body.b;
    const Geometry here =
        geometry(body.axes(), a_is_long ? at.sin : at.cos, a_is_long ? at.cos : at.sin);
    // The acceleration of the lowest point into the ground without a contact force, physics (43),
    // and the magnitude of its terms, since h'' = rho - h.
    const Sign pressed = sign({free_acceleration(here, body.gravity, from.omega),
                               body.gravity + (here.rho + here.h) * square(from.omega)});
    if (pressed == Sign::negative) return Outcome::loses_contact;
    if (pressed == Sign::undecided) return Outcome::edge;
    if (friction == 0) return Outcome::slips;

    // A rising body passes only the heights above its start. A body that falls, or starts at the
    // tip to within rounding, passes through all heights before it reaches the top.
    const EnergyRange range = energy_range(from);
    const ForcePolynomials forces = force_polynomials(range);
    const bool rises = at.sin * from.omega > 0 && at.cos > equal_ulps * epsilon;
    const double height = over_flat(at, here.h) / at.long_axis;
    const double start = rises ? std::min(height / range.width, 1.0) : 0.0;
    const bool grips_always = std::isinf(friction);
    const Bernstein<5> normal = from_place(forces.normal, start);
    const Sign contact = sign_on_unit_interval(normal);
    const Sign grip =
        grips_always || contact == Sign::negative
            ? contact
            : sign_on_unit_interval(from_place(grip_polynomial(forces, friction), start));
    if (grip == Sign::negative) return Outcome::slips;
    if (contact == Sign::undecided || grip == Sign::undecided) return Outcome::edge;
    return at_the_top(from);
}

Outcome outcome(const Scene& scene, const Checkpoint& checkpoint) {
    require_no_resistance(scene, "an outcome", instead);
    const State start = initial_state(scene).state;
    const Continuation next = first_continuation(scene, start);
    if (next.mode == Mode::rest) return Outcome::rests;
    if (next.mode == Mode::flight) return Outcome::loses_contact;
    if (next.paradox != Painleve::determined) return Outcome::jams;
    if (next.mode == Mode::sliding) return Outcome::slips;
    if (scene.slope != 0) return outcome_on_slope(scene, start, checkpoint);
    return classify(scene.body(), scene.friction, start.theta, start.omega);
}

Outcome after_rolling(const Scene& scene, double time) {
    if (scene.slope == 0) return Outcome::slips;
    const State start = initial_state(scene).state;
    SlopeFlow flow = slope_flow(scene.body(), scene.slope, start.theta, start.omega, start.x);
    prepare(flow, time);
    const auto [theta, omega, x] = sample(flow, time);
    const State end = without_slip(scene.axes(), theta, omega, x, Mode::rolling);
    const bool flies = first_continuation(scene, end, false).mode == Mode::flight;
    return flies ? Outcome::loses_contact : Outcome::slips;
}

double press_to(const Scene& scene, double distance, double omega) {
    require_finite("distance", unit::length, distance);
    validate_motion(scene.body(), scene.theta, omega);
    const Geometry at = geometry(scene.axes(), scene.theta);
    const State state = state_before_impulse(scene, at);
    const double k2 = scene.body().gyration2;
    const double wanted = inertia_about_contact(k2, at) * omega;
    const double there = k2 * state.omega + at.h * state.x_dot + at.dh * state.z_dot;
    const double force = scene.mass * (wanted - there) / (distance - at.dh);
    Scene pressed = scene;
    pressed.impulse = Impulse{0.0, -force, distance, 0.0};
    return energy_after_impulse(pressed, at) <= most_energy ? force
                                                            : std::copysign(infinity, force);
}

double speed_to_the_tip(const Scene& scene) {
    const Body body = scene.body();
    const RollingStart at_rest = rolling_start(body, scene.theta, 0.0);
    const Geometry at = geometry(body.axes(), scene.theta);
    const double inertia = inertia_about_contact(body.gyration2, at);
    return std::sqrt(std::max(-at_rest.height.over_tip, 0.0) * 2 * body.gravity / inertia);
}

double required_friction(const Scene& scene) {
    require_no_resistance(scene, "a required friction", instead);
    const double in_the_blow = sticking_friction(scene);
    if (in_the_blow == infinity) return infinity;
    Scene rough = scene;
    rough.friction = infinity;
    const State start = initial_state(rough).state;
    const Certificate certificate =
        scene.slope != 0 ? certify_on_slope(rough, start, {Validity::no_proof})
                         : certify_rolling(rolling_start(scene.body(), start.theta, start.omega),
                                           scene.mass, rough.friction);
    return std::max(in_the_blow, *certificate.largest_friction_needed);
}

// The contact is h' ahead of the centre at height h, and |h'|/h is at most |a^2 - b^2|/(2 a b).
double friction_to_rest(const Scene& scene) {
    require_no_resistance(scene, "a required friction", instead);
    const double needed = std::tan(std::abs(scene.slope));
    const double steepest = std::abs(scene.axes().c2()) / (2 * scene.a * scene.b);
    return needed <= steepest ? needed : infinity;
}

}  // namespace rolling_ellipse
