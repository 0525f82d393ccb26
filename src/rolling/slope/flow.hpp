// Exact rolling on a slope: the state at any time.
//
// The motion is a list of stretches, each with its law, as far as the requested times need it.
// Neither its cost nor its error grows with the number of half turns or swings.
#pragma once

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "rolling/level/flow.hpp"
#include "rolling/slope/run.hpp"

namespace rolling_ellipse {

// Constant forces: a body at rest, or a circle, which accelerates evenly.
struct Even {};

// Many half turns at once: uphill to `end`, near the top of the climb, or downhill for good, where
// `end` has no meaning.
struct Sum {
    SlopeRun run;
    SlopePlace end;
};

// The motion before its first turning point, backwards: it ends with the reversed start of the
// series.
struct Mirror {
    DoubleDouble turning;
    SlopePlace end;
};

// Rocking between two turning points for good, by the motion from the first to the second one.
struct Repeat {
    DoubleDouble first;
    DoubleDouble last;

    DoubleDouble lasts() const { return last - first; }
};

// A stretch of the motion. A time belongs to the last stretch that begins at or before it.
struct SlopeStretch {
    double begin;
    double end;  // as far as the law reaches
    std::variant<Even, SlopePiece, Sum, Mirror, Repeat> law;

    template <class Law>
    SlopeStretch(double begin, double end, Law&& law)
        : begin(begin), end(end), law(std::forward<Law>(law)) {}
};

struct SlopeFlow {
    double theta;  // angle, angular velocity and position at the start [rad, rad/s, m]
    double omega;
    double x;
    bool rests;
    SlopeBody body;
    // All members below are in units of the body.
    double acceleration;  // angular acceleration at the start; a circle keeps it
    SlopePlace start;
    Datum datum;  // the start
    std::vector<SlopeStretch> stretches;
    std::optional<DoubleDouble> turning;  // time of the first turning point, once it is known
};

// The flow of a body that rolls on a slope other than 0.
SlopeFlow slope_flow(const Body& body, double slope, double theta, double omega, double x);

// Extend the stretches until the motion is known up to a time [s].
void prepare(SlopeFlow& flow, double t);

// Append at least one stretch; false if the last one never ends.
bool grow(SlopeFlow& flow);

// The state at a prepared time in [0, longest_time]; the states at n times, fastest if ascending.
FlowSample sample(const SlopeFlow& flow, double t);
void sample(const SlopeFlow& flow, const double* times, std::size_t n, FlowSample* samples);
FlowSample sample_of(const SlopeFlow& flow, const SlopePlace& place);

// Time of 1e15 half turns or swings; infinite if the motion was not prepared for that many, or if a
// time t is far below it, which is faster to see.
double longest_time(const SlopeFlow& prepared, double t = infinity);

// The law of a body that rocks; null for all others.
const Repeat* rocking(const SlopeFlow& prepared);

// Time of a full swing [s]; empty if the motion does not repeat, infinite at rest.
std::optional<double> period(const SlopeFlow& prepared);

}  // namespace rolling_ellipse
