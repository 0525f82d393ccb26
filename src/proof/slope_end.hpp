// Where rolling on a slope ends: the law of the contact along the motion, as polynomials of time.
//
// N and F come from the same power series as the motion, N = g_into + h'' and F = x'' - g_along, so
// that the first place at which the law is broken is the first root of a polynomial. Half turns
// need not be followed one by one: at each angle N and F are linear in W = D omega^2/2, physics
// (58), so that the law holds for an interval of W, and what holds in two half turns holds in all
// between them.
#pragma once

#include <array>
#include <optional>

#include "proof/certificate.hpp"
#include "rolling/slope/flow.hpp"

namespace rolling_ellipse {

// A time [s] since the start, with the angle and which way it is passed.
struct Meeting {
    double time;
    double theta;
    double heading;
};

// What the law meets: the first place at which its margin comes down to rounding and no further,
// and the first at which it is broken, after which nothing is looked for.
struct LawMeetings {
    std::optional<Meeting> touched;
    std::optional<Meeting> broken;
};

// Looks at pieces of a motion in the order of time.
class LawWatch {
  public:
    LawWatch(const SlopeFlow& flow, double friction);

    // True once the law is broken.
    bool look(const SlopePiece& piece);

    // What was met; at the end of a motion that stays close to the limit, that too.
    LawMeetings met() const;

  private:
    bool look_at_parts(const SlopePiece& piece);

    struct Near {
        bool is = false;
        bool from_start = false;
        Meeting since{};
    };

    template <class Law>
    void examine(const SlopePiece& piece, const Law& law, double tolerance, double side,
                 Near& near);
    Meeting meeting(const SlopePiece& piece, double share) const;
    double margin(const SlopePiece& piece, double share, double side) const;

    const SlopeBody body_;
    const FlowSample start_;
    const SlopePlace from_;
    const double friction_;
    std::array<Near, 2> near_;
    bool first_ = true;
    LawMeetings met_;
};

// Forwards in time, over the whole motion or up to a time [s] at least; the flow is followed as far
// as that takes.
LawMeetings law_meetings(SlopeFlow& flow, double friction, double until = infinity);

// As what certificates say: a touch is an edge.
EndOfRolling end_of_rolling(const LawMeetings& met);

}  // namespace rolling_ellipse
