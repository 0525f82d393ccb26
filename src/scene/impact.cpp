#include "scene/impact.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

// The velocity of the material contact point, v along the ground and u away from it, physics (12),
// and the Delassus matrix, which maps an impulse at the contact to the change of that velocity,
// physics (39). See W. J. Stronge, Impact Mechanics (2000), ch. 3.
struct Contact {
    double v;
    double u;
    double u_without_slip;  // u - v gtn/gtt: u after a tangential impulse that stops v
    double gtt;
    double gtn;
    double gnn;
    double determinant;  // gtt gnn - gtn^2 = (1/m) (1/m + (h^2 + h'^2)/I)
};

// Two formulas give u_without_slip. The first, (z_dot (k^2 + h^2) - x_dot h h' - k^2 h' omega)/(k^2
// + h^2), is more accurate for a body of small inertia that turns fast; the second, u - v gtn/gtt,
// for a body that hardly moves into the ground.
Contact contact(const Scene& scene, const Geometry& at, const State& state, double gap_rate,
                const LowParts& low = {}) {
    const double inverse_mass = 1 / scene.mass;
    const double inverse_inertia = 1 / scene.inertia;
    Contact c{slip_velocity(state, at) + (low.x_dot - at.h * low.omega),
              gap_rate,
              0.0,
              inverse_mass + at.h * at.h * inverse_inertia,
              at.h * at.dh * inverse_inertia,
              inverse_mass + at.dh * at.dh * inverse_inertia,
              inverse_mass * (inverse_mass + (at.h * at.h + at.dh * at.dh) * inverse_inertia)};
    const double k2 = scene.inertia / scene.mass;
    const double by_slip = c.v * (c.gtn / c.gtt);
    const double x_share = at.h * at.dh / (k2 + at.h * at.h);
    const double by_x = state.x_dot * x_share;
    const double by_omega = k2 * at.dh / (k2 + at.h * at.h) * state.omega;
    const bool by_velocities = std::abs(state.z_dot) + std::abs(by_x) + std::abs(by_omega) <
                               std::abs(c.u) + std::abs(by_slip);
    c.u_without_slip = by_velocities ? state.z_dot - by_x - by_omega : c.u - by_slip;
    return c;
}

struct Reaction {
    double tangential = 0.0;
    double normal = 0.0;
    double rebound = 0.0;  // u after the collision
    bool sticks = false;   // whether the collision ends with v = 0
};

// Infinite friction, physics (42): the limit of `coulomb_friction`, without a product infinity * 0.
Reaction unlimited_friction(const Contact& c, double restitution, Restitution law) {
    const double u_without_slip = c.u_without_slip;
    const double rebound = -restitution * c.u;
    if (law == Restitution::newton && u_without_slip <= rebound) {
        const double normal = (rebound - u_without_slip) * c.gtt / c.determinant;
        return {-(c.v + c.gtn * normal) / c.gtt, normal, rebound, true};
    }
    if (u_without_slip <= 0) {
        // Solves the full 2 x 2 system for v = 0 and u = -e u_without_slip.
        const double normal = -(1 + restitution) * u_without_slip * c.gtt / c.determinant;
        return {-(c.v + c.gtn * normal) / c.gtt, normal, -restitution * u_without_slip, true};
    }
    if (u_without_slip <= rebound) return {-c.v / c.gtt, 0.0, u_without_slip, true};
    return {(rebound - c.u) / c.gtn, 0.0, rebound, false};  // friction alone stops the approach
}

// The impulse path of Coulomb friction, physics (41), with the normal impulse p as its parameter.
// Both u and v are linear in p while the contact slips and while it sticks. Compression ends at u =
// 0; the law of restitution decides where restitution ends.
class ImpulsePath {
  public:
    ImpulsePath(const Contact& c, double restitution, Restitution law)
        : u_(c.u), restitution_(restitution), rebound_(-restitution * c.u), law_(law) {}

    // Follows the path with du/dp = `du` and a tangential impulse of `tangential` per unit of
    // normal impulse, for a normal impulse of at most `most`. Returns false if restitution ends
    // earlier.
    bool follow(double du, double tangential, double most) {
        double left = most;
        if (u_ < 0) {
            const double p = std::fmin(du > 0 ? -u_ / du : infinity, left);
            work_ -= square(restitution_) * p * (u_ + 0.5 * du * p);
            const bool compressed = p < left || u_ + du * p >= 0;
            advance(p, compressed ? 0.0 : u_ + du * p, tangential);
            left -= p;
            if (!compressed) return true;
            last_normal_ = (1 + restitution_) * normal_;
        }
        const auto [p, end] = to_end(du);
        if (p < left) {
            advance(p, end, tangential);
            return false;
        }
        work_ -= left * (u_ + 0.5 * du * left);
        advance(left, u_ + du * left, tangential);
        return true;
    }

    // Called when the slip has stopped: u is then u_without_slip plus the effect of the normal
    // impulse.
    void stop_slip(const Contact& c) { u_ = c.u_without_slip + normal_ * (c.determinant / c.gtt); }

    Reaction result(bool sticks) const { return {tangential_, normal_, u_, sticks}; }

  private:
    // The normal impulse that remains until restitution ends, and u at that moment.
    struct End {
        double p;
        double u;
    };
    End to_end(double du) const {
        if (law_ == Restitution::newton) return {(rebound_ - u_) / du, rebound_};
        if (law_ == Restitution::poisson) {
            const double p = last_normal_ - normal_;
            return {p, u_ + du * p};
        }
        // The remaining work is u p + du p^2/2: physics (56).
        const double end = std::sqrt(u_ * u_ + 2 * du * work_);
        return {work_ == 0 ? 0.0 : 2 * work_ / (u_ + end), end};
    }

    void advance(double p, double u, double tangential) {
        normal_ += p;
        tangential_ += tangential * p;
        u_ = u;
    }

    double u_;
    double restitution_;
    double rebound_;  // final u under Newton's law
    Restitution law_;
    double work_ = 0.0;         // work left for restitution under Stronge's law
    double last_normal_ = 0.0;  // final normal impulse under Poisson's law
    double normal_ = 0.0;
    double tangential_ = 0.0;
};

Reaction coulomb_friction(const Contact& c, double friction, double restitution, Restitution law) {
    ImpulsePath path(c, restitution, law);
    if (c.v != 0) {
        const double side = std::copysign(1.0, c.v);
        const double v_gain = c.gtn - friction * side * c.gtt;
        const double to_stick = side * v_gain < 0 ? -c.v / v_gain : infinity;
        if (!path.follow(c.gnn - friction * side * c.gtn, -friction * side, to_stick)) {
            return path.result(false);
        }
        path.stop_slip(c);
    }
    const bool sticks = std::abs(c.gtn) <= friction * c.gtt;
    if (sticks) {
        path.follow(c.determinant / c.gtt, -c.gtn / c.gtt, infinity);
    } else {  // slip starts (again), driven by the normal impulse
        const double side = std::copysign(1.0, c.gtn);
        path.follow(c.gnn - friction * side * c.gtn, -friction * side, infinity);
    }
    return path.result(sticks);
}

// Adds a change to a number that is stored as a high and a low part.
void add(double change, double& number, double& low) {
    const DoubleDouble sum = DoubleDouble{number, low} + change;
    number = sum.high;
    low = sum.low;
}

// Applies the reaction so that the gap rate is exactly the rebound and, if the contact sticks, v is
// exactly 0. The reaction preserves k^2 omega + h x_dot + h' z_dot, the angular momentum per mass
// about the contact. If the contact sticks, omega follows from x_dot = h omega and z_dot = h' omega
// + rebound, physics (40), or, if omega changes little, from v and u before the collision. If the
// contact keeps slipping, the impulse gives x_dot and omega. If most of omega would cancel, it can
// be more accurate to compute omega from the angular momentum about the point at the height of the
// centre on the line of action of the impulse. If h' omega + rebound would cancel, the impulse
// gives z_dot.
void apply(const Scene& scene, const Geometry& at, const Contact& c, const Reaction& reaction,
           State& state, LowParts& low) {
    const double k2 = scene.inertia / scene.mass;
    const double pull = reaction.tangential / scene.mass;
    const double kick = reaction.normal / scene.mass;
    const double pushed = state.z_dot + kick;
    const double largest = 2 * (std::abs(state.z_dot) + kick);
    const auto set_omega = [&](double omega) {
        state.omega = zero_if_negligible(omega);
        low.omega = 0.0;
    };
    if (reaction.sticks) {
        const double inertia = inertia_about_contact(k2, at);
        const double gained = (at.h * c.v + at.dh * (c.u - reaction.rebound)) / inertia;
        if (std::abs(gained) < 0.5 * std::abs(state.omega)) {
            add(gained, state.omega, low.omega);
        } else {
            set_omega(
                (k2 * state.omega + at.h * state.x_dot + at.dh * (state.z_dot - reaction.rebound)) /
                inertia);
        }
        const DoubleDouble x_dot = two_product(at.h, state.omega);
        state.x_dot = x_dot.high;
        low.x_dot = x_dot.low + at.h * low.omega;
    } else {
        const double lever = at.dh + at.h * (pull / kick);
        const double turned = (at.h * pull + at.dh * kick) / k2;
        const double about = k2 + at.dh * lever;
        const double terms = k2 * std::abs(state.omega) +
                             std::abs(lever) * (std::abs(state.z_dot) + reaction.rebound);
        if (std::abs(turned) < 0.5 * std::abs(state.omega)) {
            add(-turned, state.omega, low.omega);
        } else {
            set_omega(terms < std::abs(about) * (std::abs(state.omega) + std::abs(turned))
                          ? (k2 * state.omega + lever * (state.z_dot - reaction.rebound)) / about
                          : state.omega - turned);
        }
        add(pull, state.x_dot, low.x_dot);
    }
    const double turning = at.dh * state.omega;
    state.z_dot = std::abs(turning) > largest ? pushed : turning + reaction.rebound;
}

Reaction reaction_to(const Scene& scene, const Contact& c, double restitution, Restitution law) {
    return std::isinf(scene.friction) ? unlimited_friction(c, restitution, law)
                                      : coulomb_friction(c, scene.friction, restitution, law);
}

bool is_struck(const Scene& scene) {
    return scene.impulse && (scene.impulse->jx != 0 || scene.impulse->jz != 0);
}

// Applies the impulse to a free body, physics (38). Returns the rate of the gap, which the new
// velocities would give less accurately.
double strike(const Scene& scene, const Impulse& j, const Geometry& at, State& state) {
    const double lifted = j.jz / scene.mass;
    const double spun = (j.jx * j.dz - j.jz * j.dx) / scene.inertia;
    const double rate = gap_rate(state, at) + (lifted - at.dh * spun);
    state.x_dot += j.jx / scene.mass;
    state.z_dot += lifted;
    state.omega += spun;
    return rate;
}

}  // namespace

InitialState initial_state(const Scene& scene) {
    const Geometry at = geometry(scene.axes(), scene.theta);
    InitialState result{state_before_impulse(scene, at), 0.0, 0.0, scene.omega};
    State& state = result.state;
    result.touching = state.z == at.h;
    const double rate =
        scene.impulse ? strike(scene, *scene.impulse, at, state) : gap_rate(state, at);
    if (scene.impulse) result.free_omega = state.omega;
    const bool slip_removed = state.mode == Mode::sliding && std::isinf(scene.friction);
    if (!result.touching || !(is_struck(scene) || slip_removed)) {
        if (state.mode == Mode::flight) result.gap_rate = rate;
        return result;
    }

    Contact c = contact(scene, at, state, rate);
    // A negligible angle counts as 0: a slide from it would end at a time indistinguishable from 0.
    if (slip_removed && zero_if_negligible(state.theta) == 0) {
        c.gtn = 0.0;
        c.u_without_slip = c.u;
    }
    if (c.u > 0) {
        state.mode = Mode::flight;
        result.gap_rate = rate;
        return result;
    }
    const Reaction reaction = reaction_to(scene, c, 0.0, Restitution::stronge);
    result.reaction_x = reaction.tangential;
    result.reaction_z = reaction.normal;
    const State free = state;
    LowParts low;
    apply(scene, at, c, reaction, state, low);
    result.gap_rate = reaction.rebound;
    if (!is_struck(scene) && reaction.sticks) {
        result.slip_removed = c.v;
        result.energy_lost = energy_lost(scene, free, state);
    }
    state.mode = reaction.sticks ? Mode::rolling : Mode::sliding;
    const bool stands = state.mode == Mode::rolling && state.omega == 0;
    if (stands && is_held(scene, at)) state.mode = Mode::rest;
    return result;
}

double energy_after_impulse(const Scene& scene, const Geometry& at) {
    State state = state_before_impulse(scene, at);
    strike(scene, *scene.impulse, at, state);
    const double k2 = scene.inertia / scene.mass;
    return 0.5 * (square(state.x_dot) + square(state.z_dot) + k2 * square(state.omega)) /
           (scene.gravity * std::max(scene.a, scene.b));
}

// With s = sign(v), the slip stops before the compression ends if |v| (Gnn - mu s Gtn) <= |u| (mu
// Gtt - s Gtn), and does not start again if |Gtn| <= mu Gtt, physics (41).
double sticking_friction(const Scene& scene) {
    const Geometry at = geometry(scene.axes(), scene.theta);
    State state = state_before_impulse(scene, at);
    if (state.z != at.h) return infinity;
    if (!is_struck(scene)) return rolls(state) ? 0.0 : infinity;
    const double rate = strike(scene, *scene.impulse, at, state);
    const Contact c = contact(scene, at, state, rate);
    if (c.u > 0) return infinity;
    if (c.u == 0) return c.v == 0 ? 0.0 : infinity;  // no normal force, hence no friction
    const double to_stay = std::abs(c.gtn) / c.gtt;
    const double towards = c.v == 0 ? 0.0 : std::copysign(c.gtn, c.gtn * c.v);  // s Gtn
    const double normal = std::abs(c.u) * c.gtt + std::abs(c.v) * towards;
    const double tangential = std::abs(c.v) * c.gnn + std::abs(c.u) * towards;
    if (normal <= 0) return infinity;
    return std::fmax(c.v == 0 ? 0.0 : tangential / normal, to_stay);
}

double energy_lost(const Scene& scene, const State& before, const State& after) {
    const auto of = [](double was, double is) { return 0.5 * (was - is) * (was + is); };
    const double by_moving = of(before.x_dot, after.x_dot) + of(before.z_dot, after.z_dot);
    const double by_turning = of(before.omega, after.omega);
    return std::fmax(scene.mass * by_moving + scene.inertia * by_turning, 0.0);
}

double gap_rate(const State& state, const Geometry& at) {
    return state.z_dot - at.dh * state.omega;
}

Collision collision(const Scene& scene, const Geometry& at, const State& before, double gap_rate,
                    Restitution law, const LowParts& low) {
    const Contact c = contact(scene, at, before, gap_rate, low);
    if (!(c.u < 0)) return {before, low, c.u};
    const Reaction reaction = reaction_to(scene, c, scene.restitution, law);
    Collision found{before, low, reaction.rebound};
    apply(scene, at, c, reaction, found.after, found.low);
    return found;
}

}  // namespace rolling_ellipse
