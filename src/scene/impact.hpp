// Collisions with the ground: Coulomb friction along the impulse path, energetic restitution (W. J.
// Stronge, Impact Mechanics (2000), ch. 3 to 5). The applied impulse is a collision without
// restitution of a body that the impulse has just moved.
#pragma once

#include "scene/scene.hpp"

namespace rolling_ellipse {

// What the coefficient e of restitution means. Stronge: restitution does e^2 of the work of
// compression. Poisson: it has e times the normal impulse of compression (Traite de mecanique,
// 1833). Newton: the gap opens e times as fast as it closed.
enum class Restitution { stronge, poisson, newton };

// The state just after the applied impulse (or the scene's own state, where there is none). Its
// mode is what its velocities look like; what forces make of it, contact/continuation.hpp says.
struct InitialState {
    State state;
    double reaction_x;  // impulse of the ground [N s]
    double reaction_z;
    double free_omega;          // without the ground's reaction: the report's eq 48
    double slip_removed = 0.0;  // a given one, that infinite friction takes off at once [m/s]
    double energy_lost = 0.0;   // with that slip [J]
    double gap_rate = 0.0;      // by its own digits; 0 in contact [m/s]
    bool touching = false;      // whether the body was on the ground before
};

inline constexpr Field<InitialState> start_fields[] = {
    {"reaction_x", &InitialState::reaction_x, unit::impulse},
    {"reaction_z", &InitialState::reaction_z, unit::impulse},
    {"free_omega", &InitialState::free_omega, unit::angular_velocity},
    {"energy_lost", &InitialState::energy_lost, unit::energy}};

InitialState initial_state(const Scene& scene);

// The kinetic energy, beside m g times the long semi-axis, that the impulse alone makes; the ground
// only takes some off.
double energy_after_impulse(const Scene& scene);

// The least coefficient of friction with which the contact does not slip after the applied impulse,
// whatever the scene's own; infinite where no finite one does that. With any larger one it does not
// either, and the state then is the same.
double sticking_friction(const Scene& scene);

// The kinetic energy [J] that a collision takes; not negative for rounding.
double energy_lost(const Scene& scene, const State& before, const State& after);

// The rate of the gap, which is what the lowest point moves away from the ground with.
double gap_rate(const State& state, const Geometry& at);

// A body that touches the ground, just after the collision, and the rate of its gap; its mode is
// left. The rate before is a number of its own, since a low hop has more digits of it than z_dot.
struct Collision {
    State after;
    double rebound;
};
Collision collision(const Scene& scene, const State& before, double gap_rate,
                    Restitution law = Restitution::stronge);

}  // namespace rolling_ellipse
