#include "simulate.hpp"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace rolling_ellipse {
namespace {

std::string brief(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", value);
    return buffer;
}

std::string in_degrees(double angle) { return brief(angle * 180 / pi) + " deg"; }

// Why the exact rolling motion does not describe this scene at all; empty where it does.
std::string why_not_rolling(const Scene& scene, const State& start) {
    if (scene.slope != 0) return "the ground has a slope of " + brief(scene.slope) + " rad";
    if (start.mode == Mode::flight) return "the body is in the air";
    if (start.mode == Mode::sliding) {
        return "the body slides with " +
               brief(start.x_dot - geometry({scene.a, scene.b}, start.theta).h * start.omega) +
               " m/s at the contact";
    }
    return {};
}

std::string sentence(const Scene& scene, const State& start, const Certificate& c) {
    if (c.validity == Validity::no_proof) {
        return "rolling: nothing to prove, " + why_not_rolling(scene, start);
    }
    const std::string extremes = "the smallest N is " + brief(*c.smallest_normal_force) +
                                 " N (theta = " + in_degrees(*c.smallest_normal_force_angle) +
                                 "), the largest |F|/N " + brief(*c.largest_friction_needed) +
                                 " (theta = " + in_degrees(*c.largest_friction_needed_angle) +
                                 "), the friction coefficient " + brief(scene.friction);
    switch (c.validity) {
        case Validity::valid:
            return (start.mode == Mode::rest ? "rest: in equilibrium, "
                                             : "rolling: proved valid for the whole motion, ") +
                   extremes;
        case Validity::edge:
            return "rolling: on the edge of its validity at theta = " + brief(*c.ends_at) +
                   " rad, closer than rounding can tell; " + extremes;
        default:
            break;
    }
    const bool at_once = *c.ends_at == start.theta;
    const std::string what = std::isinf(scene.friction) ? "N would have to pull"
                                                        : "it would need more than the friction";
    return (at_once ? "rolling: cannot start at theta = " : "rolling: ends at theta = ") +
           brief(*c.ends_at) + " rad, where " + what + "; on the whole motion " + extremes;
}

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
    if (why_not_rolling(scene, start).empty()) {
        result.certificate =
            certify_rolling(scene.body(), scene.mass, scene.friction, start.theta, start.omega);
    } else {
        result.certificate = {Validity::no_proof, {}, {}, {}, {}, {}, 0.0};
    }
    result.reason = sentence(scene, start, result.certificate);
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
