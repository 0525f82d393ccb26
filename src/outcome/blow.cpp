#include "outcome/blow.hpp"

#include <algorithm>
#include <cmath>

#include "contact/continuation.hpp"
#include "integrator/system.hpp"
#include "proof/certificate.hpp"
#include "proof/slope.hpp"
#include "scene/impact.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

// The outcome for a body on a slope whose rolling ends at a time [s]: it slips or flies.
Outcome after_rolling(const Scene& scene, SlopeFlow& flow, double time) {
    prepare(flow, time);
    const FlowSample last = sample(flow, time);
    const State state = in_contact(geometry(scene.axes(), last.theta), last.theta, last.omega,
                                   last.x, 0.0, Mode::rolling);
    const Mode next = first_continuation(scene, state, false).mode;
    return next == Mode::flight ? Outcome::loses_contact : Outcome::slips;
}

// The outcome for a circle that rolls, within half a turn: it has no tip.
Outcome outcome_of_circle(const SlopeFlow& flow) {
    const double uphill = flow.start.omega;
    if (uphill >= 0) return Outcome::rolls_over;
    return square(uphill) < 2 * pi * flow.acceleration ? Outcome::rocks : Outcome::rolls_over;
}

// The outcome for a body that rolls on a slope, from its series.
Outcome outcome_on_slope(const Scene& scene, const State& start, const Checkpoint& checkpoint) {
    constexpr int most_pieces = 100'000;
    SlopeFlow flow = slope_flow(scene.body(), scene.slope, start.theta, start.omega, start.x);
    if (flow.kind == MotionKind::uniform) {
        const LawMeetings met = law_meetings(flow, scene.friction);
        if (met.touched) return Outcome::edge;
        return met.broken ? Outcome::slips : outcome_of_circle(flow);
    }
    LawWatch watch(flow, scene.friction);
    SlopePlace place = flow.start;
    for (int i = 0; i < most_pieces; ++i) {
        if (i % steps_between_checks == 0) checkpoint();
        const SlopePiece piece = piece_from(flow.body, place);
        if (std::isinf(piece.lasts)) return Outcome::edge;
        const SlopePlace next = place_after(flow.body, flow.energy, piece);
        const double turns = double(time_of_turning(piece));
        const double tips = time_of_tip(piece);
        const bool breaks = watch.examine(piece);
        const LawMeetings met = watch.met();
        const double first = std::min(turns, tips);
        const auto before = [&](const std::optional<Meeting>& meeting) {
            return meeting && meeting->time <= first * flow.body.time;
        };
        if (before(met.touched)) return Outcome::edge;
        if (breaks && before(met.broken)) return after_rolling(scene, flow, met.broken->time);
        if (first < infinity) return turns < tips ? Outcome::rocks : Outcome::rolls_over;
        place = next;
    }
    return Outcome::edge;
}

}  // namespace

Outcome outcome(const Scene& scene, const Checkpoint& checkpoint) {
    const State start = initial_state(scene).state;
    const Continuation next = first_continuation(scene, start);
    switch (next.mode) {
        case Mode::rest:
            return Outcome::rests;
        case Mode::flight:
            return Outcome::loses_contact;
        case Mode::sliding:
            return next.paradox == Painleve::determined ? Outcome::slips : Outcome::jams;
        case Mode::rolling:
            break;
    }
    if (scene.slope != 0) return outcome_on_slope(scene, start, checkpoint);
    return classify(scene.body(), scene.friction, start.theta, start.omega);
}

double press_to(const Scene& scene, double distance, double omega) {
    require_finite("distance", unit::length, distance);
    validate_motion(scene.body(), scene.theta, omega);
    const State state = state_before_impulse(scene);
    const Geometry at = geometry(scene.axes(), state.theta);
    const double k2 = scene.body().gyration2;
    const double wanted = inertia_about_contact(k2, at) * omega;
    const double there = k2 * state.omega + at.h * state.x_dot + at.dh * state.z_dot;
    const double force = scene.mass * (wanted - there) / (distance - at.dh);
    Scene pressed = scene;
    pressed.impulse = Impulse{0.0, -force, distance, 0.0};
    return energy_after_impulse(pressed) <= most_energy ? force : std::copysign(infinity, force);
}

double speed_to_the_tip(const Scene& scene) {
    const Body body = scene.body();
    const RollingStart at_rest = rolling_start(body, scene.theta, 0.0);
    const Geometry at = geometry(body.axes(), scene.theta);
    const double inertia = inertia_about_contact(body.gyration2, at);
    return std::sqrt(std::max(-at_rest.height.over_tip, 0.0) * 2 * body.gravity / inertia);
}

double required_friction(const Scene& scene) {
    const double in_the_blow = sticking_friction(scene);
    if (in_the_blow == infinity) return infinity;
    Scene rough = scene;
    rough.friction = infinity;
    const State start = initial_state(rough).state;
    const Certificate found =
        scene.slope != 0 ? certify_on_slope(rough, start, {Validity::no_proof})
                         : certify_rolling(rolling_start(scene.body(), start.theta, start.omega),
                                           scene.mass, rough.friction);
    return std::max(in_the_blow, *found.largest_friction_needed);
}

}  // namespace rolling_ellipse
