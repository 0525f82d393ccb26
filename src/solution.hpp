// A motion: segments in time order, each with an evaluator for any time inside.
#pragma once

#include <string>
#include <vector>

#include "flow.hpp"

namespace rolling_ellipse {

struct Segment {
    Mode mode;
    double t0;
    double t1;
    RollingFlow rolling;
};

enum class Status { completed, validity_lost };

struct Solution {
    std::vector<Segment> segments;
    Status status = Status::completed;
    double followed_until = -infinity;  // last time that the segments describe
    double valid_until = infinity;      // time at which the model stops being true
    std::string reason;
    std::string message;
};

}  // namespace rolling_ellipse
