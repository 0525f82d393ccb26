// Many half turns down or up a slope, at a cost independent of their number.
//
// From one half turn to the next, W = D omega^2/2 at each angle grows by the same amount w. Hence n
// half turns take, physics (59),
//     T(n) = int sqrt(D/2) sum_(j<n) (W + j w)^(-1/2) dphi   over one half turn.
// The sum is a difference of Hurwitz zeta functions, computed by the Euler-Maclaurin formula. The
// integrand has complex singularities near the flat position, where D = 0, and near the point of
// least W; the panels are graded towards both as in physics (31).
//
// Angles, and paths called "ahead", are measured in the direction of the motion: in a climb, too,
// the angle increases, while W falls by w per half turn.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "numerics/quadrature.hpp"
#include "rolling/slope/motion.hpp"

namespace rolling_ellipse {

// The coordinate v of a panel: tan(phi - centre) = grade sinh(v), first <= v <= last. The centre is
// a flat position, the point near a tip where W is least, or a point between them.
struct RunPanel {
    double quarters;  // quarter turns to a flat position or tip
    double angle;     // angle of the centre from that position
    double sin;       // sine and cosine of the centre's angle from a flat position, both
    double cos;       // possibly negated
    double grade;
    double first;  // v at the ends; angles from the centre before the first part is added
    double last;
};

// A part of a panel.
struct RunPart {
    std::size_t panel;  // index of the panel
    double middle;      // v at the middle of the part
    double half;        // half of its width in v
    double path;        // path ahead at the start of the part
    PartArray advance;  // d(path)/ds at the nodes, where s in [-1, 1] is the position
    PartArray mass;     // d/ds of the integral of sqrt(D/2) at the nodes
    PartArray level;    // W at the nodes in the first half turn
    double lasts;       // duration of the part in the first half turn

    // In a swing: whether the part starts at a turning point.
    bool turns() const { return middle == half; }
};

struct SlopeRun {
    SlopeBody body;
    SlopePlace from;
    double turns;                  // whole half turns before `from`, counted in quarter turns
    double heading;                // +1 downhill, -1 uphill
    Datum start;                   // `from` as a datum
    Datum datum;                   // `start`, or a tip at which hardly any W is left
    double half_turns;             // largest number of half turns of the run
    std::vector<RunPanel> panels;  // panels of one half turn, in the direction of motion
    std::vector<RunPart> parts;    // parts of the panels added so far by `extend`
    double path_ahead;             // path from `from` to the end of the last part
    double known;                  // time from `from` to the end of the last part
    double mass;                   // int sqrt(D/2) dphi up to the end of the last part
    std::size_t next_panel;        // indices of the panel, and of the part in it, to be added next
    int next_part;

    bool is_complete() const { return next_panel == panels.size(); }
    double gained(double half_turns) const { return heading * half_turns * body.gain; }
};

// The run from a point of a motion: uphill for as many half turns as `may_run` allows, downhill for
// any number. `start` is the start of the motion, `here` the point where the run starts.
SlopeRun slope_run(const SlopeBody& body, const Datum& start, const SlopePlace& from,
                   const Datum& here, double half_turns);

// Adds parts until the first half turn is known up to a time `since` after `from`, or is complete.
void extend(SlopeRun& run, double since);

// Largest number of half turns; beyond it, the phase is lost in the rounding of that number.
inline constexpr double most_half_turns = 1e15;

// Number of half turns from a point, in its direction of motion, during which W is large enough
// relative to w for the sum over half turns.
double may_run(const SlopeBody& body, double energy, const Geometry& at, const SlopePlace& from);

// d(time)/ds at the nodes of a part after W has grown by `gained`; s in [-1, 1] is the position in
// the part.
PartArray node_times(const RunPart& part, double gained);

// The approximate number of half turns in a time after `from`, assuming that W grows linearly with
// the angle.
double about(const SlopeRun& run, double since);

// The duration of the first n half turns of a complete run. Downhill, the first terms of the sum
// are stored for later calls.
class RunTimes {
  public:
    explicit RunTimes(const SlopeRun& run) : run_(run) {}
    DoubleDouble operator()(double half_turns);

  private:
    void start();

    const SlopeRun& run_;
    double lowest_ = infinity;          // least W of the first half turn
    std::vector<DoubleDouble> begins_;  // start times of the first half turns (uphill, of the last)
};

// Forces at the nodes of a part after n half turns, per unit mass; x points in the direction of
// motion.
struct PartForces {
    PartArray normal;
    PartArray friction;
};
PartForces node_forces(const SlopeRun& run, const RunPart& part, double half_turns);

// The Legendre coefficients of a function on a part, from its values at the nodes.
PartArray legendre_coefficients(const PartArray& at_nodes);

// The point after n half turns of a complete run.
SlopePlace place_after(const SlopeRun& run, double half_turns);

// A part in a given half turn, prepared for the computation of points.
struct PartReading {
    const RunPart* part;
    double half_turns;    // number of half turns before this one
    double lasts;         // duration of the part
    PartPolynomial time;  // derivatives of time and path with respect to the position
    PartPolynomial path;
    std::array<double, 5> about_place;  // approximate position after a fraction of this time
};

// Computes points at times after `from` that `extend` has reached. Integrals over the current half
// turn are stored for later times in the same half turn; the bits of a point depend neither on
// earlier calls nor on the other times.
class RunReader {
  public:
    explicit RunReader(const SlopeRun& run);

    // Computes the point at the first of n times [s] and, side by side with it, at the next ones in
    // the same part, up to `most` in all. Returns the number of points.
    std::size_t operator()(const double* times, std::size_t n, SlopePlace* places);
    static constexpr std::size_t most = 4;

  private:
    double since_begin(double time) const;
    bool is_well_inside(double since) const;
    std::size_t take_parts_off(double& since) const;
    void move_to(DoubleDouble since);
    void set_half_turn(double half_turns);
    void read_part(std::size_t part);

    const SlopeRun& run_;
    RunTimes run_times_;
    double half_turns_ = 0.0;  // half turns before the current one
    DoubleDouble begin_;       // time from `from` to the start of the current half turn
    double lasts_ = 0.0;       // duration of the half turn; 0 before the first call
    std::vector<double> part_times_;
    PartReading reading_{};
};

}  // namespace rolling_ellipse
