
#include <algorithm>
#include <cmath>

#include "contact/slide.hpp"
#include "numerics/bisect.hpp"
#include "outcome/onset.hpp"
#include "outcome/outcome.hpp"
#include "proof/certificate.hpp"

namespace rolling_ellipse {
namespace {

// The least friction with which sliding may jam. With K = k^2, B = S^2, u = h^2 and
// Y = (1 - u)(u - B) = (h h')^2, mu = (K + Y/u)/sqrt(Y) is stationary where
// -K Y' u^2 + Y Y' u - 2 Y^2 = 0, physics (49).
Onset painleve(const Shape& shape) {
    const double b2 = square(shape.short_axis);
    const double k2 = shape.gyration2;
    const double w = shape.c2;  // u = B + w x
    const Polynomial<1> u = polynomial(b2, w);
    const Polynomial<2> y = polynomial(0.0, w) * polynomial(w, -w);
    const Polynomial<1> dy = polynomial(w, -2 * w);
    const Polynomial<4> stationary = (-k2) * (dy * u * u) + y * dy * u - 2.0 * (y * y);
    Onset onset;
    for (const double x : roots_on_unit_interval(bernstein(stationary))) {
        const double y_here = w * x * w * (1 - x);
        if (y_here <= 0) continue;
        onset.lower_to((k2 + y_here / (b2 + w * x)) / std::sqrt(y_here),
                       std::atan2(std::sqrt(x), std::sqrt(1 - x)));
    }
    return onset;
}

// Whether a slide under infinite friction reaches the tip. In such a slide N = 0: the centre is in
// free fall, and h'^2 omega^2 + 2 g h is constant, physics (52). If this constant is below 2 g L,
// the body turns back before the tip with c = g + h'' omega^2 > 0: since h'' falls on the way to
// the tip, c h'^2 falls, too, but no further than g h'^2, its value where omega vanishes.
bool reaches_the_tip(const Scene& scene, const State& start) {
    const double h = geometry(scene.axes(), start.theta).h;
    const double to_tip = under_tip(flat_view(scene.axes(), start.theta), h);
    return square(start.z_dot) >= 2 * scene.gravity * to_tip;
}

// The moment of inertia per mass about the contact in the flat position.
double flat_inertia(const Body& body, const FlatView& at) {
    return body.gyration2 + square(at.short_axis);
}

// The angular velocity in the flat position, given the energy above it in units of the long
// semi-axis: physics (44).
double flat_speed(const Body& body, const FlatView& at, double over_flat) {
    return std::sqrt(2 * body.gravity * at.long_axis * over_flat / flat_inertia(body, at));
}

// What happens to a body between the flat position, which it passes rolling, and the tip.
enum class Fate { stays, leaves, jams };

// The state at the end of a segment and the motion that follows.
struct EndOfSegment {
    State state;
    Continuation next;
};

// The climb of a body from the flat position to the tip, at any speed.
struct Climb {
    const Scene& scene;
    const Checkpoint& checkpoint;
    double flat = scene.a >= scene.b ? 0.0 : half_pi;  // theta of the flat position
    double tip = flat + half_pi;

    // The fate of a body that passes the flat position with the angular velocity omega. The
    // acceleration c can vanish only on the way up, since h'' falls from the flat position to the
    // tip and the rate of c is h''' omega^3, physics (53).
    Fate fate(double omega) const {
        // A climb with more segments contains slides of zero length. N and c then vanish together
        // at the tip, and the body leaves the ground.
        constexpr int most_segments = 64;
        checkpoint();
        State state = without_slip(scene.axes(), flat, omega, 0.0, Mode::rolling);
        Continuation next = continuation(scene, state);
        for (int i = 0; state.theta < tip; ++i) {
            if (next.mode == Mode::flight || i == most_segments) return Fate::leaves;
            if (next.paradox != Painleve::determined) return Fate::jams;
            const auto end =
                next.mode == Mode::rolling ? end_of_rolling(state) : end_of_slide(state, next.side);
            if (!end) return Fate::stays;
            state = end->state;
            next = end->next;
        }
        return next.mode == Mode::flight ? Fate::leaves : Fate::stays;
    }

    // The end of a segment of rolling; empty if the body passes the tip or turns back.
    std::optional<EndOfSegment> end_of_rolling(const State& from) const {
        const RollingStart start = rolling_start(scene.body(), from.theta, from.omega);
        const EndOfRolling end = rolling_ellipse::end_of_rolling(start, scene.friction);
        if (end.validity != Validity::invalid) return {};
        const RollingFlow flow = rolling_flow(start);
        const auto [theta, omega, x] = sample(flow, time_of_end(flow, end));
        const State state = without_slip(scene.axes(), theta, omega, x, Mode::rolling);
        return EndOfSegment{state, continuation(scene, state, false)};
    }

    std::optional<EndOfSegment> end_of_slide(const State& from, double side) const {
        constexpr double over_the_tip = 0.5;  // angle past the tip [rad], where c no longer falls
        constexpr long most_pieces = 2000;
        if (std::isinf(scene.friction) && !reaches_the_tip(scene, from)) return {};
        Slide slide = slide_from(scene, from, side);
        const SlideStop stop =
            slide_on(slide, {infinity, most_pieces, tip + over_the_tip}, checkpoint);
        State state = end_of(slide);
        if (state.theta > tip + over_the_tip || state.omega < 0) return {};
        if (stop == SlideStop::pressure_vanishes) return EndOfSegment{state, {Mode::flight}};
        if (stop == SlideStop::jams) {
            return EndOfSegment{state, {Mode::sliding, side, Painleve::no_motion}};
        }
        if (stop != SlideStop::slip_vanishes) return {};
        state = without_slip(scene.axes(), state.theta, state.omega, state.x, Mode::sliding);
        return EndOfSegment{state, continuation(scene, state)};
    }
};

// A speed below which the body cannot leave the ground: at lift-off omega^2 >= g/|h''|
// >= g L/|a^2 - b^2|, physics (53), and the body has no more energy than at the start.
double too_slow(const Body& body, const FlatView& at) {
    return std::sqrt(body.gravity * at.long_axis / at.c2 * body.gyration2 / flat_inertia(body, at));
}

// The least speed of lift-off and the speeds of jams, from a scan with geometric steps. Without
// jams the scan is coarse, since a body that leaves the ground at one speed does so at any higher
// speed. With jams it is fine and goes up to `high`, since fates may alternate.
LiftOff scanned(const Climb& climb, double low, double high, bool may_jam) {
    const double growth = may_jam ? 1.02 : 1.05;
    const int most_growths = may_jam ? int(std::log(high / low) / std::log(growth)) + 1 : 200;
    constexpr double known = 1e-5;   // relative step past a change, close to which rounding decides
    constexpr int most_changes = 8;  // largest number of changes in one step
    LiftOff lift_off;
    Fate before = Fate::stays;
    const auto change = [&](double at, Fate next) {
        if (before == Fate::jams) lift_off.jam_speeds.back().upper = at;
        if (next == Fate::jams) lift_off.jam_speeds.push_back({at, infinity});
        if (next == Fate::leaves) lift_off.speed = std::min(lift_off.speed, at);
        before = next;
    };
    double speed = low;
    for (int i = 0; i <= most_growths; ++i) {
        double slower = speed;
        if (i > 0) speed *= growth;
        const Fate fate = climb.fate(speed);
        if (i == 0 && fate != before) change(low, fate);
        for (int k = 0; fate != before; ++k) {
            const auto is_changed = [&](double omega) { return climb.fate(omega) != before; };
            const double at = bisect(slower, speed, is_changed).high;
            slower = std::min(at * (1 + known), speed);
            const Fate next = k < most_changes ? climb.fate(slower) : fate;
            if (next != before) change(at, next);
        }
        if (before == Fate::leaves && !may_jam) break;
    }
    return lift_off;
}

}  // namespace

double roll_over_speed(const Body& body) {
    const FlatView at = flat_view(body.axes(), 0.0);
    return std::sqrt(2 * body.gravity * (at.long_axis - at.short_axis) / flat_inertia(body, at));
}

Thresholds thresholds(const Body& body, double friction) {
    const FlatView at = flat_view(body.axes(), 0.0);
    const Shape shape = rolling_ellipse::shape(body, at);
    const double tip_inertia = body.gyration2 + square(at.long_axis);

    Thresholds result{};
    // physics (44, 45)
    result.roll_over_speed = roll_over_speed(body);
    result.rocking_rate =
        std::sqrt(body.gravity * at.c2 / (at.short_axis * flat_inertia(body, at)));
    result.tip_rate = std::sqrt(body.gravity * at.c2 / (at.long_axis * tip_inertia));
    if (at.c2 == 0) {
        if (friction > 0) return result;
        result.slip_windows = {{0.0, infinity}};
        result.slip_angle = 0.0;
        return result;
    }

    const auto theta_of = [&](std::optional<double> angle) {
        if (angle && body.a < body.b) angle = half_pi - *angle;
        return angle;
    };
    const Onset loss = contact_loss(shape);
    result.contact_loss_speed = flat_speed(body, at, loss.value);
    result.contact_loss_angle = theta_of(loss.angle);
    const std::vector<SlipWindow> windows = slip_windows(shape, friction);
    for (const SlipWindow& window : windows) {
        result.slip_windows.push_back(
            {flat_speed(body, at, window.start.value), flat_speed(body, at, window.end)});
    }
    result.slip_angle = theta_of(windows.front().start.angle);
    const EnergyRange separatrix = separatrix_range(shape);
    result.friction_to_roll_over =
        force_extremes(separatrix, force_polynomials(separatrix)).most_friction.needed();
    const Onset jamming = painleve(shape);
    result.painleve_friction = jamming.value;
    result.painleve_angle = theta_of(jamming.angle);
    return result;
}

LiftOff lift_off(const Body& body, double friction, double slip_speed, double painleve_friction,
                 const Checkpoint& checkpoint) {
    const FlatView at = flat_view(body.axes(), 0.0);
    if (at.c2 == 0) return {};
    const Units units = natural_units(body);
    const Scene scene = in_units(level_scene(body, friction), units);
    const double low = std::max(slip_speed, too_slow(body, at)) * units.time;
    // At 50 times the roll-over and contact-loss speeds, gravity is 2500 times weaker relative to
    // omega^2 and no longer matters. The slip speed may be far lower, if the body slips even from
    // rest.
    const double loss = flat_speed(body, at, contact_loss(shape(body, at)).value);
    const double high = 50 * std::max(low, std::max(roll_over_speed(body), loss) * units.time);
    const bool may_jam = std::isfinite(friction) && friction > painleve_friction;
    LiftOff result = scanned(Climb{scene, checkpoint}, low, high, may_jam);
    result.speed /= units.time;
    for (SpeedRange& jams : result.jam_speeds) {
        jams.lower /= units.time;
        jams.upper /= units.time;
    }
    return result;
}

}  // namespace rolling_ellipse
