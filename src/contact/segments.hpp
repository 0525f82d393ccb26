// A motion as a list of segments, each with its law, and the events that join them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "contact/flight.hpp"
#include "contact/slide.hpp"
#include "multipliers/steps.hpp"
#include "rolling/level/kernel.hpp"
#include "rolling/slope/flow.hpp"
#include "rolling/stepped/steps.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse {

enum class EventKind : std::int8_t { slip, stick, reverse, lift_off, impact, rest, jam, blow };

template <>
inline constexpr std::array names<EventKind>{"SLIP",   "STICK", "REVERSE", "LIFT_OFF",
                                             "IMPACT", "REST",  "JAM",     "BLOW"};

struct Event {
    double t;
    EventKind kind;
    State before;
    InitialState after;  // also the impulse of the ground at an impact or a blow
};

// A body whose state does not change: it is at rest, or it is stuck in a state from which no
// motion, or more than one motion, obeys the laws.
using Standing = ContactSample;

// A law of several kB, stored behind a pointer so that segments stay small.
template <class Law>
using Apart = std::shared_ptr<const Law>;

// A part of a motion, from the time `begin` up to the next segment, and the law that it follows.
struct Segment {
    double begin;
    std::variant<Apart<RollingFlow>, Apart<SlopeFlow>, SteppedRolling, SteppedMultipliers, Slide,
                 Flight, Settling, Standing>
        law;
    DoubleDouble turned{};        // angle to add to the angles of the law
    bool axes_exchanged = false;  // whether a and b are exchanged in the law
};

struct Motion {
    Units units;  // units of scene and segments; events are in SI units
    Scene scene;  // body and ground
    std::vector<Segment> segments;
    std::vector<Event> events;
    std::vector<double> turns;  // times [s] at which the couple of rolling resistance reverses
    bool rests = false;         // true if the body is at rest although the law is one of rolling
};

// The law of a segment, whether stored in the segment itself or behind a pointer (Apart).
template <class Law>
const Law& itself(const Law& law) {
    return law;
}

template <class Law>
const Law& itself(const Apart<Law>& law) {
    return *law;
}

// The motion of a body that rolls, slides, flies and rests in separate segments, joined by events
// such as impacts (contact.cpp).
Integration<Motion> integrate_contact(const Scene& scene, const InitialState& start,
                                      const Settings& settings, double t_end,
                                      const Checkpoint& checkpoint);

// The state of a segment with its total angle, rounded to a double. On the ground, h, h' omega and
// (without slip) h omega are computed from this double. `seen` has the axes of the segment.
State with_whole_angle(const Scene& seen, State state, const DoubleDouble& turned,
                       const Scene& scene);

// A motion in SI units with a single segment of this law.
Motion single(const Scene& scene, decltype(Segment::law) law);

// Samples a motion. The times may be passed in several calls. A table for exact rolling is built
// once if the `expected` total number of times justifies it. A sample is a FlowSample (theta,
// omega, x), a ContactSample (state and force) or a CoordinateState, in SI units; every segment
// provides all three. A sample at the time of an event is the state just after the event. A motion
// without segments has no samples.
class Sampler {
  public:
    Sampler(const Motion& motion, std::size_t expected);

    template <class Sample>
    void operator()(const double* times, std::size_t n, Sample* samples) const;

    // Writes theta, omega and x of n samples as columns.
    void operator()(const double* times, std::size_t n, const FlowColumns& out) const;

  private:
    const Motion& motion_;
    std::optional<FlowSampler> flow_;  // set for one SI segment of exact rolling on level ground
};

// The times at which the steps of an integrated motion start and end; empty for all other motions.
std::vector<double> knot_times(const Motion& motion);

}  // namespace rolling_ellipse
