// The arcs of a contact motion, each with its law, and the events that join them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "contact/flight.hpp"
#include "contact/sliding_steps.hpp"
#include "contact/units.hpp"
#include "rolling/flow_table.hpp"
#include "rolling/steps.hpp"

namespace rolling_ellipse {

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
    Units units;  // of scene and arcs; events are in SI units
    Scene scene;  // body and ground
    std::vector<ContactArc> arcs;
    std::vector<Event> events;
};

// The state and the force at n times, all in SI units; at an event, what holds after it. A motion
// without arcs has none.
void sample(const ContactMotion& motion, const double* times, std::size_t n,
            ContactSample* samples);

}  // namespace rolling_ellipse
