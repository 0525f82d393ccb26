// Exact rolling on a slope: the state at any time.
//
// The motion is a list of stretches, each with its law, extended as far as the requested times
// require. Neither cost nor error grows with the number of half turns or swings.
#pragma once

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "rolling/level/flow.hpp"
#include "rolling/slope/swing.hpp"

namespace rolling_ellipse {

// A body at rest, or a circle, whose angular acceleration is constant.
struct Even {};

// Many half turns at once: uphill to `end`, near the top of the climb, or downhill forever, in
// which case `end` has no meaning.
struct Sum {
    SlopeRun run;
    SlopePlace end;
};

// The motion before the first turning point, in reverse, back to the point where the series start.
struct Mirror {
    DoubleDouble turning;
    SlopePlace end;
};

// Rocking forever: repeats the motion between two turning points.
struct Repeat {
    DoubleDouble first;
    DoubleDouble last;

    DoubleDouble lasts() const { return last - first; }
};

// An interval of time with one law. A time belongs to the last stretch that starts by then.
struct SlopeStretch {
    double begin;
    double end;  // time up to which the law holds
    std::variant<Even, SlopePiece, Sum, Swing, Mirror, Repeat> law;

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
    // All members below are in the units of `body`.
    double acceleration;  // initial angular acceleration; constant for a circle
    SlopePlace start;
    Datum datum;  // the start as a datum
    std::vector<SlopeStretch> stretches;
    std::optional<DoubleDouble> turning;  // time of the first turning point, once known
    bool by_series = false;               // true if the motion must not be treated as a swing
};

// The flow of a body that rolls on a nonzero slope.
SlopeFlow slope_flow(const Body& body, double slope, double theta, double omega, double x);

// A new flow from the same start that computes swings from series, not as a `Swing`.
SlopeFlow by_series(const SlopeFlow& flow);

// Extends the stretches until the motion is known up to a time [s].
void prepare(SlopeFlow& flow, double t);

// Appends at least one stretch; false if the last stretch never ends. A swing is computed from
// series if the body is still near its start at the time `until`, given in units of the body.
bool grow(SlopeFlow& flow, double until = infinity);

// The state at a time, or at n times, up to which the flow has been prepared. Ascending times are
// fastest.
FlowSample sample(const SlopeFlow& flow, double t);
void sample(const SlopeFlow& flow, const double* times, std::size_t n, FlowSample* samples);
FlowSample sample_of(const SlopeFlow& flow, const SlopePlace& place);

// Time of 1e15 half turns or half swings [s]. Returns infinity if the motion has not been prepared
// that far or, to save work, if the time t is far below the limit.
double longest_time(const SlopeFlow& prepared, double t = infinity);

// Time between two turning points of a body that rocks, in units of the body; empty for other
// motions.
std::optional<DoubleDouble> half_period(const SlopeFlow& prepared);

// Time of a full swing [s]; empty if the motion does not repeat, infinite at rest.
std::optional<double> period(const SlopeFlow& prepared);

}  // namespace rolling_ellipse
