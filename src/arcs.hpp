// A motion as its arcs from event to event, with the times at which what it does may turn round.
#pragma once

#include <vector>

#include "solution.hpp"

namespace rolling_ellipse {

enum class ArcKind {
    still,             // nothing changes
    uniform,           // a circle that rolls on level ground
    turning,           // exact rolling over and over
    swinging,          // exact rolling to and fro
    sloping,           // exact rolling on a slope, not to and fro: it turns round once at most
    rolling_steps,     // integrated: polynomials of theta and omega between the marks
    coordinate_steps,  // of all coordinates
    sliding_steps,     // of theta, omega and x
    settling,          // omega is linear, theta and x are parabolas
    flight,            // theta is linear, x and z are parabolas
};

// The marks lie strictly inside, ascending: of exact rolling the passages of the flat position and
// of the tip, or turning point, in the first period, between which height, speed and angle rise or
// fall; on a slope sixteen parts of each half turn, of 50 000 at most, in which its omega is nearly
// a polynomial; steps of integrations; the vertices of flight.
struct Arc {
    ArcKind kind;
    double begin;   // [s]
    double end;     // [s]
    double period;  // [s], after which height and angular velocity are the same; infinite else
    std::vector<double> marks;
};

// Up to where the solution was followed.
std::vector<Arc> arcs(const Solution& solution);

}  // namespace rolling_ellipse
