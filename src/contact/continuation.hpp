// What a body does next that touches the ground and does not move into it.
#pragma once

#include "scene/scene.hpp"

namespace rolling_ellipse {

// Does exactly one motion go on from here? Not always where the contact slides (P. Painleve, C. R.
// Acad. Sci. 121 (1895) 112): pressed against the ground (c > 0) none does if B <= 0; pulled off it
// (c < 0) two do if B < 0, flight and a slide with N = c/B > 0.
enum class Painleve { determined, no_motion, two_motions };

struct Continuation {
    Mode mode;
    double side = 0.0;  // sign of the slip
    Painleve paradox = Painleve::determined;
    // Friction without end where c = 0 but for rounding: N is then rounding as well, and next to
    // the tip so is B. The body moves freely until it has turned so far that they have digits.
    bool grazes = false;
    bool may_fly = false;  // it rolls, and flight would obey the laws as well
};

inline constexpr double turn_of_grazing = 0x1p-22;  // [rad]

// The mode that the forces allow. Without slip it rolls where it may and can; else it starts to
// slide, or leaves the ground where its contact is not pressed any more. On slopes the forces may
// allow it to roll and to fly (c < 0 < N): it rolls, as a body does that has come there rolling.
Continuation continuation(const Scene& scene, const State& state, bool may_roll = true);

// What a body does from its start on, which may be in the air.
Continuation first_continuation(const Scene& scene, const State& start, bool may_roll = true);

}  // namespace rolling_ellipse
