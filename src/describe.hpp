// What happens to a body, and why, as sentences for Python and for pages.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "outcome/outcome.hpp"
#include "simulate.hpp"

namespace rolling_ellipse {

// The key of a text in the tables of words, and the numbers for its braces by their names.
using Sentence = std::pair<std::string, std::vector<std::pair<const char*, double>>>;
using Sentences = std::vector<Sentence>;

struct Description {
    // The first outcome, after the flight of a body in the air; none if it stays there.
    std::optional<Outcome> first;
    Sentences headline;  // what happens
    Sentences reasons;   // what the blow does to the contact, then why the motion is as it is
};

Description describe(const Scene& scene, const Solution& solution, const Checkpoint& checkpoint);

// What the blow does, and how the body moves after it.
Sentences describe_start(const Scene& scene);

// What the certificate of the scene proves of rolling.
Sentences describe_proof(const Scene& scene);

}  // namespace rolling_ellipse
