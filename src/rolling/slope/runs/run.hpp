// Many half turns on a slope, down it or up it, at a cost that does not depend on their number.
//
// W = D omega^2/2 is the same function of the angle in every half turn, but for its gain w, so that
// the time of n of them is physics (59),
//     T(n) = int sqrt(D/2) sum_(j<n) (W + j w)^(-1/2) dphi   over one half turn,
// and the sum is a difference of Hurwitz zeta functions, here by Euler and Maclaurin. The integrand
// is singular beside the flat position, where D = 0, and beside the place of the least W: panels
// are graded towards both, as those of physics (31).
#pragma once

#include <cstddef>
#include <vector>

#include "numerics/quadrature.hpp"
#include "rolling/slope/motion.hpp"

namespace rolling_ellipse {

// The rule of the parts of panels, in which the integrand is the polynomial through its nodes.
inline constexpr int part_order = 16;
inline const GaussRule& part_rule() { return gauss_rule(part_order); }

// Nodes of Gauss rules, each with its weight times sqrt(D/2), and W in the first half turn.
struct RunNodes {
    std::vector<double> weight;
    std::vector<double> level;
};

// Of the sum of (W + j w)^(-1/2): so many terms, and what the others need of the level W + j w that
// they start at.
struct FirstRates {
    double count;
    double sum;
    double level;
    double root;
    double remainder;
};

// tan((phi - centre)/scale) = grade sinh(v), first <= v <= last. The integral over all of it takes
// the nodes of one rule, one up to a place in it the finer ones of its parts.
struct RunPanel {
    double quarters;  // the centre, with the quarters of the run
    double angle;
    double scale;
    double grade;
    double first;
    double last;
    std::size_t begin;  // of its nodes
    std::size_t end;
    std::size_t part;  // the first of its parts
    int parts;
};

struct SlopeRun {
    SlopeBody body;
    SlopePlace from;
    double turns;    // quarters of whole half turns before it, from which its own count
    double heading;  // +1 downhill, -1 uphill
    double path;     // at `from`, from the flat position that they end at
    Geometry at;     // there
    double energy;   // W there
    std::vector<RunPanel> panels;
    RunNodes nodes;
    RunNodes part_nodes;
    std::vector<FirstRates> first;  // of the nodes, downhill
    double mass;                    // the sum of all weights
    double half_turn;               // time of the first one
    double half_turns;              // for which it may be asked
};

// From a place, for so many half turns uphill that W stays some times w above 0 everywhere, see
// `may_run`; for any number of them downhill.
SlopeRun slope_run(const SlopeBody& body, const SlopePlace& from, double energy, double half_turns);

// Beyond, a double does not know the phase.
inline constexpr double most_half_turns = 1e15;

// Half turns from a place, the way it goes, in which W is large enough beside w for the sum.
double may_run(const SlopeBody& body, double energy, const Geometry& at, double omega);

// The time of n half turns.
DoubleDouble time_of(const SlopeRun& run, double half_turns);

// The place at v in a panel, of the half turn that follows n of them.
SlopePlace place_on(const SlopeRun& run, const RunPanel& panel, double v, double half_turns);

// The place after n half turns.
SlopePlace place_after(const SlopeRun& run, double half_turns);

}  // namespace rolling_ellipse
