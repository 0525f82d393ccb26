// Exact rolling on a slope: the state at any time.
//
// The motion begins with power series about its start (`pieces`). A way back from a turning point
// is the mirror image of the way there, so that the series go on from the start, reversed, at twice
// the time of the first turning point. Where the body rocks between two of them they are followed
// up to the second one, and all else is their repetition. Where it runs uphill for many half turns,
// all but the first (`foot`) are a sum (`climb`), and the series go on near its top; once it runs
// downhill for good, the rest is one (`run`). So neither cost nor error grow with the time.
#pragma once

#include <optional>

#include "rolling/level/flow.hpp"
#include "rolling/slope/runs/run.hpp"

namespace rolling_ellipse {

struct SlopeFlow {
    MotionKind kind;  // `uniform` for a circle, with its angular acceleration; else `rotation`
                      // until it is known to rock
    double theta;
    double omega;
    double x;
    SlopeBody body;
    // All from here on in units of the body.
    double acceleration;  // of a circle
    SlopePlace start;
    SlopeEnergy energy;
    std::vector<SlopePiece> foot;  // of a climb: a sum loses the digits of a short way
    std::optional<SlopeRun> climb;
    double climbed;  // half turns
    std::vector<SlopePiece> pieces;
    std::vector<DoubleDouble> turnings;  // times of the turning points met, two at most
    std::optional<SlopePlace> downhill;  // a place from which it runs downhill for good
    std::optional<SlopeRun> run;
    double until;  // time for which it was prepared
};

// Of a body that rolls on a slope other than 0.
SlopeFlow slope_flow(const Body& body, double slope, double theta, double omega, double x);

// Follow it until it is known up to a time [s].
void prepare(SlopeFlow& flow, double t);

// Add one piece to those known; false where no more of them are needed, for the rest is known.
bool grow(SlopeFlow& flow);

// At a time for which it was prepared, in [0, longest_time]; at n times, best ascending.
FlowSample sample(const SlopeFlow& flow, double t);
void sample(const SlopeFlow& flow, const double* times, std::size_t n, FlowSample* samples);
FlowSample sample_of(const SlopeFlow& flow, const SlopePlace& place);

// 1e15 half turns or swings; infinite where it was not prepared for that many.
double longest_time(const SlopeFlow& prepared);

// W at a place.
double energy_at(const SlopeFlow& flow, const SlopePlace& at);

// Time of a full swing [s]; nothing where the motion does not repeat, infinite at rest.
std::optional<double> period(const SlopeFlow& prepared);

}  // namespace rolling_ellipse
