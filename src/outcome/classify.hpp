// The first thing that happens to a rolling body, from signs of polynomials alone.
#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace rolling_ellipse {

enum class Outcome : std::int8_t {
    rests,
    rocks,          // it turns back before anything else happens
    rolls_over,     // it passes the tip before anything else happens
    slips,          // its contact slides
    loses_contact,  // it leaves the ground, or is in the air
    jams,           // not out of rolling, see outcome/classify.cpp
    edge,           // undecided within rounding
};

// For a body that rolls (or rests) on level ground with the given angle and angular velocity.
Outcome classify(const Body& body, double friction, double theta, double omega);

}  // namespace rolling_ellipse
