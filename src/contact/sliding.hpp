// Sliding with Coulomb friction to one side: the contact force, its effects, and the motion as
// power series about a state. Also the mode in which a body on the ground continues.
#pragma once

#include <optional>

#include "numerics/series.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// A body whose slip has the sign `side` (0 without friction). Infinite friction is the limit of
// physics (52): no normal force, and friction alone keeps the gap closed.
struct SlidingBody {
    Axes axes;
    double mass;
    double gyration2;
    GroundGravity gravity;
    double side;
    // Shares of the contact force along the normal and along the ground: 1 and -mu side; for
    // infinite friction, 0 and -side.
    double normal_share;
    double friction_share;
    // The lever of the normal force ahead of the contact, physics (63), and whether its couple
    // prevents the sliding body from turning.
    double ahead;
    bool is_held;

    // False for infinite friction, with which the force stays moderate near the tip although B is
    // small there, and for a body that is kept from turning, since its B is constant.
    bool may_jam() const { return normal_share != 0 && !is_held; }

    // The lever arm of the contact force about the centre; a positive arm turns the body backwards.
    double lever(const Geometry& at) const {
        if (is_held) return 0.0;
        return (at.h * friction_share + at.dh * normal_share) + ahead * normal_share;
    }
};

SlidingBody sliding_body(const Scene& scene, const Geometry& at, double omega, double side);

// The free acceleration c into the ground, physics (53), and Painleve's B, the normal acceleration
// per unit of force, physics (49, 50). The force cancels the acceleration -c of the gap.
struct Response {
    double c;
    double b;
};
Response response(const SlidingBody& body, const Geometry& at, double omega);

// u = h^2 and p = h h' from an angle in double-double precision.
struct PreciseHeight2 {
    DoubleDouble u;
    DoubleDouble p;
};
PreciseHeight2 precise_height2(const Axes& axes, const DoubleDouble& angle);

// V = k^2 h^2 B, computed from an angle in double-double precision where its terms all but cancel,
// as they do for a body of small inertia near B = 0. Empty where they do not cancel.
std::optional<double> cancelled_response(const SlidingBody& body, const Geometry& at,
                                         const DoubleDouble& angle);

ContactForce sliding_force(const SlidingBody& body, const Geometry& at, double omega);

// The rate of change of the slip velocity, physics (51).
double slip_rate(const SlidingBody& body, const Geometry& at, double omega);

// The rate at which the contact force changes B by turning the body: the square root of its
// contribution to the second derivative of log B. This is the rate on a clock that slows down as B
// decreases; in real time it is 1/B times as large.
double slowed_response_rate(const SlidingBody& body, const Geometry& at, double c);

// The end of a slide that has reached B = 0 with c > 0, physics (54): in an instant, N = c/B makes
// the slip vanish (`stops`), the rotation (`turns`: the couple of rolling resistance then reverses)
// or c (the body jams). Stores the angular velocity, the slip and the velocity of the centre after
// this instant, and its tiny duration.
struct LastMoment {
    bool stops;
    bool turns;
    double omega;
    double slip;
    double x_dot;
    double lasts;
};
LastMoment last_moment(const SlidingBody& body, double angle, double omega, double slip);

enum class SlideClock { time, slowed };

// The centre of the series: sine and cosine of the angle, and velocities. The response V of a
// slide, or the torque of rolling, is set if it is known more accurately than the sine and cosine
// give it.
struct SlideCentre {
    double sin;
    double cos;
    double omega;
    double slip;
    double x_dot;
    std::optional<double> response;
    std::optional<double> torque;
};

// The series from which samples are computed. Angle, path and time are 0 at the centre.
struct SlideMotion {
    LongSeries angle;
    LongSeries omega;
    LongSeries x_dot;
    LongSeries path;
    LongSeries time;
};

struct SlideSeries {
    SlideMotion motion;
    LongSeries slip;
    LongSeries rolled;    // h omega, the velocity of the centre if it rolled
    LongSeries pressure;  // C = h^3 c, the scaled c
    LongSeries response;  // V = k^2 u B, the scaled B
    LongSeries height2;   // u = h^2
    LongSeries work;      // work of friction on the rotation, per mass
};

// Physics (51, 52) times powers of h, with u = h^2, p = h h' and the shares nu, phi of the contact
// force along the normal and along the ground:
//     L = h (nu (h' + d) + phi h) = nu (p + d h) + phi u     the lever of the force, times h, with
//         the lever d of rolling resistance: physics (65)
//     V = k^2 u B = nu k^2 u + p L               the response to it
//     C = h^3 c = g cos(alpha) u h + (a b - u)(a b + u) omega^2
//     omega' u V = -L C,    friction h V = phi k^2 C
// In the clock dt = u V dtau/(k^2 u0^2), with u0 = u at the centre, which slows down near B = 0
// where N = c/B grows without bound, all of these are polynomials: physics (54).
SlideSeries slide_series(const SlidingBody& body, const SlideCentre& centre, SlideClock clock);

// The number of possible continuations. A slide may have none or two (P. Painleve, C. R.
// Acad. Sci. 121 (1895) 112): pressed against the ground (c > 0) it has none if B <= 0; pulled off
// it (c < 0) it has two if B < 0, flight and a slide with N = c/B > 0.
enum class Painleve { determined, no_motion, two_motions };

// How the motion continues for a body that touches the ground without moving into it.
struct Continuation {
    Mode mode;
    double side = 0.0;  // sign of the slip
    Painleve paradox = Painleve::determined;
    // Set for infinite friction if c = 0 to within rounding: N, and near the tip B, is then mere
    // rounding error. The body moves freely until it has turned far enough for N and B to be
    // resolved.
    bool grazes = false;
    bool may_fly = false;     // the body rolls, but flight would obey the laws as well
    bool has_jammed = false;  // the start is the state in which a slide has jammed
};

inline constexpr double turn_of_grazing = 0x1p-22;  // angle turned in free flight [rad]

// The mode that the forces allow. Without slip, the body rolls if `may_roll` is set and the forces
// allow it; otherwise it starts to slide, or leaves the ground if it is no longer pressed against
// it. On slopes the forces may allow both rolling and flight (c < 0 < N): the body then rolls, just
// as if it had arrived rolling. At a start, c = 0 and |F| = mu N need to hold only to within
// rounding and the effect of an uncertainty `blur` of theta [rad]; the motion just afterwards then
// decides.
Continuation continuation(const Scene& scene, const State& state, bool may_roll = true,
                          double blur = 0.0);

// The state with its angle replaced by `theta`, which describes the same position with new axes, so
// that h and h' change only by rounding. The gap is preserved and, in contact, its rate and the
// slip: a contact remains a contact, and a body without slip remains without slip.
State with_angle(const Scene& scene, State state, const Axes& new_axes, double theta);

// How a body continues from its start, which may be in the air.
Continuation first_continuation(const Scene& scene, const State& start, bool may_roll = true);

}  // namespace rolling_ellipse
