#include "simulate.hpp"

#include <stdexcept>

#include "contact_watch.hpp"
#include "reason.hpp"

namespace rolling_ellipse {
namespace {

Method chosen_method(const Scene& scene, const Settings& settings) {
    if (settings.method != Method::automatic) return settings.method;
    return scene.slope == 0 ? Method::exact : Method::dop853;
}

Status status(Ending ending) {
    switch (ending) {
        case Ending::reached:
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

double end_of_validity(const RollingFlow& flow, const Certificate& certificate) {
    if (!certificate.ends_at) return infinity;
    if (*certificate.ends_at == flow.theta) return 0.0;
    return time_of_passing(flow, *certificate.ends_at, certificate.ends_heading);
}

// On level ground the certificate knows, on a slope the motion has to be watched.
void judge_validity(const Scene& scene, const CertifiedScene& certified, double t_end,
                    const Checkpoint& checkpoint, Solution& solution) {
    const State& start = certified.start.state;
    if (scene.slope == 0) {
        const RollingFlow flow = rolling_flow(scene.body(), start.theta, start.omega, start.x);
        solution.valid_until = end_of_validity(flow, certified.certificate);
        solution.reason = certified.reason;
    } else {
        const ContactWatch watch = watch_contact(
            scene, std::get<SteppedRolling>(solution.segments.front().motion), checkpoint);
        solution.valid_until = watch.holds_until;
        solution.reason = reason(scene, watch);
    }
    if (solution.status == Status::completed && solution.valid_until < t_end) {
        solution.status = Status::validity_lost;
        solution.message = rolling_ends(solution.valid_until);
    }
}

Solution exact_rolling(const Scene& scene, const State& start, double t_end) {
    const RollingFlow flow = rolling_flow(scene.body(), start.theta, start.omega, start.x);
    if (t_end > longest_time(flow)) {
        refuse("t", "at most 1e15 half turns or swings, " + text(longest_time(flow)) + " [s]",
               t_end);
    }
    Solution solution;
    solution.segments.push_back({start.mode, 0.0, t_end, flow});
    solution.followed_until = t_end;
    return solution;
}

Solution stepped_rolling(const Scene& scene, const State& start, const Settings& settings,
                         double t_end, const Checkpoint& checkpoint) {
    RollingIntegration integration = integrate_rolling(scene, start, settings, t_end, checkpoint);
    Solution solution;
    solution.method = integration.motion.method;
    solution.counts = integration.counts;
    solution.followed_until = integration.motion.knots.back().t;
    solution.status = status(integration.ending);
    solution.message = why_stopped(integration, settings, t_end);
    solution.segments.push_back(
        {start.mode, 0.0, solution.followed_until, std::move(integration.motion)});
    return solution;
}

Solution not_followed(const CertifiedScene& certified, const std::string& obstacle) {
    Solution solution;
    solution.status = Status::validity_lost;
    solution.valid_until = 0.0;
    solution.reason = certified.reason;
    solution.message = "no model here follows this motion: " + obstacle;
    return solution;
}

}  // namespace

CertifiedScene certify(const Scene& scene) {
    CertifiedScene result;
    result.start = initial_state(scene);
    const State& start = result.start.state;
    validate_motion(scene.body(), start.theta, start.omega);
    if (why_no_proof(scene, start).empty()) {
        result.certificate =
            certify_rolling(scene.body(), scene.mass, scene.friction, start.theta, start.omega);
    } else {
        result.certificate = {Validity::no_proof, {}, {}, {}, {}, {}, 0.0};
    }
    result.reason = reason(scene, start, result.certificate);
    return result;
}

Solution simulate(const Scene& scene, const Settings& settings, double t_end,
                  const Checkpoint& checkpoint) {
    validate(settings, t_end);
    const CertifiedScene certified = certify(scene);
    const State& start = certified.start.state;
    const Method method = chosen_method(scene, settings);

    if (const std::string obstacle = why_not_rolling(scene, start); !obstacle.empty()) {
        if (settings.model == Model::automatic) return not_followed(certified, obstacle);
        throw std::invalid_argument("model 'rolling' must start rolling, but " + obstacle);
    }
    if (method == Method::exact && scene.slope != 0) {
        refuse("slope", "0 for method 'exact'", scene.slope);
    }
    Solution solution = method == Method::exact
                            ? exact_rolling(scene, start, t_end)
                            : stepped_rolling(scene, start, settings, t_end, checkpoint);
    judge_validity(scene, certified, t_end, checkpoint, solution);
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
