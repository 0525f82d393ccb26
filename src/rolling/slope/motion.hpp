// Rolling on a slope as power series in time, each about a place of the motion. A series passes a
// turning point as any other place; the next series begins where the last one has lost its digits.
#pragma once

#include <cmath>
#include <optional>

#include "numerics/numbers.hpp"
#include "numerics/polynomial.hpp"
#include "numerics/series.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// The equilibria of a body on a slope that falls to growing angles, h' = h tan(slope), physics
// (62): stable next to the flat position, unstable next to the tip.
struct Equilibria {
    double lying;    // angle from the flat position, 0 or more
    double upright;  // angle from the tip, 0 or less
};

// The equilibria, empty where the slope is too steep. `incline` is the tangent of the slope.
std::optional<Equilibria> equilibria(const Axes& lying, double incline);

// Body and ground in units of their own, powers of two. The slope falls to the side of growing
// angles; a slope that falls to the other side is seen from behind.
struct SlopeBody {
    double length;  // unit of length [m]
    double time;    // unit of time [s]
    double side;    // +1, or -1 if the slope is seen from behind
    double long_axis;
    double short_axis;
    double short_axis2;
    double long_axis2;
    double c2;
    double d0;  // D h^2 = d0 + d1 sin^2 phi, physics (28), phi the angle from the flat position
    double d1;
    double gyration2;
    GroundGravity gravity;  // along > 0: the slope falls to growing angles
    std::optional<Equilibria> equilibria;
    double pull;          // gravity times c2, the factor of physics (62)
    double slowest;       // rate at which gravity moves a body that starts at rest
    double quarter_path;  // path of the centre in a quarter turn
    double gain;          // gain of W = D omega^2/2 in half a turn downhill, physics (58)

    Axes lying() const { return {long_axis, short_axis}; }
};

SlopeBody slope_body(const Body& body, double slope);

// A place of the motion, by its angle from a flat position (even quarters) or tip (odd quarters).
struct SlopePlace {
    DoubleDouble time;
    double quarters;
    DoubleDouble angle;  // angle beyond the quarters
    double omega;
    DoubleDouble path;  // path of the centre since the start
};

Geometry geometry(const SlopeBody& body, double quarters, double angle);
inline Geometry geometry(const SlopeBody& body, const SlopePlace& at) {
    return geometry(body, at.quarters, double(at.angle));
}

// Height of the centre at `from` minus its height at `to`, as a product: the difference of two
// heights of a nearly round body would be a rounding.
Tracked fall(const SlopeBody& body, const Geometry& from, const Geometry& to);

// A place from which physics (58) has the energy W = D omega^2/2 at other places.
struct Datum {
    double energy;  // W there
    Geometry at;
    double path = 0.0;  // path to it, from the start of a motion or ahead from that of a run
};

// The start of a motion as a datum.
Datum datum_of(const SlopeBody& body, const SlopePlace& start);

// The energy W at a place of a motion.
Tracked energy_at(const SlopeBody& body, const Datum& start, const SlopePlace& at,
                  const Geometry& here);

// The size of omega where the energy is W.
inline double omega_at(const SlopeBody& body, double energy, const Geometry& here) {
    return std::sqrt(2 * energy / inertia_about_contact(body.gyration2, here));
}

struct SlopeSeries {
    LongSeries angle;
    LongSeries omega;
    LongSeries path;
    LongSeries height;
};

// A stretch of the motion as power series in time.
struct SlopePiece {
    SlopePlace from;
    double unit;   // unit of time of the series
    double lasts;  // duration in units of the body
    SlopeSeries series;

    double end() const { return double(from.time + lasts); }
};

SlopePiece piece_from(const SlopeBody& body, const SlopePlace& from, const Geometry& at);
inline SlopePiece piece_from(const SlopeBody& body, const SlopePlace& from) {
    return piece_from(body, from, geometry(body, from));
}

// The place at a time since the start of the piece.
SlopePlace place_in(const SlopePiece& piece, double since);

// Time of turning back in the piece, and of passing the tip before that, both since the start of
// the motion; infinite if there is none. At the start of a piece neither of them counts.
DoubleDouble time_of_turning(const SlopePiece& piece);
double time_of_tip(const SlopePiece& piece);

// The place at the end of a piece, its omega from the energy where that is more accurate.
SlopePlace place_after(const SlopeBody& body, const Datum& start, const SlopePiece& piece);

// The angular acceleration at a place with this angular velocity.
double acceleration_at(const SlopeBody& body, const Geometry& at, double omega);

// The force of the ground on a body of unit mass, in units of the body, along x as seen with the
// slope falling to growing angles.
ContactForce contact_force(const SlopeBody& body, const SlopePlace& at);

}  // namespace rolling_ellipse
