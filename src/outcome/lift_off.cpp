#include <algorithm>
#include <cmath>

#include "contact/continuation.hpp"
#include "contact/slide.hpp"
#include "numerics/bisect.hpp"
#include "outcome/thresholds.hpp"
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

// Does a slide under infinite friction get to the tip? It has N = 0: its centre is in free fall,
// and h'^2 omega^2 + 2 g h is constant, physics (52). Below 2 g L it turns back under the tip with
// c > 0: from the flat to the tip h'' falls, so that c h'^2 = g h'^2 + h'' h'^2 omega^2 falls, too,
// but to g h'^2 where omega vanishes.
bool reaches_the_tip(const Scene& scene, const State& start) {
    const double h = geometry(scene.axes(), start.theta).h;
    const double to_tip = under_tip(flat_view(scene.axes(), start.theta), h);
    return square(start.z_dot) >= 2 * scene.gravity * to_tip;
}

// Fate of a body that rolls over the flat position, before it passes the tip.
enum class Fate { stays, leaves, jams };

// The state at the end of a segment, and the motion that follows.
struct EndOfSegment {
    State state;
    Continuation next;
};

// The climb of the body from the flat position to the tip, for any speed.
class Climb {
  public:
    Climb(const Scene& scene, const Checkpoint& checkpoint)
        : scene_(scene),
          axes_(scene.axes()),
          flat_(scene.a >= scene.b ? 0.0 : half_pi),
          tip_(flat_ + half_pi),
          checkpoint_(checkpoint) {}

    // The climb alone decides: c vanishes only on the way up, where its rate is h''' omega^3,
    // physics (53), since h'' falls from the flat to the tip.
    Fate fate(double omega) const {
        // So many segments mean slides of no length: N and c vanish together, right at the tip.
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

    // Both are empty if the body gets over the tip, or turns back.
    std::optional<EndOfSegment> end_of_rolling(const State& from) const {
        const RollingStart start = rolling_start(scene_.body(), from.theta, from.omega);
        const EndOfRolling end = rolling_ellipse::end_of_rolling(start, scene_.friction);
        if (end.validity != Validity::invalid) return std::nullopt;
        const RollingFlow flow = rolling_flow(start);
        const FlowSample last = sample(flow, time_of_end(flow, end));
        const State state = in_contact(geometry(axes_, last.theta), last.theta, last.omega, last.x,
                                       0.0, Mode::rolling);
        return EndOfSegment{state, continuation(scene_, state, false)};
    }

    std::optional<EndOfSegment> end_of_slide(const State& from, double side) const {
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

// A speed below which the body cannot leave the ground: at lift-off omega^2 >= g/|h''| >= g L/c^2,
// physics (53), with no more energy than at the start.
double too_slow(const Body& body, const FlatView& at) {
    const double flat_inertia = body.gyration2 + square(at.short_axis);
    return std::sqrt(body.gravity * at.long_axis / at.c2 * body.gyration2 / flat_inertia);
}

// Steps of the speed, each by a factor.
struct Scan {
    double growth;
    int most_growths;
};

// Without jams a body that leaves the ground does so at any higher speed: coarse steps find the
// least one.
constexpr Scan coarse{1.05, 200};

// With jams the fates may alternate, up to 50 times the slip speed: there gravity, 2500 times
// weaker in units of omega^2, no longer matters.
constexpr Scan fine{1.02, 198};

LiftOff scanned(const Climb& climb, double low, bool may_jam) {
    const auto [growth, most_growths] = may_jam ? fine : coarse;
    LiftOff found;
    Fate before = Fate::stays;
    double speed = low;
    for (int i = 0; i <= most_growths; ++i) {
        const double slower = speed;
        if (i > 0) speed *= growth;
        const Fate fate = climb.fate(speed);
        if (fate == before) continue;
        const auto is_changed = [&](double omega) { return climb.fate(omega) != before; };
        const double change = i == 0 ? low : bisect(slower, speed, is_changed).high;
        if (before == Fate::jams) found.jam_speeds.back().upper = change;
        if (fate == Fate::jams) found.jam_speeds.push_back({change, infinity});
        if (fate == Fate::leaves) found.speed = std::min(found.speed, change);
        if (fate == Fate::leaves && !may_jam) break;
        before = fate;
    }
    return found;
}

}  // namespace

LiftOff lift_off(const Body& body, double friction, double slip_speed, double painleve_friction,
                 const Checkpoint& checkpoint) {
    const FlatView at = flat_view(body.axes(), 0.0);
    if (at.c2 == 0) return {};
    const Scene level = level_scene(body, friction);
    const Units units = natural_units(level.body(), level.mass);
    const Scene scene = in_units(level, units);
    const double low = std::max(slip_speed, too_slow(body, at)) * units.time;
    const bool may_jam = std::isfinite(friction) && friction > painleve_friction;
    LiftOff found = scanned(Climb(scene, checkpoint), low, may_jam);
    found.speed /= units.time;
    for (SpeedRange& jams : found.jam_speeds) {
        jams.lower /= units.time;
        jams.upper /= units.time;
    }
    return found;
}

}  // namespace rolling_ellipse
