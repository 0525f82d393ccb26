// The arcs of a contact motion, each with its law, and the events that join them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "flight.hpp"
#include "rolling_steps.hpp"
#include "sliding.hpp"

namespace rolling_ellipse {

// Velocity along the ground of the material point at the contact.
double slip_velocity(const State& state, const Geometry& at);

// The same; within 8 ulp of none it is none, as in a scene.
double noticeable_slip(const State& state, const Geometry& at);

// The state of a body that keeps to the ground.
State in_contact(const Geometry& at, double theta, double omega, double x, double slip, Mode mode);

enum class EventKind : std::int8_t { slip, stick, reverse, lift_off, impact, rest, jam };

struct Event {
    double t;
    EventKind kind;
    State before;
    State after;
};

struct ExactRolling {
    Axes axes;
    RollingFlow flow;
};

struct SteppedSliding {
    SlidingEquation equation;
    Axes axes;
    Steps<4> steps;
};

// Bounces that are too small to tell apart, with what they do on average.
struct Settling {
    Axes axes;
    double lasts;
    State start;
    State end;
};

// The instant from which no motion goes on: no force of the ground is right.
struct Jam {
    State state;
};

struct Resting {
    State state;
};

struct ContactArc {
    Mode mode;
    double t0;
    double t1;
    std::variant<ExactRolling, SteppedRolling, SteppedSliding, Flight, Settling, Resting, Jam>
        motion;
};

struct ContactMotion {
    Scene scene;
    std::vector<ContactArc> arcs;
    std::vector<Event> events;
};

struct ContactSample {
    State state;
    ContactForce force;
};

// The state at the time since the start of an arc of sliding.
State state_at(const SteppedSliding& motion, double t);

// The state and the force at n times; at an event, what holds after it.
void sample(const ContactMotion& motion, const double* times, std::size_t n,
            ContactSample* samples);

}  // namespace rolling_ellipse
