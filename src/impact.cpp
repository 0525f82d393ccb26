#include "impact.hpp"

#include <cmath>

#include "ellipse.hpp"

namespace rolling_ellipse {
namespace {

// The law approaches its limit for infinite friction like 1/friction: beyond this, within rounding.
constexpr double practically_infinite = 1e20;

// Velocity of the material contact point, physics (12): v along the ground, u away from it; and the
// matrix that takes an impulse there to its change (Delassus), physics (39). W. J. Stronge, Impact
// Mechanics (2000), ch. 3.
struct Contact {
    double v;
    double u;
    double gtt;
    double gtn;
    double gnn;
    double determinant;  // gtt gnn - gtn^2 = (1/m) (1/m + (h^2 + h'^2)/I)
};

Contact contact(const Scene& scene, const Geometry& at, const State& state) {
    const double inverse_mass = 1 / scene.mass;
    const double inverse_inertia = 1 / scene.inertia;
    return {state.x_dot - at.h * state.omega,
            state.z_dot - at.dh * state.omega,
            inverse_mass + at.h * at.h * inverse_inertia,
            at.h * at.dh * inverse_inertia,
            inverse_mass + at.dh * at.dh * inverse_inertia,
            inverse_mass * (inverse_mass + (at.h * at.h + at.dh * at.dh) * inverse_inertia)};
}

struct Reaction {
    double tangential = 0.0;
    double normal = 0.0;
    bool sticks = false;  // ends with v = 0
};

// mu = infinity: the limit of the law below, physics (42) (no product infinity * 0 is ever formed).
Reaction unlimited_friction(const Contact& c) {
    const double u_without_slip = c.u - c.v * c.gtn / c.gtt;
    if (u_without_slip <= 0) {
        // v = 0 and u = 0: the full 2 x 2 system.
        const double normal = -u_without_slip * c.gtt / c.determinant;
        return {-(c.v + c.gtn * normal) / c.gtt, normal, true};
    }
    return {-c.u / c.gtn, 0.0, false};  // friction alone stops the approach
}

// Coulomb friction along the path of the normal impulse, until the approach u < 0 is stopped:
// physics (41).
Reaction coulomb_friction(const Contact& c, double friction) {
    Reaction reaction;
    double u = c.u;
    double v = c.v;
    double side = v > 0 ? 1.0 : -1.0;
    if (v != 0) {
        const double u_gain = c.gnn - friction * side * c.gtn;
        const double v_gain = c.gtn - friction * side * c.gtt;
        const double to_stop = u_gain > 0 ? -u / u_gain : infinity;
        const double to_stick = side * v_gain < 0 ? -v / v_gain : infinity;
        if (to_stop < to_stick) return {-friction * side * to_stop, to_stop, false};
        reaction = {-friction * side * to_stick, to_stick, true};
        u += u_gain * to_stick;
        if (u >= 0) return reaction;
    }
    if (std::abs(c.gtn) <= friction * c.gtt) {
        const double normal = -u * c.gtt / c.determinant;
        reaction.tangential -= c.gtn / c.gtt * normal;
        reaction.normal += normal;
        reaction.sticks = true;
        return reaction;
    }
    side = std::copysign(1.0, c.gtn);  // slip starts (again), driven by the normal impulse
    const double normal = -u / (c.gnn - friction * side * c.gtn);
    reaction.tangential -= friction * side * normal;
    reaction.normal += normal;
    reaction.sticks = false;
    return reaction;
}

// u = 0 afterwards, and v = 0 where it sticks, exactly. The sticking angular velocity is that of
// the angular momentum about the contact, which no reaction changes, physics (40):
// D omega = k^2 omega + h x. + h' z.
void apply(const Scene& scene, const Geometry& at, const Reaction& reaction, State& state) {
    if (reaction.sticks) {
        const double k2 = scene.inertia / scene.mass;
        state.omega = (k2 * state.omega + at.h * state.x_dot + at.dh * state.z_dot) /
                      (k2 + at.h * at.h + at.dh * at.dh);
        state.x_dot = at.h * state.omega;
    } else {
        state.omega -= (at.h * reaction.tangential + at.dh * reaction.normal) / scene.inertia;
        state.x_dot += reaction.tangential / scene.mass;
    }
    state.z_dot = at.dh * state.omega;
}

Mode mode_in_contact(const Scene& scene, const Geometry& at, const State& state, bool sticks) {
    // Gap acceleration of the free body is -c: physics (43).
    const double c = scene.gravity * std::cos(scene.slope) + at.ddh * state.omega * state.omega;
    if (c <= 0) return Mode::flight;
    return sticks ? Mode::rolling : Mode::sliding;
}

}  // namespace

InitialState initial_state(const Scene& scene) {
    InitialState result{state_before_impulse(scene), 0.0, 0.0, scene.omega};
    State& state = result.state;
    const Geometry at = geometry(Axes{scene.a, scene.b}, state.theta);
    const bool touching = state.z == at.h;
    if (scene.impulse) {
        const Impulse& j = *scene.impulse;  // physics (38)
        state.x_dot += j.jx / scene.mass;
        state.z_dot += j.jz / scene.mass;
        state.omega += (j.jx * j.dz - j.jz * j.dx) / scene.inertia;
        result.free_omega = state.omega;
    }
    const bool kicked = scene.impulse && (scene.impulse->jx != 0 || scene.impulse->jz != 0);
    const bool slip_removed = state.mode == Mode::sliding && std::isinf(scene.friction);
    if (!touching || !(kicked || slip_removed)) return result;

    const Contact c = contact(scene, at, state);
    if (c.u > 0) {
        state.mode = Mode::flight;
        return result;
    }
    const Reaction reaction = scene.friction > practically_infinite
                                  ? unlimited_friction(c)
                                  : coulomb_friction(c, scene.friction);
    result.reaction_x = reaction.tangential;
    result.reaction_z = reaction.normal;
    apply(scene, at, reaction, state);
    state.omega = noticeable(state.omega);
    state.mode = mode_in_contact(scene, at, state, reaction.sticks);
    if (state.mode == Mode::rolling && state.omega == 0 && scene.slope == 0 && is_equilibrium(at)) {
        state.mode = Mode::rest;
    }
    return result;
}

}  // namespace rolling_ellipse
