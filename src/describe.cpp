#include "describe.hpp"

#include <algorithm>
#include <cmath>

namespace rolling_ellipse {
namespace {

// The start of a scene and the motion that the forces allow after it.
struct Start : InitialState {
    explicit Start(const Scene& scene)
        : InitialState(initial_state(scene)), next(first_continuation(scene, state)) {}

    bool holds() const { return next.mode == Mode::rolling || next.mode == Mode::rest; }

    Continuation next;
};

Sentence effect_of(const Scene& scene, const Start& start) {
    const std::pair along{"along", start.reaction_x}, up{"up", start.reaction_z};
    if (start.slip_removed != 0) return {"stopped", {along, up, {"energy", start.energy_lost}}};
    if (!scene.impulse) return {"no_blow"};
    if (!start.touching) return {"in_the_air"};
    if (start.state.mode == Mode::flight) return {"thrown"};
    if (start.state.mode != Mode::sliding)
        return {"sticks", {along, up, {"omega", start.free_omega}}};
    if (std::isinf(scene.friction)) return {"lifted", {along, up}};
    return {"slides_off", {along, up, {"mu", scene.friction}}};
}

// Why the motion is not the one that the velocities of the start suggest; none if it is.
std::optional<Sentence> surprise(const Scene& scene, const Start& start) {
    const Continuation& next = start.next;
    if (next.may_fly) return Sentence{"wedged"};
    if (next.paradox == Painleve::no_motion) return Sentence{"no_motion"};
    if (next.paradox == Painleve::two_motions) return Sentence{"two_motions"};
    if (next.mode == start.state.mode || next.mode == Mode::rest) return {};
    if (next.mode != Mode::sliding || std::isinf(scene.friction)) return Sentence{"pulled"};
    return Sentence{"no_grip", {{"mu", scene.friction}}};
}

void add_surprise(Sentences& to, const Scene& scene, const Start& start) {
    if (const auto sentence = surprise(scene, start)) to.push_back(*sentence);
}

Sentence proof_of(const Scene& scene, const Start& start, const Certificate& proof) {
    const auto in_degrees = [](double angle) {
        return std::pair{"angle", angle == 0 ? 0.0 : angle * (180 / pi)};
    };
    if (proof.end.angle) {
        const auto angle = in_degrees(*proof.end.angle);
        if (proof.end.validity == Validity::edge) return {"on_edge", {angle}};
        if (std::isinf(scene.friction)) return {"ends_pull", {angle}};
        return {"ends_grip", {angle, {"mu", scene.friction}}};
    }
    const auto& normal = proof.smallest_normal_force;
    const auto& needed = proof.largest_friction_needed;
    if (start.next.mode == Mode::rest) return {"stays", {{"N", *normal}, {"ratio", *needed}}};
    const auto& angle = proof.smallest_normal_force_angle;
    if (!angle || proof.end.validity != Validity::valid || *needed == infinity) return {"rolls"};
    return {"proved", {{"N", *normal}, in_degrees(*angle), {"ratio", *needed}}};
}

// What is proved of rolling, by which friction, and the friction that the blow needs.
void add_proof(Sentences& to, const Scene& scene, const Start& start, const Certificate& proof) {
    to.push_back(proof_of(scene, start, proof));
    if (to.back().key != "ends_grip") {
        to.push_back(std::isinf(scene.friction) ? Sentence{"unlimited"}
                                                : Sentence{"friction", {{"mu", scene.friction}}});
    }
    if (effect_of(scene, start).key != "sticks") return;
    const double needed = sticking_friction(scene);
    if (needed > 0 && needed < infinity) to.push_back({"blow_needs", {{"needed", needed}}});
}

// The scene that continues on the ground after an event.
Scene scene_after(Scene scene, const State& state) {
    scene.impulse.reset();
    for (auto* number : {&scene.z, &scene.x_dot, &scene.z_dot}) number->reset();
    if (state.mode == Mode::sliding) scene.x_dot = state.x_dot;
    scene.theta = state.theta;
    scene.omega = state.omega;
    scene.x = state.x;
    return scene;
}

// The outcome of rolling that an event brings.
std::optional<Outcome> outcome_of(EventKind kind) {
    if (kind == EventKind::slip) return Outcome::slips;
    if (kind == EventKind::lift_off) return Outcome::loses_contact;
    if (kind == EventKind::jam) return Outcome::jams;
    return {};
}

// How the rolling of the scene ends that began at a time, and when, if the motion shows it.
Sentence end_of_rolling(const Scene& scene, const Solution& solution, Outcome first, double begin) {
    for (const Event& each : solution.motion.events) {
        const auto end = outcome_of(each.kind);
        if (!end || each.t <= begin) continue;
        return {name(first == Outcome::jams ? first : *end) + "_at", {{"t", each.t}}};
    }
    const bool ends =
        first == Outcome::slips || first == Outcome::loses_contact || first == Outcome::jams;
    if (solution.model != Model::contact && first != Outcome::edge) {
        const double until = valid_until(scene, solution);
        if (until < infinity) return {name(ends ? first : Outcome::slips) + "_at", {{"t", until}}};
    }
    return {name(first) + (ends ? "_later" : "_now")};
}

const char* key_of_early_end(Ending ending) {
    if (ending == Ending::jammed) return "jammed";
    return ending == Ending::undetermined ? "undetermined" : "given_up";
}

}  // namespace

Description describe(const Scene& scene, const Solution& solution, const Checkpoint& checkpoint) {
    const std::vector<Event>& events = solution.motion.events;
    Start start(scene);
    Description found{{}, {}, effect_of(scene, start), {}};
    Scene ground = scene;
    double landed = 0.0;
    const bool flies = !start.touching;
    if (flies) {
        const auto landing = std::find_if(events.begin(), events.end(), [](const Event& each) {
            return each.after.mode != Mode::flight;
        });
        if (landing == events.end()) {
            found.headline.push_back({events.empty() ? "flies_on" : "bounces"});
            return found;
        }
        landed = landing->t;
        found.headline.push_back({"lands", {{"t", landed}}});
        ground = scene_after(scene, landing->after);
        start = Start(ground);
    }
    const Outcome first = outcome(ground, checkpoint);
    found.first = first;
    add_surprise(found.reasons, ground, start);
    if (start.holds()) {
        found.headline.push_back(end_of_rolling(scene, solution, first, landed));
        add_proof(found.reasons, ground, start, certify(ground));
    } else {
        found.headline.push_back({name(first) + (flies ? "_then" : "_now")});
    }
    const Ending ending = solution.ending;
    const double end = solution.followed_until;
    const bool is_early = ending != Ending::completed && ending != Ending::validity_lost;
    if (is_early && (first != Outcome::jams || end > landed)) {
        found.reasons.push_back({key_of_early_end(ending), {{"t", end}}});
    }
    return found;
}

Sentences describe_start(const Scene& scene) {
    const Start start(scene);
    Sentences found{effect_of(scene, start)};
    add_surprise(found, scene, start);
    // Of a paradox the surprise has described the motion.
    if (!start.next.may_fly && start.next.paradox == Painleve::determined) {
        found.push_back({name(start.next.mode) + "_starts"});
    }
    return found;
}

Sentences describe_proof(const Scene& scene) {
    const Start start(scene);
    const Certificate proof = certify(scene);
    Sentences found{effect_of(scene, start)};
    if (found.back().key != "stopped") found.clear();
    if (proof.end.validity == Validity::no_proof) {
        found.push_back({"no_proof"});
        return found;
    }
    if (!start.holds()) found.push_back({"cannot_start"});
    add_surprise(found, scene, start);
    if (start.holds()) add_proof(found, scene, start, proof);
    return found;
}

}  // namespace rolling_ellipse
