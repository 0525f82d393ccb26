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

enum class EventKind : std::int8_t { slip, stick, reverse, lift_off, impact, rest, jam };

template <>
inline constexpr std::array names<EventKind>{"SLIP",   "STICK", "REVERSE", "LIFT_OFF",
                                             "IMPACT", "REST",  "JAM"};

struct Event {
    double t;
    EventKind kind;
    State before;
    State after;
};

// The state just after an event, and the impulse of the ground at an impact.
InitialState start_after(const Scene& scene, const Event& event);

// A body that stays as it is: at rest, or at the instant from which no motion continues, where no
// force of the ground is right.
using Standing = ContactSample;

// A law of some kB behind a pointer: in the list, every segment would take as much memory.
template <class Law>
using Apart = std::shared_ptr<const Law>;

// The law of the motion from a time on, up to the next segment.
struct Segment {
    double begin;
    std::variant<Apart<RollingFlow>, Apart<SlopeFlow>, SteppedRolling, SteppedMultipliers, Slide,
                 Flight, Settling, Standing>
        law;
    DoubleDouble turned{};        // angle to be added to the angles of the law
    bool axes_exchanged = false;  // the law has a and b exchanged (odd quarter turns)
};

struct Motion {
    Units units;  // units of scene and segments; events are in SI units
    Scene scene;  // body and ground
    std::vector<Segment> segments;
    std::vector<Event> events;
    bool rests = false;  // set if the only law is one of rolling, and the body is at rest
};

// The law of a segment, whether it is stored in the segment or behind a pointer (Apart).
template <class Law>
const Law& itself(const Law& law) {
    return law;
}

template <class Law>
const Law& itself(const Apart<Law>& law) {
    return *law;
}

// The motion of a body with everything that its contact does: it rolls, slides, flies, hits the
// ground and comes to rest, each on a segment of its own, joined by events (contact.cpp).
Integration<Motion> integrate_contact(const Scene& scene, const InitialState& start,
                                      const Settings& settings, double t_end,
                                      const Checkpoint& checkpoint);

// The state of a segment with its whole angle, rounded to a double: on the ground h, h' omega and,
// without slip, h omega are those of this double. `seen` has the axes of the segment.
State with_whole_angle(const Scene& seen, State state, const DoubleDouble& turned,
                       const Scene& scene);

// A motion of one segment, with this law, in SI units.
Motion single(const Scene& scene, decltype(Segment::law) law);

// Samples a motion at an expected number of times in all, which may come in parts: a table, if so
// many times are worth one, is made once. A sample is a FlowSample (theta, omega, x), a
// ContactSample (state and force) or a CoordinateState, in SI units; every segment has all three.
// At an event it is the one just after it. A motion without segments has no samples.
class Sampler {
  public:
    Sampler(const Motion& motion, std::size_t expected);

    template <class Sample>
    void operator()(const double* times, std::size_t n, Sample* samples) const;

    // Writes theta, omega and x of n samples as columns.
    void operator()(const double* times, std::size_t n, const FlowColumns& out) const;

  private:
    const Motion& motion_;
    std::optional<FlowSampler> flow_;  // set if the motion is one exact rolling
};

// The times at which the steps of an integrated motion begin and end; empty for all other motions.
std::vector<double> knot_times(const Motion& motion);

}  // namespace rolling_ellipse
