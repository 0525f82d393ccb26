#include "simulate.hpp"

#include <stdexcept>

#include "proof/watch.hpp"
#include "reason.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

// What "auto" stands for: no more model than the scene needs.
Settings chosen(Settings settings, const Scene& scene, Validity validity) {
    if (settings.model == Model::automatic) {
        const bool fixed = settings.method != Method::automatic;  // asks for rolling, solved so
        settings.model = fixed || validity == Validity::valid ? Model::rolling : Model::contact;
    }
    if (settings.method == Method::exact && scene.slope != 0) {
        refuse("slope", "0 for method 'exact'", scene.slope);
    }
    if (settings.method == Method::automatic) {
        const bool exact = settings.model == Model::rolling && scene.slope == 0;
        settings.method = exact ? Method::exact : Method::dop853;
    }
    return settings;
}

// What is said of rolling, for the model that has the same motion in more coordinates.
std::string in_coordinates(const std::string& reason) { return "multipliers, " + reason; }
std::string in_contact(const std::string& reason) { return "contact (" + reason + ")"; }

Status status(Ending ending) {
    switch (ending) {
        case Ending::reached:
        case Ending::stopped:
            return Status::completed;
        case Ending::max_steps:
            return Status::max_steps;
        case Ending::step_too_small:
            return Status::step_too_small;
        case Ending::step_too_large:
            return Status::step_too_large;
    }
    return Status::completed;
}

void end_validity(double t, double t_end, Solution& solution) {
    solution.valid_until = t;
    if (solution.status == Status::completed && t < t_end) {
        solution.status = Status::validity_lost;
        solution.message = rolling_ends(t);
    }
}

// On level ground the certificate knows for how long rolling is true.
void judge_by_proof(const Scene& scene, const CertifiedScene& certified, double t_end,
                    Solution& solution) {
    const State& start = certified.start.state;
    const EndOfRolling& end = certified.certificate.end;
    solution.reason = certified.reason;
    if (!end.angle) return;
    const RollingFlow flow = rolling_flow(scene.body(), start.theta, start.omega, start.x);
    end_validity(time_of_end(flow, end), t_end, solution);
}

// On a slope, and where the constraints may be broken, the motion has to be watched.
void judge_by_watch(const Scene& scene, const Settings& settings, double t_end,
                    const Checkpoint& checkpoint, Solution& solution) {
    const auto forces = [&](const double* times, std::size_t n, ContactForce* found) {
        contact_forces(solution, scene, settings, times, n, found);
    };
    const ContactWatch watch =
        watch_contact(scene.friction, knot_times(solution), forces, checkpoint);
    solution.reason = reason(scene, watch);
    end_validity(watch.holds_until, t_end, solution);
}

Solution exact_rolling(const Scene& scene, const State& start, double t_end) {
    const RollingFlow flow = rolling_flow(scene.body(), start.theta, start.omega, start.x);
    validate_time(t_end, longest_time(flow));
    Solution solution{flow};
    solution.followed_until = t_end;
    return solution;
}

template <class Integration>
Solution stepped(Integration integration, const Settings& settings, double t_end) {
    Solution solution{std::move(integration.motion), settings.model, settings.method};
    solution.counts = integration.counts;
    solution.status = status(integration.ending);
    solution.followed_until =
        integration.ending == Ending::reached ? t_end : knot_times(solution).back();
    solution.message = why_stopped(integration.ending, settings, solution.followed_until, t_end);
    return solution;
}

Status status(ContactEnding ending) {
    switch (ending) {
        case ContactEnding::reached:
            return Status::completed;
        case ContactEnding::jammed:
        case ContactEnding::undetermined:
            return Status::jammed;
        case ContactEnding::max_events:
            return Status::max_events;
        case ContactEnding::max_steps:
            return Status::max_steps;
        case ContactEnding::step_too_small:
            return Status::step_too_small;
    }
    return Status::completed;
}

Solution contact(const Scene& scene, const CertifiedScene& certified, const Settings& settings,
                 double t_end, const Checkpoint& checkpoint) {
    ContactIntegration found =
        integrate_contact(scene, certified.start.state, settings, t_end, checkpoint);
    Solution solution{std::move(found.motion), settings.model, settings.method};
    solution.counts = found.counts;
    solution.status = status(found.ending);
    solution.followed_until = found.ending == ContactEnding::reached ? t_end : found.reached_until;
    solution.message = why_stopped(found.ending, settings, solution.followed_until, t_end);
    solution.reason = in_contact(certified.reason);
    return solution;
}

}  // namespace

CertifiedScene certify(const Scene& scene) {
    CertifiedScene result;
    result.start = initial_state(scene);
    const State& start = result.start.state;
    validate_motion(scene.body(), start.theta, start.omega);
    validate_velocity(scene.body(), start.x_dot, start.z_dot);
    if (why_no_proof(scene, start).empty()) {
        result.certificate =
            certify_rolling(scene.body(), scene.mass, scene.friction, start.theta, start.omega);
    } else {
        result.certificate = {{Validity::no_proof}, {}, {}, {}, {}};
    }
    result.reason = reason(scene, start, result.certificate);
    return result;
}

Solution simulate(const Scene& scene, const Settings& asked, double t_end,
                  const Checkpoint& checkpoint) {
    validate(asked, t_end);
    const CertifiedScene certified = certify(scene);
    const Settings settings = chosen(asked, scene, certified.certificate.end.validity);
    const State& start = certified.start.state;
    if (settings.model == Model::contact) {
        return contact(scene, certified, settings, t_end, checkpoint);
    }
    if (const std::string obstacle = why_not_rolling(scene, start); !obstacle.empty()) {
        throw std::invalid_argument("model '" + name(settings.model) +
                                    "' must start rolling, but " + obstacle);
    }
    Solution solution = [&] {
        if (settings.method == Method::exact) return exact_rolling(scene, start, t_end);
        if (settings.model == Model::multipliers) {
            return stepped(integrate_multipliers(scene, coordinate_start(scene, start), settings,
                                                 t_end, checkpoint),
                           settings, t_end);
        }
        return stepped(integrate_rolling(scene, start, settings, t_end, checkpoint), settings,
                       t_end);
    }();
    if (scene.slope == 0) {
        judge_by_proof(scene, certified, t_end, solution);
    } else {
        judge_by_watch(scene, settings, t_end, checkpoint, solution);
    }
    if (settings.model == Model::multipliers) solution.reason = in_coordinates(solution.reason);
    return solution;
}

Solution simulate(const Scene& scene, const CoordinateState& start, const Settings& asked,
                  double t_end, const Checkpoint& checkpoint) {
    validate(asked, t_end);
    const Settings settings = chosen(asked, scene, Validity::no_proof);
    Solution solution =
        stepped(integrate_multipliers(scene, coordinate_start(start), settings, t_end, checkpoint),
                settings, t_end);
    judge_by_watch(scene, settings, t_end, checkpoint, solution);
    solution.reason = in_coordinates(solution.reason);
    return solution;
}

double period(const Scene& scene) {
    const CertifiedScene certified = certify(scene);
    const State& start = certified.start.state;
    const std::string obstacle = why_no_proof(scene, start);
    if (!obstacle.empty()) {
        throw std::invalid_argument("scene must start rolling on level ground, but " + obstacle);
    }
    return period(rolling_flow(scene.body(), start.theta, start.omega, start.x));
}

}  // namespace rolling_ellipse
