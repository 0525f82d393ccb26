// The end of rolling on a slope: the law of the contact along the motion, as polynomials of time.
//
// N and F come from the same power series as the motion, N = g_into + h'' and F = x'' - g_along, so
// that the first place at which the law is broken is the first root of a polynomial. Half turns
// need not be followed one by one: at each angle N and F are linear in W = D omega^2/2, physics
// (58), so that the law holds for an interval of W. A law that holds in two half turns holds in all
// between them.
#pragma once

#include <array>
#include <optional>

#include "proof/certificate.hpp"
#include "rolling/slope/flow.hpp"

namespace rolling_ellipse {

// A time [s] since the start, the angle there, and the sign of omega.
struct Meeting {
    double time;
    double theta;
    double heading;
};

// `touched`: the first place at which the margin of the law falls to rounding and no further.
// `broken`: the first place at which the law fails; the search ends there.
struct LawMeetings {
    std::optional<Meeting> touched;
    std::optional<Meeting> broken;
};

// Examines the law on pieces of a motion in the order of time.
class LawWatch {
  public:
    LawWatch(const SlopeFlow& flow, double friction) : flow_(flow), friction_(friction) {}

    // True once the law is broken.
    bool examine(const SlopePiece& piece);

    // The meetings so far. A motion that ends close to the limit has touched it.
    LawMeetings met() const;

  private:
    struct Law;

    // A stretch of time on which the margin is within rounding of 0.
    struct Stretch {
        bool open = false;
        std::optional<Meeting> begin;  // empty if it begins at the start of the motion
    };

    bool examine_parts(const SlopePiece& piece);
    void examine(const SlopePiece& piece, const Law& law, Stretch& near);
    void break_at(const Meeting& found);
    Meeting meeting(const SlopePiece& piece, double share) const;
    double margin(const SlopePiece& piece, double share, double side) const;

    const SlopeFlow& flow_;
    const double friction_;
    std::array<Stretch, 2> near_;  // of the laws for friction to each side
    bool at_start_ = true;
    LawMeetings met_;
};

// The meetings over the whole motion, or up to a time [s] at least; extends the flow as needed.
LawMeetings law_meetings(SlopeFlow& flow, double friction, double until = infinity);

// The end of rolling for a certificate: a touch is an edge.
EndOfRolling end_of_rolling(const LawMeetings& met);

}  // namespace rolling_ellipse
