// The mode in which a body goes on that touches the ground and does not move into it.
#pragma once

#include "scene/scene.hpp"

namespace rolling_ellipse {

// The number of motions that go on. A sliding contact may have none or two (P. Painleve, C. R.
// Acad. Sci. 121 (1895) 112): pressed against the ground (c > 0) it has none if B <= 0; pulled off
// it (c < 0) it has two if B < 0, flight and a slide with N = c/B > 0.
enum class Painleve { determined, no_motion, two_motions };

struct Continuation {
    Mode mode;
    double side = 0.0;  // sign of the slip
    Painleve paradox = Painleve::determined;
    // Infinite friction, and c = 0 within rounding: N is then rounding as well, and next to the tip
    // so is B. The body moves freely until it has turned so far that they have digits.
    bool grazes = false;
    bool may_fly = false;  // the body rolls, and flight would obey the laws as well
};

inline constexpr double turn_of_grazing = 0x1p-22;  // [rad]

// The mode that the forces allow. Without slip the body rolls if it may and can; else it starts to
// slide, or leaves the ground if its contact is not pressed any more. On slopes the forces may
// allow both rolling and flight (c < 0 < N): the body then rolls, as it does if it has arrived
// rolling.
Continuation continuation(const Scene& scene, const State& state, bool may_roll = true);

// The same state by other axes, and the angle that belongs to them. Contact and no slip remain so.
State with_angle(const Axes& axes, State state, const Axes& new_axes, double theta);

// The mode in which a body goes on from its start, which may be in the air.
Continuation first_continuation(const Scene& scene, const State& start, bool may_roll = true);

}  // namespace rolling_ellipse
