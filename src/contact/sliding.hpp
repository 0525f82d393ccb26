// Sliding with Coulomb friction in one direction: contact force, and what ends it.
#pragma once

#include "scene/scene.hpp"

namespace rolling_ellipse {

// The state of a slide since its start; the angle is counted from a quarter turn.
struct SlideState {
    double angle;
    double omega;
    double slip;
    double x_dot;
    double path;
    double time;
};

// A body that slides to the side of which `side` is the sign (0: without friction there is none).
// With infinite friction the limit holds, physics (52): no normal force, and friction alone keeps
// the gap closed.
struct SlidingBody {
    Axes axes;
    double mass;
    double gyration2;
    GroundGravity gravity;
    double side;
    // Of the contact force along the normal and along the ground: 1 and -mu s, or 0 and -s.
    double normal_share;
    double friction_share;

    // With infinite friction B is small near the tip, and nothing grows there.
    bool may_jam() const { return normal_share != 0; }
};

SlidingBody sliding_body(const Scene& scene, double side);

// The free acceleration c into the ground, physics (53), and B, the normal acceleration that a unit
// of force makes (Painleve), physics (49, 50): the force along its direction cancels the
// acceleration -c of the gap.
struct Response {
    double c;
    double b;
};
Response response(const SlidingBody& body, const Geometry& at, double omega);

ContactForce sliding_force(const SlidingBody& body, const Geometry& at, double omega);

// The rate of the slip velocity, physics (51).
double slip_rate(const SlidingBody& body, const Geometry& at, double omega);

// How fast the force, by the c of the response, makes B change by turning the body, in a time that
// runs by B: so it has a square root in it. In the time itself it is 1/B times as fast.
double slowed_response_rate(const SlidingBody& body, const Geometry& at, double c);

// Where a slide ends that has come to B = 0 with c > 0: in a moment, N = c/B makes either the slip
// or c vanish, physics (54): it stops slipping or jams.
struct LastMoment {
    bool stops;
    SlideState state;
};
LastMoment last_moment(const SlidingBody& body, const SlideState& state);

}  // namespace rolling_ellipse
