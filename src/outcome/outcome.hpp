// Outcomes: the first event after a blow or during rolling. Also the blow or the friction that
// yields a given outcome, and the thresholds between outcomes on level ground.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

enum class Outcome : std::int8_t {
    rests,
    rocks,          // the body turns back before anything else happens
    rolls_over,     // the body passes the tip before anything else happens
    slips,          // the contact slides
    loses_contact,  // the body leaves the ground, or is in the air
    jams,           // the contact jams; never follows rolling, see outcome/outcome.cpp
    edge,           // rounding hides which of two outcomes occurs
};

template <>
inline constexpr std::array names<Outcome>{"RESTS",         "ROCKS", "ROLLS_OVER", "SLIPS",
                                           "LOSES_CONTACT", "JAMS",  "EDGE"};

// The outcome for a body that rolls or rests on level ground, given its angle and angular velocity,
// from the signs of polynomials alone.
Outcome classify(const Body& body, double friction, double theta, double omega);

// The first event after the blow of a scene. On level ground, no integration is needed. On a slope,
// the rolling motion is followed until the body turns back, passes the tip (a circle: rolls half a
// turn) or no longer rolls; `edge` if none of this happens for a long time.
Outcome outcome(const Scene& scene, const Checkpoint& checkpoint);

// What the body of a scene does when its rolling ends at a time [s]: it slips or leaves the ground.
Outcome after_rolling(const Scene& scene, double time);

// The downward impulse at a horizontal distance from the centre that gives the body the angular
// velocity omega, if the contact sticks: physics (38, 40). Negative if a pull is needed; infinite
// if the lever is so small that no valid impulse suffices.
double press_to(const Scene& scene, double distance, double omega);

// The angular velocity that just carries a body rolling on level ground from the angle of the scene
// to the tip: physics (26).
double speed_to_the_tip(const Scene& scene);

// The least friction coefficient with which neither the blow nor the rolling after it ever causes
// slip, regardless of the friction of the scene; infinite if no finite coefficient suffices.
double required_friction(const Scene& scene);

// The least friction coefficient with which the body can lie still on the slope at some angle;
// infinite if the slope is too steep for any equilibrium.
double friction_to_rest(const Scene& scene);

// Speeds |omega| when passing the flat position [rad/s]; the upper one may be infinite.
struct SpeedRange {
    double lower;
    double upper;
};

// The speeds and friction coefficients at which the kind of motion on level ground changes. Speeds
// are |omega| when passing the flat position [rad/s]; angles are theta in [0, pi/2]. A speed or
// friction is infinite, and its angle absent, if the change does not occur.
struct Thresholds {
    double roll_over_speed;                // above it, the body turns over
    double contact_loss_speed = infinity;  // above it, rolling needs N < 0 somewhere
    std::optional<double> contact_loss_angle;
    // Ranges of speeds in which rolling somewhere needs more friction than available: one or two,
    // or none for a circle with friction; see outcome/onset.hpp. The last range has no upper end.
    std::vector<SpeedRange> slip_windows;
    std::optional<double> slip_angle;     // angle at which rolling at slip_speed() first slips
    double friction_to_roll_over;         // max |F|/N of rolling at the roll-over speed
    double painleve_friction = infinity;  // least mu for which sliding may jam
    std::optional<double> painleve_angle;
    double rocking_rate;  // angular frequency of small rocking [rad/s]
    double tip_rate;      // growth rate of the fall from the tip [1/s]

    // The least speed at which rolling needs more friction than available.
    double slip_speed() const {
        return slip_windows.empty() ? infinity : slip_windows.front().lower;
    }
};

Thresholds thresholds(const Body& body, double friction);

// The roll-over speed alone, physics (44), which needs no search.
double roll_over_speed(const Body& body);

struct LiftOff {
    double speed = infinity;  // the least speed with which the body leaves the ground
    std::vector<SpeedRange> jam_speeds;
};

// Lift-off of a body between its first slip and the tip. At speeds below `slip_speed` the body does
// not slip. Above the Painleve friction, it may jam instead of leaving the ground in some ranges of
// speed. A scan finds these ranges, and bisection refines them to the last bit.
LiftOff lift_off(const Body& body, double friction, double slip_speed, double painleve_friction,
                 const Checkpoint& checkpoint);

}  // namespace rolling_ellipse
