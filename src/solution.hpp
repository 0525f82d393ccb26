// A motion, with how it was computed and how it ended.
#pragma once

#include <optional>
#include <string>

#include "contact/segments.hpp"
#include "proof/watch.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

struct Solution {
    Motion motion;
    Model model = Model::rolling;
    Method method = Method::exact;
    StepCounts counts = {};
    Ending ending = Ending::completed;
    double followed_until = 0.0;    // last time that the motion describes
    double valid_until = infinity;  // time at which the model stops being valid
    std::string message = {};
    std::optional<ContactWatch> watch = {};  // forces of a motion without a proof
};

}  // namespace rolling_ellipse
