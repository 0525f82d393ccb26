#include "describe.hpp"

#include <cmath>

namespace rolling_ellipse {
namespace {

void append(Sentences& to, const Sentences& more) { to.insert(to.end(), more.begin(), more.end()); }

// The effect of the blow on the contact.
Sentence effect_of(const Scene& scene, const Start& start) {
    const std::pair along{"along", start.reaction_x}, up{"up", start.reaction_z};
    if (start.slip_removed != 0) return {"stopped", {along, up, {"energy", start.energy_lost}}};
    if (!scene.impulse) return {"no_blow", {}};
    if (!start.touching) return {"in_the_air", {}};
    if (start.state.mode == Mode::flight) return {"thrown", {}};
    if (start.state.mode != Mode::sliding)
        return {"sticks", {along, up, {"omega", start.free_omega}}};
    if (std::isinf(scene.friction)) return {"lifted", {along, up}};
    return {"slides_off", {along, up, {"mu", scene.friction}}};
}

// The outcome of rolling that an event signals.
std::optional<Outcome> outcome_of(EventKind kind) {
    if (kind == EventKind::slip) return Outcome::slips;
    if (kind == EventKind::lift_off) return Outcome::loses_contact;
    if (kind == EventKind::jam) return Outcome::jams;
    return {};
}

// How a body with rolling resistance starts to move, and the first event that ends its rolling or
// brings it to rest.
Sentences course_of(const Scene& scene, const Solution& solution, const Start& start,
                    double begin) {
    Sentences found{{name(start.next.mode) + "_starts", {}}};
    for (const auto& [t, kind, before, after] : solution.motion.events) {
        if (t < begin) continue;
        if (kind == EventKind::blow) break;
        if (kind == EventKind::rest) {
            const double askew =
                std::abs(quarter_view({after.state.theta, 0.0}).rest.high) * (180 / pi);
            const bool has_angle = scene.slope == 0 && scene.a != scene.b;
            found.push_back(has_angle ? Sentence{"rests_askew", {{"t", t}, {"angle", askew}}}
                                      : Sentence{"rests_at", {{"t", t}}});
            break;
        }
        const auto end = outcome_of(kind);
        if (!end || t == begin) continue;
        found.push_back({name(*end) + "_at", {{"t", t}}});
        break;
    }
    return found;
}

// Explains why the motion differs from what the initial velocities suggest; empty if it does not.
Sentences surprise(const Scene& scene, const Start& start) {
    const Continuation& next = start.next;
    if (next.may_fly) return {{"wedged", {}}};
    if (next.paradox == Painleve::no_motion) return {{"no_motion", {}}};
    if (next.paradox == Painleve::two_motions) return {{"two_motions", {}}};
    if (next.mode == start.state.mode || next.mode == Mode::rest) return {};
    if (next.mode != Mode::sliding || std::isinf(scene.friction)) return {{"pulled", {}}};
    return {{"no_grip", {{"mu", scene.friction}}}};
}

Sentence proof_of(const Scene& scene, const Start& start, const Certificate& proof) {
    const auto& normal = proof.smallest_normal_force;
    const auto& needed = proof.largest_friction_needed;
    const double at =
        proof.end.angle ? *proof.end.angle : proof.smallest_normal_force_angle.value_or(0.0);
    const std::pair angle{"angle", at == 0 ? 0.0 : at * (180 / pi)};
    if (proof.end.angle) {
        if (proof.end.validity == Validity::edge) return {"on_edge", {angle}};
        if (std::isinf(scene.friction)) return {"ends_pull", {angle}};
        return {"ends_grip", {angle, {"mu", scene.friction}}};
    }
    if (start.next.mode == Mode::rest) return {"stays", {{"N", *normal}, {"ratio", *needed}}};
    const bool known = proof.smallest_normal_force_angle && *needed < infinity;
    if (!known || proof.end.validity != Validity::valid) return {"rolls", {}};
    return {"proved", {{"N", *normal}, angle, {"ratio", *needed}}};
}

// The proof about rolling, the friction that it assumes, and the friction that the blow needs in
// order not to cause slip.
Sentences proof_of_rolling(const Scene& scene, const Start& start, const Certificate& proof) {
    Sentences found{proof_of(scene, start, proof)};
    if (std::isinf(scene.friction)) {
        found.push_back({"unlimited", {}});
    } else if (found.back().first != "ends_grip") {
        found.push_back({"friction", {{"mu", scene.friction}}});
    }
    const double needed = sticking_friction(scene);
    if (effect_of(scene, start).first == "sticks" && needed > 0 && needed < infinity) {
        found.push_back({"blow_needs", {{"needed", needed}}});
    }
    return found;
}

// The first event after which a body that starts in the air is on the ground; null if there is
// none.
const Event* landing_of(const Solution& solution) {
    for (const Event& each : solution.motion.events) {
        if (each.after.state.mode != Mode::flight) return &each;
    }
    return nullptr;
}

// How and, if known, when the rolling that starts at the time `begin` ends.
Sentence end_of_rolling(const Scene& scene, const Solution& solution, Outcome first, double begin) {
    const auto at = [](Outcome end, double t) { return Sentence{name(end) + "_at", {{"t", t}}}; };
    for (const Event& each : solution.motion.events) {
        if (each.kind == EventKind::blow) break;
        const auto end = outcome_of(each.kind);
        if (end && each.t > begin) return at(first == Outcome::jams ? first : *end, each.t);
    }
    const bool ends =
        first == Outcome::slips || first == Outcome::loses_contact || first == Outcome::jams;
    if (solution.model != Model::contact && first != Outcome::edge) {
        const double until = valid_until(scene, solution);
        if (until < infinity) return at(ends ? first : Outcome::slips, until);
    }
    return {name(first) + (ends ? "_later" : "_now"), {}};
}

const char* key_of_early_end(Ending ending) {
    if (ending == Ending::jammed) return "jammed";
    return ending == Ending::undetermined ? "undetermined" : "given_up";
}

}  // namespace

Start::Start(const Scene& scene)
    : InitialState(initial_state(scene)), next(first_continuation(scene, state)) {}

Description describe(const Scene& scene, const Solution& solution, const Checkpoint& checkpoint) {
    Start start(scene);
    Description found{{}, {}, {effect_of(scene, start)}};
    Scene ground = scene;
    double landed = 0.0;
    const bool flies = !start.touching;
    if (flies) {
        const Event* const landing = landing_of(solution);
        if (landing == nullptr) {
            const bool bounces = !solution.motion.events.empty();
            found.headline.push_back({bounces ? "bounces" : "flies_on", {}});
            return found;
        }
        landed = landing->t;
        found.headline.push_back({"lands", {{"t", landed}}});
        ground = reached(scene, landing->after.state);
        start = Start(ground);
    }
    append(found.reasons, surprise(ground, start));
    if (scene.rolling_resistance > 0) {
        append(found.headline, course_of(scene, solution, start, landed));
        return found;
    }
    const Outcome first = outcome(ground, checkpoint);
    found.first = first;
    if (start.holds()) {
        found.headline.push_back(end_of_rolling(scene, solution, first, landed));
        append(found.reasons, proof_of_rolling(ground, start, certify(ground)));
    } else {
        found.headline.push_back({name(first) + (flies ? "_then" : "_now"), {}});
    }
    const Ending ending = solution.ending;
    const double end = solution.followed_until;
    const bool is_early = ending != Ending::completed && ending != Ending::validity_lost;
    if (is_early && (first != Outcome::jams || end > landed)) {
        found.reasons.push_back({key_of_early_end(ending), {{"t", end}}});
    }
    return found;
}

std::optional<Outcome> outcome_after_landing(const Scene& scene, const Solution& solution,
                                             const Checkpoint& checkpoint) {
    const Event* const landing = landing_of(solution);
    if (landing == nullptr) return {};
    return outcome(reached(scene, landing->after.state), checkpoint);
}

Sentences describe_start(const Scene& scene, const Start& start) {
    Sentences found{effect_of(scene, start)};
    append(found, surprise(scene, start));
    const bool is_described = start.next.may_fly || start.next.paradox != Painleve::determined;
    if (!is_described) found.push_back({name(start.next.mode) + "_starts", {}});
    return found;
}

Sentences describe_proof(const Scene& scene, const Certificate& proof) {
    const Start start(scene);
    Sentences found;
    if (start.slip_removed != 0) found.push_back(effect_of(scene, start));
    if (proof.end.validity == Validity::no_proof) {
        found.push_back({scene.rolling_resistance > 0 ? "resisted" : "no_proof", {}});
        return found;
    }
    if (!start.holds()) found.push_back({"cannot_start", {}});
    append(found, surprise(scene, start));
    if (start.holds()) append(found, proof_of_rolling(scene, start, proof));
    return found;
}

}  // namespace rolling_ellipse
