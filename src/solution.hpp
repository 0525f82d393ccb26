// A motion, with how it was computed and how it ended.
#pragma once

#include <optional>
#include <string>

#include "contact/segments.hpp"
#include "integrator/system.hpp"
#include "proof/watch.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

struct Solution : Integration<Motion> {
    Model model = Model::rolling;
    Method method = Method::exact;
    double valid_until = infinity;  // time at which the model stops being valid
    std::string message = {};
    std::optional<ContactWatch> watch = {};  // forces of a motion without a proof
};

}  // namespace rolling_ellipse
