// Collisions with the ground: Coulomb friction along the impulse path, energetic restitution (W. J.
// Stronge, Impact Mechanics (2000), ch. 3 to 5). An applied impulse first changes the velocities of
// the free body, which then collides with the ground without restitution.
#pragma once

#include "scene/scene.hpp"

namespace rolling_ellipse {

// Laws of restitution with a coefficient e. Stronge: restitution returns e^2 times the work of
// compression. Poisson: the normal impulse of restitution is e times that of compression (Traite de
// mecanique, 1833). Newton: the gap opens e times as fast as it closed.
enum class Restitution { stronge, poisson, newton };

template <>
inline constexpr std::array names<Restitution>{"STRONGE", "POISSON", "NEWTON"};

// The state just after the applied impulse, or the scene's state if there is no impulse. Its mode
// follows from its velocities; contact/sliding.hpp determines the mode that the forces allow.
struct InitialState {
    State state;
    double reaction_x;  // impulse of the ground [N s]
    double reaction_z;
    double free_omega;          // angular velocity without the ground: the report's eq 48
    double slip_removed = 0.0;  // initial slip that infinite friction stops at once [m/s]
    double energy_lost = 0.0;   // energy lost when this slip stops, or in an impact [J]
    double gap_rate = 0.0;      // rate of the gap, free of cancellation; 0 in contact [m/s]
    bool touching = false;      // whether the body touched the ground before the impulse
};

inline constexpr Field<InitialState> start_fields[] = {
    {"reaction_x", &InitialState::reaction_x, unit::impulse},
    {"reaction_z", &InitialState::reaction_z, unit::impulse},
    {"free_omega", &InitialState::free_omega, unit::angular_velocity},
    {"energy_lost", &InitialState::energy_lost, unit::energy}};

InitialState initial_state(const Scene& scene);

// The kinetic energy after the impulse without a reaction of the ground, which can only lower this
// energy, in units of m g times the long semi-axis.
double energy_after_impulse(const Scene& scene, const Geometry& at);

// The smallest coefficient of friction with which the contact does not slip after the applied
// impulse; infinite if no finite coefficient suffices. The scene's own coefficient is ignored.
// Every larger coefficient leads to the same state.
double sticking_friction(const Scene& scene);

// The kinetic energy [J] lost in a collision; a negative result, due to rounding, is replaced by 0.
double energy_lost(const Scene& scene, const State& before, const State& after);

// The rate of the gap: the velocity of the lowest point away from the ground.
double gap_rate(const State& state, const Geometry& at);

// The low parts of the numbers in a state. Without them, many nearly equal impacts would add up
// nearly equal rounding errors.
struct LowParts {
    double theta = 0.0;
    double omega = 0.0;
    double x = 0.0;
    double x_dot = 0.0;
};

// The state just after the collision of a body that touches the ground, with its mode unchanged,
// and the rate of the gap. The rate of the gap before the collision is a separate argument because,
// after a low hop, it is known more accurately than the velocities.
struct Collision {
    State after;
    LowParts low;
    double rebound;
};
Collision collision(const Scene& scene, const Geometry& at, const State& before, double gap_rate,
                    Restitution law = Restitution::stronge, const LowParts& low = {});

}  // namespace rolling_ellipse
