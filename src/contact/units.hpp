// Units of a scene's own size. They are powers of two: a number in them keeps its bits, and what is
// computed in them neither depends on the units that the scene came in nor leaves the range of
// doubles.
#pragma once

#include "geometry/constraints.hpp"
#include "rolling/level/flow.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

inline double power(double base, int exponent) {
    double found = 1.0;
    for (int i = 0; i < exponent; ++i) found *= base;
    for (int i = 0; i > exponent; --i) found /= base;
    return found;
}

struct Units {
    double length = 1.0;  // [m]
    double time = 1.0;    // [s]
    double mass = 1.0;    // [kg]

    double speed() const { return length / time; }
    double of(const Unit& unit) const {
        return power(length, unit.length) * power(time, unit.time) * power(mass, unit.mass);
    }
    bool are_si() const { return length == 1 && time == 1 && mass == 1; }
};

// Next to the long semi-axis L, sqrt(L/g) and the mass.
Units natural_units(const Scene& scene);

// All numbers of a scene but those of its impulse.
Scene in_units(const Scene& scene, const Units& units);

State in_units(const State& state, const Units& units);

// Back to SI units.
State in_si(const State& state, const Units& units);
ContactSample in_si(const ContactSample& sample, const Units& units);
FlowSample in_si(const FlowSample& sample, const Units& units);
CoordinateState in_si(const CoordinateState& state, const Units& units);

}  // namespace rolling_ellipse
