// Sliding with Coulomb friction to one side, as power series about a state of the motion.
//
// Physics (51, 52) times powers of h, with u = h^2, p = h h' and the shares nu, phi of the contact
// force along the normal and along the ground:
//     L = h (nu h' + phi h) = nu p + phi u       the lever of the force, times h
//     V = k^2 u B = nu k^2 u + p L               the response to it
//     C = h^3 c = g cos(alpha) u h + (a b - u)(a b + u) omega^2
//     omega' u V = -L C,    friction h V = phi k^2 C
// By the clock dt = u V dtau/(k^2 u0^2), u0 the u of the centre, which slows down near B = 0 where
// N = c/B grows without bound, all of that is polynomial in them: physics (54).
#pragma once

#include "contact/sliding.hpp"
#include "numerics/series.hpp"

namespace rolling_ellipse {

enum class SlideClock { time, slowed };

// The centre of the series: sine and cosine of the angle, and velocities.
struct SlideCentre {
    double sin;
    double cos;
    double omega;
    double slip;
    double x_dot;
};

// The series that samples are taken from. Angle, path and time are 0 at the centre.
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
    LongSeries rolled;    // h omega
    LongSeries pressure;  // C
    LongSeries response;  // V
    LongSeries height2;   // u
    LongSeries work;      // of the friction on the turning, per mass
};

SlideSeries slide_series(const SlidingBody& body, const SlideCentre& centre, SlideClock clock);

}  // namespace rolling_ellipse
