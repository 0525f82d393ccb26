// Rolling on a slope: its end and its certificate, in which the extremes of the forces are infinite
// unless the body rests, rocks between two turning points, or is a circle.
#pragma once

#include "proof/certificate.hpp"
#include "rolling/slope/flow.hpp"

namespace rolling_ellipse {

// A point at which the motion is at the limit of the law: time [s] from the start, angle and sign
// of omega.
struct Meeting {
    double time;
    double theta;
    double heading;
};

// `touched`: the first point at which the margin of the law is 0 to within rounding, but not
// negative. `broken`: the first point at which the law fails; the search ends there.
struct LawMeetings {
    std::optional<Meeting> touched;
    std::optional<Meeting> broken;
};

// Examines the law on the stretches of a motion in order of time, at least up to the time `until`,
// which is in the body's unit of time.
class LawWatch {
  public:
    LawWatch(const SlopeFlow& flow, double friction, double until = infinity)
        : flow_(flow), friction_(friction), until_(until) {}

    // Examines the next stretch; true once the law is broken.
    bool examine(const Even&);
    bool examine(const SlopePiece& piece);
    bool examine(Sum& sum);
    bool examine(const Swing& swing);
    // These stretches only repeat the forces of earlier ones.
    bool examine(const Mirror&) { return false; }
    bool examine(const Repeat&) { return false; }

    // The results so far. A motion that ends within rounding of the limit has touched it.
    LawMeetings met() const;

  private:
    struct Law;

    // A stretch of time on which the margin is within rounding of 0.
    struct Stretch {
        bool open = false;
        std::optional<Meeting> begin;  // empty if it starts with the motion
    };

    bool examine_parts(const SlopePiece& piece);
    void examine(const SlopePiece& piece, const Law& law, Stretch& near);
    void break_at(const Meeting& meeting);
    Meeting meeting(const SlopePiece& piece, double share) const;

    const SlopeFlow& flow_;
    const double friction_;
    const double until_;
    Stretch near_[2];  // one stretch for each direction of the friction force
    bool at_start_ = true;
    LawMeetings met_;
};

// Where the whole motion, or at least its part up to a time [s], is at the limit of the law;
// extends the flow as needed.
LawMeetings law_meetings(SlopeFlow& flow, double friction, double until = infinity);

// The end of rolling for a certificate; where the motion only touches the limit, it is `edge`.
EndOfRolling end_of_rolling(const LawMeetings& met);

// Whether the rolling motion from a state on a slope may stay valid forever. A circle and a body in
// equilibrium have constant forces; a rocking body has turning points; all others run downhill
// faster and faster until the law fails.
bool may_hold_for_ever(const Scene& scene, const State& start);

// The certificate of rolling on a slope, given the end of rolling.
Certificate certify_on_slope(const Scene& scene, const State& start, const EndOfRolling& end);

}  // namespace rolling_ellipse
