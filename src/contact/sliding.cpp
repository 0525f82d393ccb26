#include "contact/sliding.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/wide.hpp"
#include "proof/law.hpp"
#include "rolling/stepped/equation.hpp"

namespace rolling_ellipse {
namespace {

// Angular acceleration per unit of contact force, physics (51).
double spin(const SlidingBody& body, const Geometry& at) {
    return -body.lever(at) / body.gyration2;
}

// dB/dtheta, with B of physics (50).
double response_derivative(const SlidingBody& body, const Geometry& at) {
    return (2 * body.normal_share * at.dh * at.ddh +
            body.friction_share * (at.dh * at.dh + at.h * at.ddh) +
            body.normal_share * body.ahead * at.ddh) /
           body.gyration2;
}

}  // namespace

SlidingBody sliding_body(const Scene& scene, const Geometry& at, double omega, double side) {
    const bool endless = std::isinf(scene.friction);
    SlidingBody body{scene.axes(),
                     scene.mass,
                     scene.body().gyration2,
                     scene.ground_gravity(),
                     side,
                     endless ? 0.0 : 1.0,
                     endless ? -side : -scene.friction * side,
                     0.0,
                     false};
    if (endless || scene.rolling_resistance == 0) return body;  // no couple without normal force
    body.is_held =
        omega == 0 && is_within(scene.rolling_resistance, at.dh, at.h * body.friction_share);
    if (!body.is_held) body.ahead = lever_against(scene, omega == 0 ? -body.lever(at) : omega);
    return body;
}

// The response c and B = Gnn - mu s Gtn (s is `side`), from which N = c/B per mass, physics (50);
// with infinite friction F = c/Gtn and N = 0, physics (52). Rolling resistance adds a term to B.
Response response(const SlidingBody& body, const Geometry& at, double omega) {
    const double c = free_acceleration(at, body.gravity.into, omega);
    const double gnn = 1 + at.dh * at.dh / body.gyration2;
    const double gtn = at.h * at.dh / body.gyration2;
    if (body.is_held) return {c, body.normal_share};
    const double by_resistance = body.normal_share * body.ahead * at.dh / body.gyration2;
    return {c, body.normal_share * gnn + body.friction_share * gtn + by_resistance};
}

PreciseHeight2 precise_height2(const Axes& axes, const DoubleDouble& angle) {
    const auto [a, b] = axes;
    const auto [quarters, rest] = quarter_view(angle);
    const auto [sine, cosine] = sine_cosine_of_rest(rest);
    const double c2 = (is_odd(quarters) ? b - a : a - b) * (a + b);
    return {sine * sine * c2 + square(is_odd(quarters) ? a : b), sine * cosine * c2};
}

std::optional<double> cancelled_response(const SlidingBody& body, const Geometry& at,
                                         const DoubleDouble& angle) {
    constexpr double little = 0x1p-4;  // below this fraction of its terms, a sum has lost digits
    const double nu = body.normal_share;
    const double phi = body.friction_share;
    const double terms = body.gyration2 + square(at.dh) + std::abs(phi * at.h * at.dh) +
                         std::abs(nu * body.ahead * at.dh);
    if (!body.may_jam() || response(body, at, 0.0).b * body.gyration2 > little * terms) return {};
    const auto [u, p] = precise_height2(body.axes, angle);
    DoubleDouble lever = p * nu + u * phi;
    if (body.ahead != 0) lever = lever + square_root(u) * (nu * body.ahead);
    return double(u * (nu * body.gyration2) + p * lever);
}

ContactForce sliding_force(const SlidingBody& body, const Geometry& at, double omega) {
    const auto [c, b] = response(body, at, omega);
    const double force = body.mass * (std::max(c, 0.0) / b);  // c < 0 at lift-off is rounding
    return {body.normal_share * force, body.friction_share * force};
}

double slip_rate(const SlidingBody& body, const Geometry& at, double omega) {
    const auto [c, b] = response(body, at, omega);
    const double by_force = (body.friction_share - at.h * spin(body, at)) * (c / b);
    return by_force + body.gravity.along - at.dh * omega * omega;
}

double slowed_response_rate(const SlidingBody& body, const Geometry& at, double c) {
    return std::sqrt(std::abs(response_derivative(body, at) * c * spin(body, at)));
}

// The impulse of N changes omega and the slip in a fixed ratio, physics (54). At B = 0, a unit of
// impulse adds 1/h' to omega; in a formula for any B, terms would all but cancel for a body of
// small inertia.
LastMoment last_moment(const SlidingBody& body, double angle, double omega, double slip) {
    const Geometry at = geometry(body.axes, angle);
    const double b_derivative = response_derivative(body, at);
    const auto [c, b] = response(body, at, omega);
    const double turn_by_force = body.normal_share / at.dh;
    const double slip_by_turning = body.friction_share / turn_by_force - at.h;
    const double without_slip = omega - slip / slip_by_turning;
    const double without_c = std::copysign(std::sqrt(-body.gravity.into / at.ddh), omega);
    const double impulse_to_stop = (without_slip - omega) / turn_by_force;
    const double to_no_c = (without_c - omega) / turn_by_force;
    const double impulse_to_jam = at.ddh < 0 && to_no_c >= 0 ? to_no_c : infinity;
    const double to_turn = -omega / turn_by_force;
    const double impulse_to_turn = body.ahead != 0 && to_turn >= 0 ? to_turn : infinity;
    const double impulse_to_end = std::min(impulse_to_jam, impulse_to_turn);
    const bool stops = impulse_to_stop >= 0 && impulse_to_stop <= impulse_to_end;
    const bool turns = !stops && impulse_to_turn < impulse_to_jam;
    const double omega_after = stops ? without_slip : turns ? 0.0 : without_c;
    const double slip_after = stops ? 0.0 : slip + slip_by_turning * (omega_after - omega);
    // Lasts until B = 0 or until N = c/B has delivered the impulse. A body that starts to slide
    // with such a small B may turn away from B = 0, or not turn at all.
    const double b_rate = b_derivative * omega;
    const double until_no_b = b_rate < 0 ? -b / b_rate : infinity;
    const double until_made = (stops ? impulse_to_stop : impulse_to_end) * b / c;
    const double least = std::min(until_no_b, until_made >= 0 ? until_made : infinity);
    return {stops,
            turns,
            omega_after,
            slip_after,
            slip_after + at.h * omega_after,
            least < infinity ? least : 0.0};
}

// The derivatives of u = h^2, p = h h' and q = p' with respect to the angle are 2 p, q and -4 p.
ROLLING_ELLIPSE_WIDE SlideSeries slide_series(const SlidingBody& body, const SlideCentre& centre,
                                              SlideClock clock) {
    const auto [sin, cos, omega0, slip0, x_dot0, response0, torque0] = centre;
    const auto [a, b] = body.axes;
    const double c2 = body.axes.c2();
    const double k2 = body.gyration2;
    const double nu = body.normal_share;
    const double phi = body.friction_share;
    const double turns = body.is_held ? 0.0 : 1.0;
    const double ahead = nu * body.ahead;
    const bool slowed = clock == SlideClock::slowed;

    SlideSeries slide;
    auto& [motion, slip, rolled, pressure, response, u, work] = slide;
    auto& [angle, w, x_dot, path, time] = motion;
    Factors curve, by_curve;   // (p, q, h, (a b - u)(a b + u)) times (angle', angle', h, omega^2)
    Factors lever, by_lever;   // (p, u, u, h) times (L, h, V, V)
    Factors force, by_force;   // (L, h, u V, h V) times (C, omega, omega', impulse')
    Factors clocks, by_clock;  // (dt/dtau, C, dt/dtau, impulse') times (omega, h, x_dot, h omega)
    Factors squared;           // (omega, u) times itself
    // (a b - u)(a b + u) as a product, without cancellation for thin bodies or circles.
    const double u0 = square(a * sin) + square(b * cos);
    const double bend0 = (a - b) * (b * square(cos) - a * square(sin)) * (a * b + u0);
    const double h0 = std::sqrt(u0);
    const double over_2h0 = 0.5 / h0;
    const double per_clock = 1 / (k2 * u0 * u0);
    double over_turning = 0.0;
    double over_pulling = 0.0;
    double p = c2 * sin * cos;
    double q = c2 * ((cos - sin) * (cos + sin));
    double impulse = 0.0;
    const double l0 =
        response0 ? (*response0 - nu * k2 * u0) / p : turns * (nu * p + phi * u0) + ahead * h0;
    u[0] = u0;
    w[0] = omega0;
    angle[0] = path[0] = time[0] = work[0] = 0.0;

    for (int k = 0; k <= long_order; ++k) {
        const Quad curves = inner(curve, by_curve, k);
        const Quad levers = inner(lever, by_lever, k);
        const Quad forces = inner(force, by_force, k);
        const Quad clocked = inner(clocks, by_clock, k);
        const Quad squares = self_product(squared, k, 1);
        const ProductAt product{k};
        const double h = k == 0 ? h0 : (u[k] - curves[2]) * over_2h0;
        const double l = k == 0 ? l0 : turns * (nu * p + phi * u[k]) + ahead * h;
        const double omega2 = k == 0 ? w[0] * w[0] : squares[0] + 2 * (squared[0][0] * w[k]);
        const double bend = k == 0 ? bend0 : -(squares[1] + 2 * (squared[0][1] * u[k]));
        const double weight = product(levers, lever, by_lever, 1, u[k], h);
        const double v = k == 0 && response0
                             ? *response0
                             : nu * k2 * u[k] + product(levers, lever, by_lever, 0, p, l);
        const double c =
            body.gravity.into * weight + product(curves, curve, by_curve, 3, bend, omega2);
        const double load = product(levers, lever, by_lever, 2, u[k], v);
        const double pull_load = product(levers, lever, by_lever, 3, h, v);
        const double torque = product(forces, force, by_force, 0, l, c);
        response[k] = v;
        pressure[k] = c;
        rolled[k] = product(forces, force, by_force, 1, h, w[k]);

        double turning = -torque;
        double pulling = phi * k2 * c;
        double rate = 0.0;
        double spread = w[k];
        if (slowed) {
            rate = per_clock * load;
            turning = per_clock * turning;
            pulling = per_clock * phi * k2 * product(clocked, clocks, by_clock, 1, c, h);
            spread = product(clocked, clocks, by_clock, 0, rate, w[k]);
        } else {
            if (k == 0) {
                over_turning = 1 / load;
                over_pulling = 1 / pull_load;
            } else {
                turning = turning - forces[2] - load * by_force[0][2];
                pulling = pulling - forces[3] - pull_load * by_force[0][3];
            }
            turning *= over_turning;
            pulling *= over_pulling;
        }
        x_dot[k] = k == 0 ? x_dot0 : impulse + body.gravity.along * time[k];
        slip[k] = k == 0 ? slip0 : x_dot[k] - rolled[k];
        if (k == long_order) break;

        const double over = over_next[k];
        const double p_rate = product(curves, curve, by_curve, 1, q, spread) * over;
        const double half_u_rate = product(curves, curve, by_curve, 0, p, spread) * over;
        const double power = product(clocked, clocks, by_clock, 3, pulling, rolled[k]);
        const double path_rate =
            slowed ? product(clocked, clocks, by_clock, 2, rate, x_dot[k]) : x_dot[k];
        curve[k] = Quad{p, q, h, bend};
        by_curve[k] = Quad{spread, spread, h, omega2};
        lever[k] = Quad{p, u[k], u[k], h};
        by_lever[k] = Quad{l, h, v, v};
        force[k] = Quad{l, h, load, pull_load};
        by_force[k] = Quad{c, w[k], turning, pulling};
        clocks[k] = Quad{rate, c, rate, pulling};
        by_clock[k] = Quad{w[k], h, x_dot[k], rolled[k]};
        squared[k] = Quad{w[k], u[k], 0, 0};

        p = p_rate;
        q = -4 * half_u_rate;
        impulse = pulling * over;
        u[k + 1] = 2 * half_u_rate;
        angle[k + 1] = spread * over;
        w[k + 1] = turning * over;
        work[k + 1] = -power * over;
        path[k + 1] = path_rate * over;
        time[k + 1] = slowed ? rate * over : k == 0 ? 1.0 : 0.0;
    }
    return slide;
}

namespace {

double side_of(double v) { return std::copysign(1.0, v); }

// Whether the body remains at rest.
bool rests(const Scene& scene, const State& state, const Geometry& at) {
    if (state.omega != 0) return false;
    return is_held(scene, at) && std::abs(std::tan(scene.slope)) <= scene.friction;
}

// The body leaves the ground if c <= 0, physics (53), and jams if B <= 0, physics (50, 52). A slide
// with c < 0 and N = c/B > 0 is a second possible motion, besides flight, only if the body already
// slips; otherwise, N and F of rolling show that no slip can start to that side. A motion may start
// in such a state, but none leads to it: a slide ends earlier, where c or B vanishes, and an impact
// with B < 0 lasts until the slip stops.
Continuation slide_or_leave(const Scene& scene, const Geometry& at, double omega, double side,
                            bool slips = false) {
    const auto [c, b] = response(sliding_body(scene, at, omega, side), at, omega);
    if (slips && c < 0 && b < 0) return {Mode::sliding, side, Painleve::two_motions};
    if (c <= 0) return {Mode::flight};
    return {Mode::sliding, side, b <= 0 ? Painleve::no_motion : Painleve::determined};
}

// Whether a slide jams in this state: B = 0 and c = 0 to within rounding and an uncertainty `blur`
// of theta.
bool has_jammed(const Scene& scene, const State& state, const Geometry& at, double slip,
                double blur) {
    constexpr double rounding = 1e-12;  // a slide ends where B is a tenth of this
    if (slip == 0 || scene.friction == 0 || std::isinf(scene.friction)) return false;
    const SlidingBody body = sliding_body(scene, at, state.omega, side_of(slip));
    const auto [c, b] = response(body, at, state.omega);
    const double c_by_blur = free_acceleration_rate(at, state.omega) * blur;
    return std::abs(b) <= rounding + std::abs(response_derivative(body, at)) * blur &&
           std::abs(c) <= rounding * body.gravity.into + c_by_blur;
}

// How slip starts where rolling is impossible: in the direction in which the contact accelerates.
Continuation starting_to_slide(const Scene& scene, const Geometry& at, const State& state,
                               const ContactForce& rolling) {
    const auto to_side = [&](double side) { return slide_or_leave(scene, at, state.omega, side); };
    if (std::isinf(scene.friction)) return to_side(-side_of(at.dh));
    if (rolling.normal > 0) return to_side(-side_of(rolling.friction));
    for (const double side : {1.0, -1.0}) {
        const Continuation next = to_side(side);
        if (next.mode == Mode::flight) return next;
        const double rate = slip_rate(sliding_body(scene, at, state.omega, side), at, state.omega);
        if (next.paradox == Painleve::determined && side * rate > 0) return next;
    }
    return {Mode::sliding, 0.0, Painleve::no_motion};
}

// Whether a contact that rolls at the limit of its law (|F| = mu N, or N = 0 with infinite
// friction) is about to break it. The limit holds to within rounding and an uncertainty `blur` of
// theta; the first change of the margin that exceeds its rounding error decides.
bool breaks_away(const Scene& scene, const State& state, const Geometry& at,
                 const ContactForce& force, double blur) {
    constexpr double least_turn = 0x1p-20;  // angle of the first comparison [rad]
    constexpr double most_turn = 0x1p-8;
    const RollingEquation rolling(scene.body(), scene.slope);
    const GroundGravity gravity = scene.ground_gravity();
    const double omega2 = square(state.omega);
    const double lever = rolling_lever(scene, at, state.omega);
    const double pull = rolling.acceleration(at, state.omega, lever);
    const ContactForce terms{scene.mass * (gravity.into + std::abs(at.ddh) * omega2),
                             scene.mass * (std::abs(gravity.along) + std::abs(at.dh) * omega2)};
    const double rounding =
        law_rounding * (law_size(force, scene.friction) + law_size(terms, scene.friction));
    for (double turn = least_turn; turn <= most_turn; turn *= 16) {
        const bool turns_back = pull * state.omega <= 0 && omega2 < 2 * std::abs(pull) * turn;
        if (turns_back && state.omega != 0 && lever != 0) return false;  // it turns back first
        const double heading = side_of(turns_back ? pull : state.omega);
        const Geometry later = geometry(scene.axes(), state.theta + heading * turn);
        const double mean_pull = 0.5 * (pull + rolling.acceleration(later, 0.0, lever));
        const double later_omega2 = (turns_back ? 0.0 : omega2) + 2 * mean_pull * heading * turn;
        if (!(later_omega2 > 0)) return false;  // it turns back earlier; the margin hardly changes
        const ContactForce next = rolling.force(scene.mass, later, std::sqrt(later_omega2), lever);
        const double side = side_of(next.friction);  // at the limit, also sign(F) unless F = 0
        const double now = law_margin(force, scene.friction, side);
        const double change = law_margin(next, scene.friction, side) - now;
        if (std::abs(now) > rounding + std::abs(change) / turn * blur) return false;
        if (std::abs(change) > rounding) return change < 0;
    }
    return false;
}

// The continuation of a state. For a weightless body, `state` and `at` may have the angle of an
// instant later, but `slip` is the current slip.
Continuation continuation_at(const Scene& scene, const State& state, const Geometry& at,
                             double slip, bool may_roll, double blur) {
    if (scene.friction == 0) {
        const bool stays = slip == 0 && scene.slope == 0 && rests(scene, state, at);
        return stays ? Continuation{Mode::rest} : slide_or_leave(scene, at, state.omega, 0.0);
    }
    if (slip != 0) return slide_or_leave(scene, at, state.omega, side_of(slip), true);
    if (rests(scene, state, at)) return {Mode::rest};
    const ContactForce force = rolling_force(scene, at, state.omega);
    const bool held = law_margin(force, scene.friction) >= 0 || at_the_limit(force, scene.friction);
    if (may_roll && held && state.omega == 0 && scene.rolling_resistance > 0 &&
        is_held(scene, at)) {
        return {Mode::rest};  // at the limit of friction, which does not depend on the couple
    }
    const bool lasts = blur == 0 || !breaks_away(scene, state, at, force, blur);
    if (may_roll && force.normal > 0 && held && lasts) {
        Continuation next{Mode::rolling};
        next.may_fly = free_acceleration(at, scene.ground_gravity().into, state.omega) < 0;
        return next;
    }
    return starting_to_slide(scene, at, state, force);
}

}  // namespace

Continuation continuation(const Scene& scene, const State& state, bool may_roll, double blur) {
    const Geometry at = geometry(scene.axes(), state.theta);
    const double slip = slip_velocity(state, at);
    if (blur > 0 && has_jammed(scene, state, at, slip, blur)) {
        Continuation next{Mode::sliding, side_of(slip), Painleve::no_motion};
        next.has_jammed = true;
        return next;
    }
    const bool weightless = is_weightless(at, scene.ground_gravity().into, state.omega, blur);
    if (!weightless) return continuation_at(scene, state, at, slip, may_roll, blur);
    // A weightless body flies on its way up to the tip: c falls there, since h'' is least at the
    // tip. On a slope it may still roll, with N/m = h h' (g sin(alpha) - h' omega^2)/D.
    if (at.dh * state.omega > 0 && !is_equilibrium(at)) {
        const Continuation now = continuation_at(scene, state, at, slip, may_roll, blur);
        return scene.slope != 0 && now.mode == Mode::rolling ? now : Continuation{Mode::flight};
    }
    State later = state;
    later.theta += std::copysign(std::max(turn_of_grazing, 2 * blur), state.omega);
    Continuation next =
        continuation_at(scene, later, geometry(scene.axes(), later.theta), slip, may_roll, blur);
    const bool needs_force = next.mode == Mode::rolling && scene.slope != 0;
    next.grazes = std::isinf(scene.friction) && !needs_force;
    return next;
}

State with_angle(const Scene& scene, State state, const Axes& new_axes, double theta) {
    const Geometry before = geometry(scene.axes(), state.theta);
    const Geometry after = geometry(new_axes, theta);
    // Preserves the offset of a value from that of a body in contact without slip, unless the
    // offset exceeds 16 times the change due to rounding.
    const auto kept = [](double value, double was, double is) {
        return std::abs(value - was) <= 16 * std::abs(is - was) ? is + (value - was) : value;
    };
    const double omega = state.omega;
    // In the air and without friction only gravity changes x_dot. A body that is just leaving the
    // ground because the gap accelerates is not yet in the air.
    const bool touches = state.z == before.h && state.z_dot == before.dh * omega;
    const bool by_contact = scene.friction != 0 && (state.mode != Mode::flight || touches);
    state.theta = theta;
    state.z = kept(state.z, before.h, after.h);
    state.z_dot = kept(state.z_dot, before.dh * omega, after.dh * omega);
    if (by_contact) state.x_dot = kept(state.x_dot, before.h * omega, after.h * omega);
    return state;
}

Continuation first_continuation(const Scene& scene, const State& start, bool may_roll) {
    if (start.mode == Mode::flight) return {Mode::flight};
    const Units units = natural_units(scene.body(), scene.mass);
    Scene seen = in_units(scene, units);
    const QuarterView angle = quarter_view({resolved(start.theta), 0.0});
    const Axes axes = is_odd(angle.quarters) ? Axes{seen.b, seen.a} : seen.axes();
    const State state = with_angle(seen, in_units(start, units), axes, angle.rest.high);
    seen.a = axes.a;
    seen.b = axes.b;
    return continuation(seen, state, may_roll, angle_roundings(start.theta));
}

}  // namespace rolling_ellipse
