#include "simulate.hpp"

#include <stdexcept>

#include "reason.hpp"

namespace rolling_ellipse {
namespace {

double end_of_validity(const RollingFlow& flow, const Certificate& certificate) {
    if (!certificate.ends_at) return infinity;
    if (*certificate.ends_at == flow.theta) return 0.0;
    return time_of_passing(flow, *certificate.ends_at, certificate.ends_heading);
}

}  // namespace

CertifiedScene certify(const Scene& scene) {
    CertifiedScene result;
    result.start = initial_state(scene);
    const State& start = result.start.state;
    validate_motion(scene.body(), start.theta, start.omega);
    if (why_not_rolling(scene, start).empty()) {
        result.certificate =
            certify_rolling(scene.body(), scene.mass, scene.friction, start.theta, start.omega);
    } else {
        result.certificate = {Validity::no_proof, {}, {}, {}, {}, {}, 0.0};
    }
    result.reason = reason(scene, start, result.certificate);
    return result;
}

Solution simulate(const Scene& scene, Model model, double t_end) {
    const CertifiedScene certified = certify(scene);
    const State& start = certified.start.state;
    Solution solution;
    solution.reason = certified.reason;

    if (certified.certificate.validity == Validity::no_proof) {
        const std::string obstacle = why_not_rolling(scene, start);
        if (model == Model::rolling) {
            throw std::invalid_argument(
                "model 'rolling' with method 'exact' must start rolling on level ground, but " +
                obstacle);
        }
        solution.status = Status::validity_lost;
        solution.valid_until = 0.0;
        solution.message = "no model here follows this motion: " + obstacle;
        return solution;
    }

    const RollingFlow flow = rolling_flow(scene.body(), start.theta, start.omega, start.x);
    solution.segments.push_back({start.mode, 0.0, t_end, flow});
    solution.followed_until = t_end;
    solution.valid_until = end_of_validity(flow, certified.certificate);
    if (solution.valid_until < t_end) {
        solution.status = Status::validity_lost;
        solution.message = "rolling is true until t = " + brief(solution.valid_until) +
                           " s only; what follows obeys the rolling equation, not the ground";
    }
    return solution;
}

double period(const Scene& scene) {
    const CertifiedScene certified = certify(scene);
    const State& start = certified.start.state;
    const std::string obstacle = why_not_rolling(scene, start);
    if (!obstacle.empty()) {
        throw std::invalid_argument("scene must start rolling on level ground, but " + obstacle);
    }
    return period(rolling_flow(scene.body(), start.theta, start.omega, start.x));
}

}  // namespace rolling_ellipse
