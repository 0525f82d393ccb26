#include "describe.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

using Events = std::vector<Event>;

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

// How an event ends rolling or sliding: the body slips or leaves the ground. Empty for all other
// events. Rolling never jams, see outcome/outcome.cpp.
std::optional<Sentence> end_at(const Event& event) {
    const bool rolled = event.before.mode == Mode::rolling;
    const std::pair t{"t", event.t};
    if (event.kind == EventKind::slip && rolled) return Sentence{"SLIPS_at", {t}};
    if (event.kind != EventKind::lift_off) return {};
    return Sentence{rolled ? "LOSES_CONTACT_at" : "SLIDING_LOSES_CONTACT_at", {t}};
}

Sentence rest_at(const Scene& scene, const Event& event) {
    if (scene.slope != 0 || scene.a == scene.b) return {"rests_at", {{"t", event.t}}};
    const double askew = std::abs(quarter_view({event.after.state.theta, 0.0}).rest.high);
    return {"rests_askew", {{"t", event.t}, {"angle", askew * (180 / pi)}}};
}

// How a body with rolling resistance starts to move, and the first event that ends its rolling or
// sliding or brings it to rest.
Sentences course_of(const Scene& scene, const Events& events, const Start& start, double begin) {
    const Mode first = start.next.mode;
    const Sentence starts{name(first) + "_starts", {}};
    for (const Event& each : events) {
        const bool rests = each.kind == EventKind::rest;
        const auto end = rests ? rest_at(scene, each) : end_at(each);
        if (!end || each.t < begin || (each.t == begin && !rests)) continue;
        if (first == (rests ? Mode::rest : each.before.mode)) return {*end};
        return {starts, *end};
    }
    return {starts};
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
    const bool is_valid = proof.end.validity == Validity::valid;
    if (is_valid && !proof.smallest_normal_force_angle) return {"runs", {}};
    if (!is_valid || *needed == infinity) return {"rolls", {}};
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

// The event with which a body that starts in the air lands; null if it does not land.
const Event* landing_of(const Events& events) {
    for (const Event& each : events) {
        if (each.after.state.mode != Mode::flight) return &each;
    }
    return nullptr;
}

// How and, if known, when the rolling that starts at the time `begin` ends.
Sentence end_of_rolling(const Scene& scene, const Solution& solution, const Events& events,
                        Outcome first, double begin, Validity validity) {
    for (const Event& each : events) {
        const auto end = end_at(each);
        if (end && each.t > begin) return *end;
    }
    const bool ends = first == Outcome::slips || first == Outcome::loses_contact;
    const bool is_invalid = solution.model != Model::contact && validity == Validity::invalid;
    const double until =
        is_invalid && first != Outcome::edge ? valid_until(scene, solution) : infinity;
    if (until < infinity) {
        return {name(ends ? first : after_rolling(scene, until)) + "_at", {{"t", until}}};
    }
    return {name(first) + (ends ? "_later" : "_now"), {}};
}

}  // namespace

Start::Start(const Scene& scene)
    : InitialState(initial_state(scene)), next(first_continuation(scene, state)) {}

Description describe(const Scene& scene, const Solution& solution, const Checkpoint& checkpoint) {
    const Events& all = solution.motion.events;
    const auto blow = std::find_if(
        all.begin(), all.end(), [](const Event& event) { return event.kind == EventKind::blow; });
    const Events events(all.begin(), blow);  // the description is of the motion up to a blow
    Start start(scene);
    Description found{{}, {}, {effect_of(scene, start)}};
    Scene ground = scene;
    double landed = 0.0;
    const bool flies = !start.touching;
    const Event* const landing = flies ? landing_of(events) : nullptr;
    if (landing != nullptr) {
        landed = landing->t;
        found.headline.push_back({"lands", {{"t", landed}}});
        ground = reached(scene, landing->after.state);
        start = Start(ground);
    }
    append(found.reasons, surprise(ground, start));
    const bool jams = start.next.paradox != Painleve::determined;
    const bool resisted = scene.rolling_resistance > 0;
    if (flies && landing == nullptr) {
        found.headline.push_back({events.empty() ? "flies_on" : "bounces", {}});
    } else if (resisted && !jams) {
        append(found.headline, course_of(scene, events, start, landed));
    } else {
        const Outcome first = resisted ? Outcome::jams : outcome(ground, checkpoint);
        if (!resisted) found.first = first;
        if (start.holds()) {
            const Certificate proof = certify(ground);
            found.headline.push_back(
                end_of_rolling(scene, solution, events, first, landed, proof.end.validity));
            append(found.reasons, proof_of_rolling(ground, start, proof));
        } else {
            found.headline.push_back({name(first) + (flies ? "_then" : "_now"), {}});
        }
    }
    if (blow != all.end()) found.reasons.push_back({"until_the_blow", {{"t", blow->t}}});
    const Ending ending = solution.ending;
    const double end = solution.followed_until;
    const bool is_early = ending != Ending::completed && ending != Ending::validity_lost;
    if (is_early && (!jams || end > landed)) {
        found.reasons.push_back({name(ending) + "_at", {{"t", end}}});
    }
    return found;
}

std::optional<Outcome> outcome_after_landing(const Scene& scene, const Solution& solution,
                                             const Checkpoint& checkpoint) {
    const Event* const landing = landing_of(solution.motion.events);
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
