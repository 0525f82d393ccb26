// Exact rolling on level ground: the start of a motion and its state at any time. No time steps are
// taken, so a state costs the same however far it is from the start.
//
// A motion is described by its phase. The templates below are for one body (T = double) or for one
// body in each lane of a Pack.
//
// With L, S the long and short semi-axes, c^2 = L^2 - S^2, phi the angle from the flat position,
// the energy height H = E/(m g) and D = (d0 + d1 sin^2 phi)/h^2, physics (28), the integral of
// physics (27) takes the form of physics (29),
//     dt/dphase = scale sqrt(D (H + h)) / sqrt(cos^2 phase + kappa^2 sin^2 phase),
//     sin phi   = amplitude sin phase,
// for rotation (phase = phi) as well as libration (phase = u, with sin phi = sin phi_max sin u):
//     rotation:  amplitude 1, scale^2 = 1/(2 g (H^2 - S^2)),   kappa^2 = (H^2 - L^2)/(H^2 - S^2)
//     libration: amplitude^2 = (H^2 - S^2)/c^2, scale^2 = 1/(2 g c^2), kappa^2 = (L^2 - H^2)/c^2
// Of all these terms, only H - L loses digits to cancellation.
//
// In the coordinate y no integrand has a peak, physics (61): neither at the flat position of a thin
// body nor at the tip in a motion near the separatrix.
//     tan phase = g sc(w, k),   k' = kappa g,   w = theta_3(q)^2 y,   q = e^(-2 Y),
// where g is the grade of the map, not gravity, and sc = sn/cn is a Jacobi elliptic function with
// the complementary modulus k'. The flat position is at y = 0, the tip or turning point at y = Y,
// and the integrands are symmetric about both. The integrand of the time is singular where tan
// phase is imaginary, with a magnitude between g and 1/kappa. These points lie on the line Im y =
// pi/2 (DLMF 22.4). Near the flat position, y is the coordinate v of physics (31), and so is Y - y
// near the tip.
#pragma once

#include <cmath>
#include <string>

#include "numerics/numbers.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {

// The energy as a height H = E/(m g) [m], and its excess over the height of the centre on the tip
// (H - L, negative in libration) and in the flat position (H - S), computed without subtracting
// heights: physics (26).
struct EnergyHeight {
    double total;
    double over_tip;
    double over_flat;
};

struct RollingStart {
    Body body;
    double theta;
    double omega;
    FlatView view;
    EnergyHeight height;
    bool rests;  // the body stays in equilibrium
};

RollingStart rolling_start(const Body& body, double theta, double omega);

// The constants of the integrand in physics (29).
template <class T>
struct PhaseIntegrand {
    T short_axis;     // S
    T c2;             // L^2 - S^2
    T energy_height;  // H = E/(m g), physics (26)
    T amplitude2;
    T scale2;
    T kappa;
    T d0;
    T d1;
    Mask<T> rotates;
};

// The constants of the coordinate y, physics (61).
template <class T>
struct PhaseMap {
    T quarter;  // Y, the tip or turning point; infinite on the separatrix
    T step;     // step of the trapezoidal rule for a quarter
    T steps;    // steps in a quarter, or from the flat position to the tail
    // Whether the quarter extends beyond its last step. In this tail, dt/dy is constant to within
    // rounding. A body with a tail is computed alone, not side by side with others.
    Mask<T> has_tail;
    T grade;  // g of physics (61)
    T kappa;
    T speed;        // dw/dy
    T sine_scale;   // C, the factor of sc
    T flat_scale2;  // (g C)^2
    T tip_scale2;   // (kappa C)^2
    T a[4];
    T b[3];
};

// The point y = quarters Y + offset. `quarters` is the integer nearest to y/Y, unless a function
// states otherwise.
template <class T>
struct PhasePlace {
    T quarters;
    T offset;
};

// A phase, given by its sine and cosine.
template <class T>
struct PhasePoint {
    T sin;
    T cos;
};

// Time [s], angle [rad] and path of the centre [m] over an interval of y, or their derivatives with
// respect to y.
template <class T>
struct PhaseIncrement {
    T time;
    T angle;
    T path;
};

// Number of doubles in the widest Pack; arrays of points are padded to a multiple of it.
inline constexpr int widest_pack = 8;
inline constexpr int most_places = 48;  // room for the nodes of a panel and its end

template <class T>
struct alignas(64) PhaseRates {
    T time[most_places];
    T angle[most_places];
    T path[most_places];
};

// The time of a motion as a function of its phase.
template <class T>
struct PhaseTime {
    PhaseIntegrand<T> integrand;
    PhaseMap<T> map;
    TwoParts<T> quarter_turn;  // time to the tip or turning point; infinite on the separatrix
    TwoParts<T> half_turn;     // time in which the phase advances by pi
    T quarter_path;            // path of the centre in a quarter of a rotation
    // The following members give an initial guess of the point at a given time.
    static constexpr int most_steps = 160;  // largest number of steps in a map
    T slope[most_steps + 3];                // dt/dy at the steps, and one step beyond each end
    T time[most_steps + 2];  // time from the flat position to each step, from cubics for dt/dy
};

// The constants of the power series in time (rolling/level/motion.hpp). The unit of length is the
// long semi-axis; the unit of time is chosen for each table or short move.
struct SeriesConstants {
    double short_axis2;
    double c2;
    double gravity;
    double d0;  // D h^2 = d0 + d1 sin^2 phi, physics (28)
    double d1;
};

// A libration or rotation that starts at a given phase.
template <class T>
struct PhaseMotion {
    PhaseTime<T> phase;
    T direction;                // direction of a rotation; +1 for libration
    T amplitude;                // sin phi_max of a libration; 1 for rotation
    Mask<T> on_way_back;        // whether a libration starts with a phase beyond +-pi/2
    PhasePoint<T> start_phase;  // initial phase, minus half a turn on the way back
    PhasePlace<T> start_place;
    T start_slope;  // dt/dy at the start; 0 for a circle and at rest
};

// The state of a motion: angle [rad], angular velocity [rad/s], position of the centre [m].
template <class T>
struct MotionSample {
    T theta;
    T omega;
    T x;
};
using FlowSample = MotionSample<double>;

enum class MotionKind { rest, uniform, libration, rotation };

// An exact motion. Its phase is set for libration and rotation only.
struct RollingFlow : PhaseMotion<double> {
    MotionKind kind;
    RollingStart from;
    double x;  // position of the centre at the start [m]
};

RollingFlow rolling_flow(const RollingStart& from, double x = 0.0);

// Whether one power series about the start may suffice for a move of duration t, estimated from the
// angular velocity and the rate of rocking about the flat position.
inline bool may_be_short(const RollingStart& from, double t) {
    const double rate = std::sqrt(from.body.gravity / from.view.short_axis);
    return std::abs(t) * (std::abs(from.omega) + rate) < 0.05;
}

// The state at a time |t| <= longest_time.
FlowSample sample(const RollingFlow& flow, double t);

// The state of one body at a time, after validating the time.
FlowSample sample_alone(const RollingStart& from, double t);

// The time of 1e15 half turns [s]; beyond it, a double does not resolve the phase.
double longest_time(const RollingFlow& flow);

// Throws std::invalid_argument for a time that is not finite or beyond +-`longest`.
void validate_time(double t, double longest, const std::string& name = "t");

// Time of a full swing or turn [s]; infinite for a body at rest and on the separatrix.
double period(const RollingFlow& flow);

// Time from the flat position to a phase in the same half turn.
DoubleDouble time_since_flat(const RollingFlow& flow, const PhasePoint<double>& phase);

// The first time t >= 0 at which a moving ellipse passes the angle theta with a velocity of the
// given sign.
double time_of_passing(const RollingFlow& flow, double theta, double heading);

}  // namespace rolling_ellipse
