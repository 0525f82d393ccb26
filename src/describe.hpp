// Sentences on what happens to a body, and why, for Python and for web pages.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "outcome/outcome.hpp"
#include "simulate.hpp"

namespace rolling_ellipse {

// The key of a text in the translation tables, and the named values that replace its placeholders.
using Sentence = std::pair<std::string, std::vector<std::pair<const char*, double>>>;
using Sentences = std::vector<Sentence>;

struct Description {
    // The first outcome, after landing if the body starts in the air; empty if it never lands.
    std::optional<Outcome> first;
    Sentences headline;  // what happens
    Sentences reasons;   // the effect of the blow on the contact, then the cause of the motion
};

Description describe(const Scene& scene, const Solution& solution, const Checkpoint& checkpoint);

// The first outcome for a body that starts in the air, after it lands; empty if it never lands.
std::optional<Outcome> outcome_after_landing(const Scene& scene, const Solution& solution,
                                             const Checkpoint& checkpoint);

// Says what the blow does, and how the body moves after it.
Sentences describe_start(const Scene& scene);

// Says what the certificate of the scene proves about rolling.
Sentences describe_proof(const Scene& scene);

}  // namespace rolling_ellipse
