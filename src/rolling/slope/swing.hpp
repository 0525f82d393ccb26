// Rocking in a well: the whole motion by quadrature, at a cost independent of the number of swings.
//
// A well lies between two unstable equilibria, its rims; at its bottom, the stable equilibrium,
// gravity has no moment. A side of the well is the motion from a turning point to the bottom, which
// takes the time int sqrt(D/2) W^(-1/2) dtheta. W = D omega^2/2 is the integral, from the turning
// point, of the moment of gravity in physics (62), which is a product. Small values of W are
// therefore not differences of large terms. Each side has two panels of a coordinate v in which the
// integrand is smooth. Near the turning point, tan(theta - rim) is a multiple of cosh(v), which
// removes the square root of W; elsewhere, tan(theta) is a multiple of sinh(v), since D has complex
// zeros near the flat position.
//
// Angles and paths ahead are measured from the turning point of a side towards the bottom.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "rolling/slope/run.hpp"

namespace rolling_ellipse {

// A panel about an arbitrary centre, at which v = 0: tan(angle from the rim or from the flat
// position) = grade f(v), with f(v) = cosh(v) for the rim and f(v) = sinh(v + a constant) for the
// flat position.
struct WellPanel {
    double angle;  // angle of the centre ahead of the flat position
    SineCosine at;
    double grade;
    double value;          // f at the centre
    double rate;           // f' at the centre
    SineCosine to_bottom;  // sine and cosine of the angle from the centre to the bottom
    SineCosine from_rim;   // sine and cosine of the angle from the rim to the centre
};

// A PartReading with a polynomial for W or, in a part that starts at a turning point, for W/(1 +
// s)^2, where s is the position in the part.
struct WellReading : PartReading {
    std::array<double, part_order + 1> level;
};

struct WellSide {
    double heading;                   // +1 if the bottom is at a greater angle than the rim
    std::array<WellPanel, 2> panels;  // about the turning point, and about the bottom
    std::vector<RunPart> parts;       // from the turning point to the bottom
    double path_ahead;                // path from the turning point to the bottom
    DoubleDouble lasts;               // time from the turning point to the bottom
    double path;                      // path from the start of the motion to the turning point
};

struct Swing {
    std::array<WellSide, 2> sides;  // uphill and downhill
    double quarters;                // quarter turns to the flat position in the well
    DoubleDouble turned;            // a time at which the body is at the uphill turning point

    DoubleDouble lasts() const { return sides[0].lasts + sides[1].lasts; }
};

// The motion from a given start; empty unless the body turns back well before both rims of a well.
std::optional<Swing> swing_from(const SlopeBody& body, const SlopePlace& start);

// N and F at the nodes of a part, per unit mass; x points ahead.
PartForces node_forces(const SlopeBody& body, const WellSide& side, const RunPart& part);

// Computes points of a swing. The bits of a point do not depend on the other times.
class SwingReader {
  public:
    SwingReader(const SlopeBody& body, const Swing& swing) : body_(body), swing_(swing) {}

    // Computes the point at the first of n times [s] and, side by side with it, at the next ones in
    // the same part, up to `RunReader::most` in all. Returns the number of points.
    std::size_t operator()(const double* times, std::size_t n, SlopePlace* places);

  private:
    const SlopeBody& body_;
    const Swing& swing_;
    std::array<std::vector<WellReading>, 2> readings_;  // readings of the parts used so far
};

}  // namespace rolling_ellipse
