// Many half turns down or up a slope, at a cost that does not depend on their number.
//
// From one half turn to the next W = D omega^2/2, a function of the angle, grows by the constant w.
// Hence n half turns take, physics (59),
//     T(n) = int sqrt(D/2) sum_(j<n) (W + j w)^(-1/2) dphi   over one half turn.
// The sum is a difference of Hurwitz zeta functions, computed by the Euler-Maclaurin formula. The
// integrand has complex singularities beside the flat position, where D = 0, and beside the place
// of the least W; panels are graded towards both as in physics (31).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "numerics/quadrature.hpp"
#include "rolling/slope/motion.hpp"

namespace rolling_ellipse {

// Nodes of the Gauss rule of a part of a panel: the integrand is the polynomial through them.
inline constexpr int part_order = 16;
inline const GaussRule& part_rule() { return gauss_rule(part_order); }
using PartArray = std::array<double, part_order>;  // numbers at the nodes of a part

// Nodes of Gauss rules: weight times sqrt(D/2), and W in the first half turn.
struct RunNodes {
    std::vector<double> weight;
    std::vector<double> level;
};

// The first terms of the sum of (W + j w)^(-1/2), and the level W + j w at which the
// Euler-Maclaurin formula takes over.
struct FirstRates {
    double count;  // number of terms
    double sum;
    double level;
    double root;       // square root of the level
    double remainder;  // remainder of the formula at the level
};

// The coordinate v of a panel: tan((phi - centre)/scale) = grade sinh(v), first <= v <= last. The
// integral over the whole panel has one Gauss rule, an integral over a part of it the finer rules
// of its parts.
struct RunPanel {
    double quarters;  // quarter turns of the flat position or tip at or beside the centre
    double angle;     // angle of the centre from there: beyond those quarter turns [rad]
    double scale;
    double grade;
    double first;
    double last;
    std::size_t begin = 0;  // index of the panel's first node in `SlopeRun::nodes`
    std::size_t end = 0;
    std::size_t part = 0;  // index of the panel's first part
    int parts = 0;
};

struct SlopeRun {
    SlopeBody body;
    SlopePlace from;
    double turns;    // whole half turns before `from`, in quarters
    double heading;  // +1 downhill, -1 uphill
    double path;     // path at `from`, from the flat position at `turns`
    Geometry at;     // geometry at `from`
    double energy;   // W at `from`
    std::vector<RunPanel> panels;
    RunNodes nodes;
    RunNodes part_nodes;
    std::vector<FirstRates> first;  // first terms of each node, downhill only
    double mass;                    // sum of all weights, int sqrt(D/2) dphi
    double half_turn;               // time of the first half turn
    double half_turns;              // largest number of half turns of the run
};

// The run from a place: uphill for as many half turns as `may_run` allows, downhill for any number.
SlopeRun slope_run(const SlopeBody& body, const SlopePlace& from, double energy, double half_turns);

// Largest number of half turns: beyond it the phase is lost in the rounding of their number.
inline constexpr double most_half_turns = 1e15;

// Number of half turns from a place, in its direction, during which W is large enough beside w for
// the sum.
double may_run(const SlopeBody& body, double energy, const Geometry& at, double omega);

// Time of n half turns.
DoubleDouble time_of(const SlopeRun& run, double half_turns);

// W at a place in the first half turn.
double level(const SlopeRun& run, double quarters, double angle, const Geometry& here);

// The angular velocity at a place n half turns after the first half turn has W = level there.
double omega_after(const SlopeRun& run, double half_turns, double level, const Geometry& here);

// The place at v in a panel during the half turn after the first n.
SlopePlace place_on(const SlopeRun& run, const RunPanel& panel, double v, double half_turns);

// The place after n half turns.
SlopePlace place_after(const SlopeRun& run, double half_turns);

// Reads places at times after `from`. Integrals over the current half turn are kept for the next
// times in it; the bits of an answer do not depend on earlier calls.
class RunReader {
  public:
    explicit RunReader(const SlopeRun& run);
    SlopePlace operator()(DoubleDouble time);

  private:
    void move_to(DoubleDouble since);
    void set_half_turn(double half_turns);
    double node_time(const RunNodes& nodes, std::size_t i) const;
    PartArray node_times(std::size_t part) const;
    double part_time(std::size_t part);
    SlopePlace place_at(double rest);

    const SlopeRun& run_;
    double half_turns_ = 0.0;  // half turns before the current one
    DoubleDouble begin_;       // time from `from` to the begin of the current half turn
    double lasts_ = 0.0;       // duration of the half turn; 0 before the first call
    std::vector<double> panel_times_;
    std::vector<double> part_times_;  // times of the parts; negative if not known yet
    std::size_t part_ = 0;            // the part whose Legendre coefficients are kept
    PartArray coefficients_{};
};

}  // namespace rolling_ellipse
