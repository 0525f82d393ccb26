// Sentences about what happens to a body, and why, for Python and for web pages.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "contact/sliding.hpp"
#include "outcome/outcome.hpp"
#include "simulate.hpp"

namespace rolling_ellipse {

// The key of a text in the translation tables, and the named values that replace its placeholders.
using Sentence = std::pair<std::string, std::vector<std::pair<const char*, double>>>;
using Sentences = std::vector<Sentence>;

// The initial state of a scene and the motion that the forces allow next.
struct Start : InitialState {
    explicit Start(const Scene& scene);

    bool holds() const { return next.mode == Mode::rolling || next.mode == Mode::rest; }

    Continuation next;
};

struct Description {
    // The first outcome, after landing if the body starts in the air; empty if the body never lands
    // or has rolling resistance.
    std::optional<Outcome> first;
    Sentences headline;  // what happens
    Sentences reasons;  // the effect of the blow on the contact, then why the body moves as it does
};

Description describe(const Scene& scene, const Solution& solution, const Checkpoint& checkpoint);

// The first outcome after the landing of a body that starts in the air; empty if it never lands.
std::optional<Outcome> outcome_after_landing(const Scene& scene, const Solution& solution,
                                             const Checkpoint& checkpoint);

// Describes the effect of the blow on the contact, and how the body starts to move.
Sentences describe_start(const Scene& scene, const Start& start);

// Describes what the certificate of the scene proves about rolling.
Sentences describe_proof(const Scene& scene, const Certificate& proof);

}  // namespace rolling_ellipse
