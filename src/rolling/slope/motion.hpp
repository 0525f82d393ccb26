// Rolling on a slope as power series in time, each about a place of the motion: they pass turning
// points as any other place, and the next one begins where the last has lost its digits.
#pragma once

#include <optional>
#include <vector>

#include "numerics/double_double.hpp"
#include "numerics/polynomial.hpp"
#include "rolling/slope/series.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// The equilibria of a body on a slope that falls to growing angles, h' = h tan(slope), physics
// (62): stable next to the flat position, unstable next to the tip.
struct Equilibria {
    double lying;    // the angle from the flat position, 0 or more
    double upright;  // the angle from the tip, 0 or less
};

// Nothing where the slope is too steep for them. `incline` is its tangent.
std::optional<Equilibria> equilibria(double long_axis, double short_axis, double incline);

// Body and ground in units of their own, powers of two. The slope falls to the side of growing
// angles: one that falls to the other side is looked at from behind.
struct SlopeBody {
    double length;  // units [m], [s]
    double time;
    double side;  // +1, or -1 if seen from behind
    double long_axis;
    double short_axis;
    double c2;
    double gyration2;
    GroundGravity gravity;  // along > 0
    std::optional<Equilibria> equilibria;
    double pull;            // (along^2 + into^2)^(1/2) c2
    SlopeConstants series;  // for a time unit of 1
    double slowest;         // rate of what gravity does from rest
    double quarter_path;    // of the centre, in a quarter turn
    double gain;            // of W = D omega^2/2 in half a turn downhill, physics (58)
};

SlopeBody slope_body(const Body& body, double slope);

// The angle counts from the flat position (even quarters) or tip (odd quarters) nearby.
struct SlopePlace {
    DoubleDouble time;
    double quarters;
    DoubleDouble angle;
    double omega;
    DoubleDouble path;  // of the centre, since the start
};

// The geometry of a place; h'' and the radius of curvature as everywhere.
Geometry geometry(const SlopeBody& body, double quarters, double angle);
inline Geometry geometry(const SlopeBody& body, const SlopePlace& at) {
    return geometry(body, at.quarters, double(at.angle));
}

// The path of the centre from the flat position of quarter 0.
double path_at(const SlopeBody& body, double quarters, double angle);

// How much lower the centre is at one place than at another: as a product, since the difference of
// the heights of what is nearly a circle would be a rounding.
Tracked fall(const SlopeBody& body, const Geometry& from, const Geometry& to);

// The energy W = D omega^2/2 along the motion, from that of its start: physics (58).
struct SlopeEnergy {
    double start;  // W
    Geometry at;
};

SlopeEnergy energy_of(const SlopeBody& body, const SlopePlace& start);

struct SlopePiece {
    SlopePlace from;
    double unit;   // of time, in the series
    double lasts;  // in units of the body
    SlopeSeries series;

    double end() const { return double(from.time + lasts); }
};

SlopePiece piece_from(const SlopeBody& body, const SlopePlace& from);

// At a time since the begin of the piece, as the series has it.
SlopePlace place_in(const SlopePiece& piece, double since);

// The angle over the flat position or tip that the piece begins at, and the angular acceleration.
double angle_in(const SlopePiece& piece, double since);
double acceleration_in(const SlopePiece& piece, double since);

// Times of the motion at which it turns back in the piece, or passes the tip on its way there;
// infinite if it does not. What it begins with does not count.
DoubleDouble time_of_turning(const SlopePiece& piece);
double time_of_tip(const SlopePiece& piece);

// At its end, the angular velocity from the energy where that knows it better.
SlopePlace place_after(const SlopeBody& body, const SlopeEnergy& energy, const SlopePiece& piece);

// W at a place, and the sizes it was made from.
Tracked energy_at(const SlopeBody& body, const SlopeEnergy& energy, const SlopePlace& at,
                  const Geometry& here);

// The force of the ground on a body of unit mass, in units of the body, along x as seen with the
// slope falling to growing angles.
ContactForce contact_force(const SlopeBody& body, const SlopePlace& at);

}  // namespace rolling_ellipse
