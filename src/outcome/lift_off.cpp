#include "outcome/lift_off.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "contact/continuation.hpp"
#include "contact/slide.hpp"
#include "numerics/bisect.hpp"
#include "proof/certificate.hpp"

namespace rolling_ellipse {
namespace {

Scene level_scene(const Body& body, double friction) {
    Scene scene{};
    scene.a = body.a;
    scene.b = body.b;
    scene.mass = 1.0;
    scene.gravity = body.gravity;
    scene.inertia = body.gyration2;
    scene.friction = friction;
    return scene;
}

// With infinite friction the slide has N = 0: its centre is in free fall, h'^2 omega^2 + 2 g h
// stays what it is, physics (52). Below 2 g L it turns back under the tip with c > 0: from the flat
// to the tip h'' falls, so that c h'^2 = g h'^2 + h'' h'^2 omega^2 falls as well, but to g h'^2
// where omega vanishes.
bool reaches_the_tip(const Scene& scene, const State& start) {
    const double h = geometry(scene.axes(), start.theta).h;
    const double to_tip = under_tip(flat_view(scene.axes(), start.theta), h);
    return square(start.z_dot) >= 2 * scene.gravity * to_tip;
}

// What becomes of a body that rolls over the flat position, before it passes the tip.
enum class Fate { stays, leaves, jams };

// The state in which a segment ends, and what goes on from there; nothing if the body gets over the
// tip or turns back.
struct EndOfSegment {
    State state;
    Continuation next;
};

// Follows the body from the flat position to the tip at one speed after another.
class Follower {
  public:
    Follower(const Scene& scene, const Checkpoint& checkpoint)
        : scene_(scene),
          axes_(scene.axes()),
          flat_(scene.a >= scene.b ? 0.0 : half_pi),
          tip_(flat_ + half_pi),
          checkpoint_(checkpoint) {}

    // Only on the way up can c vanish: where it does, its rate is h''' omega^3, physics (53), and
    // h'' falls from the flat to the tip.
    Fate fate(double omega) {
        // Where N and c vanish together, right at the tip, there are only slides of no length
        // before.
        constexpr int most_segments = 64;
        checkpoint_();
        State state = in_contact(geometry(axes_, flat_), flat_, omega, 0.0, 0.0, Mode::rolling);
        Continuation next = continuation(scene_, state);
        for (int i = 0; state.theta < tip_; ++i) {
            if (next.mode == Mode::flight || i == most_segments) return Fate::leaves;
            if (next.paradox != Painleve::determined) return Fate::jams;
            const std::optional<EndOfSegment> end =
                next.mode == Mode::rolling ? end_of_rolling(state) : end_of_slide(state, next.side);
            if (!end) return Fate::stays;
            state = end->state;
            next = end->next;
        }
        return next.mode == Mode::flight ? Fate::leaves : Fate::stays;
    }

  private:
    static constexpr double over_the_tip = 0.5;  // [rad], where c no longer falls

    std::optional<EndOfSegment> end_of_rolling(const State& from) {
        const RollingStart start = rolling_start(scene_.body(), from.theta, from.omega);
        const EndOfRolling end = rolling_ellipse::end_of_rolling(start, scene_.friction);
        if (end.validity != Validity::invalid) return std::nullopt;
        const RollingFlow flow = rolling_flow(start);
        const FlowSample last = sample(flow, time_of_end(flow, end));
        const State state = in_contact(geometry(axes_, last.theta), last.theta, last.omega, last.x,
                                       0.0, Mode::rolling);
        return EndOfSegment{state, continuation(scene_, state, false)};
    }

    std::optional<EndOfSegment> end_of_slide(const State& from, double side) {
        if (std::isinf(scene_.friction) && !reaches_the_tip(scene_, from)) return std::nullopt;
        constexpr long most_pieces = 2000;
        Slide slide = slide_from(scene_, from, side);
        const SlideStop stop =
            slide_on(slide, {infinity, most_pieces, tip_ + over_the_tip}, checkpoint_);
        switch (stop) {
            case SlideStop::slip_vanishes:
            case SlideStop::pressure_vanishes:
            case SlideStop::jams:
                break;
            default:
                return std::nullopt;
        }
        State state = end_of(slide);
        if (state.theta > tip_ + over_the_tip || state.omega < 0) return std::nullopt;
        if (stop == SlideStop::pressure_vanishes) return EndOfSegment{state, {Mode::flight}};
        if (stop == SlideStop::jams) {
            return EndOfSegment{state, {Mode::sliding, side, Painleve::no_motion}};
        }
        state = in_contact(geometry(axes_, state.theta), state.theta, state.omega, state.x, 0.0,
                           Mode::sliding);
        return EndOfSegment{state, continuation(scene_, state)};
    }

    const Scene& scene_;
    const Axes axes_;
    const double flat_;
    const double tip_;
    const Checkpoint& checkpoint_;
};

// At lift-off omega^2 >= g/|h''| >= g L/c^2, physics (53), with no more energy than at the start.
double too_slow(const Body& body, const FlatView& at) {
    const double flat_inertia = body.gyration2 + square(at.short_axis);
    return std::sqrt(body.gravity * at.long_axis / at.c2 * body.gyration2 / flat_inertia);
}

// The first double above `low` with another fate than there, up to `high`, which has one.
double change_between(Follower& body, double low, double high) {
    const Fate before = body.fate(low);
    return bisect(low, high, [&](double speed) { return body.fate(speed) != before; }).high;
}

// Without jams a body that leaves does so at any higher speed: coarse steps find the threshold.
LiftOff climbed(Follower& body, double low) {
    constexpr double growth = 1.05;
    constexpr int most_growths = 200;
    if (body.fate(low) == Fate::leaves) return {low, {}};
    double high = growth * low;
    for (int i = 0; body.fate(high) != Fate::leaves; ++i) {
        if (i == most_growths) return {infinity, {}};
        low = high;
        high *= growth;
    }
    return {change_between(body, low, high), {}};
}

// With jams the fates may alternate: a scan up to speeds beside which gravity, in units of omega^2
// 2500 times weaker than at the slip speed, decides nothing any more.
LiftOff scanned(Follower& body, double low) {
    constexpr double growth = 1.02;
    constexpr int most_growths = 198;  // a factor of 50
    LiftOff found{infinity, {}};
    Fate fate = Fate::stays;
    double before = low;
    for (int i = 0; i <= most_growths; ++i) {
        const double speed = i == 0 ? low : before * growth;
        const Fate now = body.fate(speed);
        if (now != fate) {
            const double change = i == 0 ? low : change_between(body, before, speed);
            if (fate == Fate::jams) found.jam_speeds.back().upper = change;
            if (now == Fate::jams) found.jam_speeds.push_back({change, infinity});
            if (now == Fate::leaves) found.speed = std::min(found.speed, change);
        }
        fate = now;
        before = speed;
    }
    return found;
}

}  // namespace

LiftOff lift_off(const Body& body, double friction, double slip_speed, double painleve_friction,
                 const Checkpoint& checkpoint) {
    const FlatView at = flat_view(body.axes(), 0.0);
    if (at.c2 == 0) return {infinity, {}};
    const Scene level = level_scene(body, friction);
    const Units units = natural_units(level.body(), level.mass);
    const Scene scene = in_units(level, units);
    Follower follower(scene, checkpoint);
    const double low = std::max(slip_speed, too_slow(body, at)) * units.time;
    const bool may_jam = std::isfinite(friction) && friction > painleve_friction;
    LiftOff found = may_jam ? scanned(follower, low) : climbed(follower, low);
    found.speed /= units.time;
    for (SpeedRange& jams : found.jam_speeds) {
        jams.lower /= units.time;
        jams.upper /= units.time;
    }
    return found;
}

}  // namespace rolling_ellipse
