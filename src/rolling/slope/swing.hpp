// Rocking in a well: the whole motion by quadrature, at a cost independent of the number of swings.
//
// The bottom of a well is the position where gravity has no moment; a side of it leads there from a
// turning point, in the time int sqrt(D/2) W^(-1/2) dtheta. W = D omega^2/2 is itself an integral
// from the turning point, of the moment of gravity in physics (62): a product, so that W is never a
// difference where it is small. Each side has two panels of a coordinate v that removes what is not
// smooth: about the turning point tan(theta - rim) is a multiple of cosh(v), which removes the root
// of W; elsewhere tan(theta) is a multiple of sinh(v), as D has complex zeros near the flat
// position.
//
// Angles and paths ahead are measured from the turning point of a side towards the bottom.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "rolling/slope/run.hpp"

namespace rolling_ellipse {

// A panel with any centre, v = 0: tan(angle from the rim or from the flat position) = grade f(v),
// where f = cosh(v) about the rim, and f(v) = sinh(v + a constant) about the flat position.
struct WellPanel {
    double angle;  // of the centre from the flat position, ahead
    SineCosine at;
    double grade;
    double value;          // f at the centre
    double rate;           // f' there
    SineCosine to_bottom;  // of the angle from the centre to the bottom, ahead
    SineCosine from_rim;   // of the angle from the rim behind to the centre
};

// Adds the polynomial of W, at a turning point of W/(1 + s)^2, where s is the position in the part.
struct WellReading : PartReading {
    std::array<double, part_order + 1> level;
};

struct WellSide {
    double heading;                   // +1 if the bottom is at the greater angle
    std::array<WellPanel, 2> panels;  // about the turning point, and about the bottom
    std::vector<RunPart> parts;       // from the turning point to the bottom
    double path_ahead;                // path from the turning point to the bottom
    DoubleDouble lasts;               // and the time
    double path;                      // path from the start of the motion to the turning point
};

struct Swing {
    std::array<WellSide, 2> sides;  // uphill and downhill
    double quarters;                // of the flat position in the well
    DoubleDouble turned;            // a time at which the body turns back uphill

    DoubleDouble lasts() const { return sides[0].lasts + sides[1].lasts; }
};

// The motion from a place, if it rocks and turns well before the rims of the well.
std::optional<Swing> swing_from(const SlopeBody& body, const SlopePlace& start);

// N and F at the nodes of a part, per unit mass, x pointing ahead.
PartForces node_forces(const SlopeBody& body, const WellSide& side, const RunPart& part);

// Computes points of a swing. The bits of an answer do not depend on other times.
class SwingReader {
  public:
    SwingReader(const SlopeBody& body, const Swing& swing) : body_(body), swing_(swing) {}

    // Computes the point at the first of n times [s] and, side by side with it, at the next ones in
    // the same part, up to `RunReader::most` in all. Returns the number of points.
    std::size_t operator()(const double* times, std::size_t n, SlopePlace* places);

  private:
    const SlopeBody& body_;
    const Swing& swing_;
    std::array<std::vector<WellReading>, 2> readings_;  // of the parts read so far
};

}  // namespace rolling_ellipse
