// Exact rolling on a slope: the state at any time.
//
// The motion is a chain of power series in time (`pieces`), and neither its cost nor its error
// grows with the time:
// * the motion after a turning point mirrors the motion before it, so that the series continue from
//   the reversed start at twice the time of the first turning point;
// * a body that rocks between two turning points repeats the series up to the second one;
// * a climb of half turns is one sum (`climb`), and the series continue near its top;
// * a body that runs downhill for good is one sum (`run`).
#pragma once

#include <optional>

#include "rolling/level/flow.hpp"
#include "rolling/slope/run.hpp"

namespace rolling_ellipse {

struct SlopeFlow {
    // `uniform` for a circle, which accelerates evenly; `rotation` before it has turned twice.
    MotionKind kind;
    double theta;  // angle, angular velocity and position at the start [rad, rad/s, m]
    double omega;
    double x;
    SlopeBody body;
    // All members below are in units of the body.
    double acceleration;  // angular acceleration at the start; a circle keeps it
    SlopePlace start;
    SlopeEnergy energy;
    std::optional<SlopeRun> climb;
    std::vector<SlopePiece> pieces;
    std::vector<DoubleDouble> turnings;  // times of the first two turning points
    std::optional<SlopeRun> run;
};

// The flow of a body that rolls on a slope other than 0.
SlopeFlow slope_flow(const Body& body, double slope, double theta, double omega, double x);

// Extend the pieces until the motion is known up to a time [s].
void prepare(SlopeFlow& flow, double t);

// Append one piece; false if the motion is known without more pieces.
bool grow(SlopeFlow& flow);

// The state at a prepared time in [0, longest_time]; the states at n times, fastest if ascending.
FlowSample sample(const SlopeFlow& flow, double t);
void sample(const SlopeFlow& flow, const double* times, std::size_t n, FlowSample* samples);
FlowSample sample_of(const SlopeFlow& flow, const SlopePlace& place);

// Time of 1e15 half turns or swings; infinite if the motion was not prepared for that many, or if a
// time t is far below it, which is faster to see.
double longest_time(const SlopeFlow& prepared, double t = infinity);

// Time of a full swing [s]; empty if the motion does not repeat, infinite at rest.
std::optional<double> period(const SlopeFlow& prepared);

}  // namespace rolling_ellipse
