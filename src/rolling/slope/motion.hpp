// Rolling on a slope as power series in time, each about a point of the motion. Each series starts
// where the previous one loses accuracy; turning points need no special treatment.
#pragma once

#include <cmath>
#include <optional>

#include "numerics/numbers.hpp"
#include "numerics/polynomial.hpp"
#include "numerics/series.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// The equilibria, where h' = h tan(slope), on a slope that falls in the direction of increasing
// angles: physics (62). The one near the flat position is stable, the one near the tip unstable.
struct Equilibria {
    double lying;    // angle from the flat position, 0 or more
    double upright;  // angle from the tip, 0 or less
};

// The equilibria; empty if the slope is too steep. `incline` is the tangent of the slope.
std::optional<Equilibria> equilibria(const Axes& lying, double incline);

// Body and ground in natural units, powers of two. The slope falls in the direction of increasing
// angles; a slope that falls the other way is viewed from behind.
struct SlopeBody {
    double length;  // unit of length [m]
    double time;    // unit of time [s]
    double side;    // +1, or -1 if the slope is viewed from behind
    double long_axis;
    double short_axis;
    double short_axis2;
    double long_axis2;
    double c2;
    double d0;  // D h^2 = d0 + d1 sin^2 phi, physics (28), phi the angle from the flat position
    double d1;
    double gyration2;
    GroundGravity gravity;  // its component along the ground is positive
    std::optional<Equilibria> equilibria;
    double pull;          // gravity times c2, the factor in physics (62)
    double slowest;       // scale of the angular velocity of a body that starts at rest
    double quarter_path;  // path of the centre in a quarter turn, set by measure_quarter
    double gain;          // gain of W = D omega^2/2 in half a turn downhill, physics (58)

    Axes lying() const { return {long_axis, short_axis}; }
};

SlopeBody slope_body(const Body& body, double slope);

// Computes the path of a quarter turn and the gain, which a body that rocks does not need.
void measure_quarter(SlopeBody& body);

// A point of the motion. Its angle is measured from a flat position (even quarters) or from a tip
// (odd quarters).
struct SlopePlace {
    DoubleDouble time;
    double quarters;
    DoubleDouble angle;
    double omega;
    DoubleDouble path;  // path of the centre from the start
};

Geometry geometry(const SlopeBody& body, double quarters, double angle);
inline Geometry geometry(const SlopeBody& body, const SlopePlace& at) {
    return geometry(body, at.quarters, double(at.angle));
}

// Height of the centre at `from` minus its height at `to`, as a product: for a nearly round body
// the difference of two heights would be mere rounding error.
Tracked fall(const SlopeBody& body, const Geometry& from, const Geometry& to);

// A reference point, from which physics (58) gives the energy W = D omega^2/2 at other points.
struct Datum {
    double energy;  // W at this point
    Geometry at;
    double path = 0.0;  // path to this point from the start of a motion or a run
};

// The start of a motion as a datum.
Datum datum_of(const SlopeBody& body, const SlopePlace& start);

// The energy W at a point of a motion.
Tracked energy_at(const SlopeBody& body, const Datum& start, const SlopePlace& at,
                  const Geometry& here);

// The magnitude of omega where the energy is W.
inline double omega_at(const SlopeBody& body, double energy, const Geometry& here) {
    return std::sqrt(2 * energy / inertia_about_contact(body.gyration2, here));
}

struct SlopeSeries {
    LongSeries angle;
    LongSeries omega;
    LongSeries path;
    LongSeries height;
};

// An interval of the motion as power series in time.
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

// The point at a time after the start of the piece.
SlopePlace place_in(const SlopePiece& piece, double since);

// The time at which the body turns back within the piece, and the first time before that at which
// it passes the tip; infinite if there is none. Both are measured from the start of the motion. The
// start of the piece does not count.
DoubleDouble time_of_turning(const SlopePiece& piece);
double time_of_tip(const SlopePiece& piece);

// The point at the end of a piece, with omega from the energy where that is more accurate.
SlopePlace place_after(const SlopeBody& body, const Datum& start, const SlopePiece& piece);

// The angular acceleration at a position, given the angular velocity.
double acceleration_at(const SlopeBody& body, const Geometry& at, double omega);

// The force of the ground per unit mass, in units of the body; x points down the slope.
ContactForce contact_force(const SlopeBody& body, const SlopePlace& at);

}  // namespace rolling_ellipse
