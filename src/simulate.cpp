#include "simulate.hpp"

#include <stdexcept>

#include "proof/slope.hpp"
#include "proof/watch.hpp"
#include "reason.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

// What "auto" stands for: no more model than the scene needs.
Settings chosen(Settings settings, Validity validity) {
    if (settings.model == Model::automatic) {
        const bool fixed = settings.method != Method::automatic;  // asks for rolling, solved so
        settings.model = fixed || validity == Validity::valid ? Model::rolling : Model::contact;
    }
    if (settings.method == Method::automatic) {
        settings.method = settings.model == Model::rolling ? Method::exact : Method::dop853;
    }
    return settings;
}

// What is said of rolling, for the model that has the same motion in more coordinates.
std::string in_coordinates(const std::string& reason) { return "multipliers, " + reason; }
std::string in_contact(const std::string& reason) { return "contact (" + reason + ")"; }

void end_validity(double t, double t_end, Solution& solution) {
    solution.valid_until = t;
    if (solution.ending == Ending::completed && t < t_end) {
        solution.ending = Ending::validity_lost;
        solution.message = why_ended(Ending::validity_lost, {}, t, t_end);
    }
}

// The certificate knows for how long rolling is true.
void judge_by_proof(const CertifiedScene& certified, double t_end, Solution& solution) {
    const EndOfRolling& end = certified.certificate.end;
    solution.reason = certified.reason;
    if (!end.angle) return;
    if (certified.on_slope) return end_validity(certified.ends_after, t_end, solution);
    const auto* flow = std::get_if<RollingFlow>(&solution.motion.segments.front().law);
    const double ends = time_of_end(flow ? *flow : rolling_flow(*certified.rolling), end);
    end_validity(ends, t_end, solution);
}

// Where the constraints may be broken, the motion has to be watched.
void judge_by_watch(const Scene& scene, double t_end, const Checkpoint& checkpoint,
                    Solution& solution) {
    const std::vector<double> knots = knot_times(solution.motion);
    const Sampler sampler(solution.motion, solution.followed_until, knots.size());
    std::vector<ContactSample> samples;
    const auto forces = [&](const double* times, std::size_t n, ContactForce* found) {
        samples.resize(n);
        sampler(times, n, samples.data());
        for (std::size_t i = 0; i < n; ++i) found[i] = samples[i].force;
    };
    const ContactWatch watch = watch_contact(scene.friction, knots, forces, checkpoint);
    solution.reason = reason(scene, watch);
    end_validity(watch.holds_until, t_end, solution);
}

Solution exact_rolling(const Scene& scene, const CertifiedScene& certified, double t_end) {
    Solution solution{single(scene, Resting{certified.start.state})};
    auto& law = solution.motion.segments.front().law;
    if (certified.on_slope) {
        SlopeFlow flow = *certified.on_slope;
        prepare(flow, t_end);
        validate_time(t_end, longest_time(flow));
        law = std::move(flow);
    } else {
        const RollingFlow flow = rolling_flow(*certified.rolling, certified.start.state.x);
        validate_time(t_end, longest_time(flow));
        law = flow;
    }
    solution.followed_until = t_end;
    return solution;
}

template <class Law>
Integration<Motion> as_motion(const Scene& scene, Integration<Law> found) {
    return {single(scene, std::move(found.motion)), found.ending, found.followed_until,
            found.counts};
}

Solution integrated(Integration<Motion> found, const Settings& settings, double t_end) {
    Solution solution{std::move(found.motion), settings.model, settings.method};
    solution.counts = found.counts;
    solution.ending = found.ending;
    solution.followed_until = found.followed_until;
    solution.message = why_ended(found.ending, settings, found.followed_until, t_end);
    return solution;
}

Solution solved(const Scene& scene, const CertifiedScene& certified, const Settings& settings,
                double t_end, const Checkpoint& checkpoint) {
    const State& start = certified.start.state;
    if (settings.model == Model::contact) {
        return integrated(
            integrate_contact(scene, start, certified.certificate.end, settings, t_end, checkpoint),
            settings, t_end);
    }
    if (!rolls(start)) {
        throw std::invalid_argument("model '" + name(settings.model) +
                                    "' must start rolling, but " + why_not_rolling(scene, start));
    }
    if (settings.method == Method::exact) return exact_rolling(scene, certified, t_end);
    if (settings.model == Model::multipliers) {
        const CoordinateStart from = coordinate_start(scene, start);
        return integrated(
            as_motion(scene, integrate_multipliers(scene, from, settings, t_end, checkpoint)),
            settings, t_end);
    }
    return integrated(
        as_motion(scene, integrate_rolling(scene, start, settings, t_end, checkpoint)), settings,
        t_end);
}

}  // namespace

CertifiedScene certify(const Scene& scene) {
    CertifiedScene result{
        initial_state(scene), {}, {}, infinity, {{Validity::no_proof}, {}, {}, {}, {}}, {}};
    const State& start = result.start.state;
    validate_motion(scene.body(), start.theta, start.omega);
    validate_velocity(scene.body(), start.x_dot, start.z_dot);
    if (rolls(start) && scene.slope != 0) {
        SlopeFlow flow = slope_flow(scene.body(), scene.slope, start.theta, start.omega, start.x);
        const LawMeetings met = law_meetings(flow, scene.friction);
        if (const auto& end = met.touched ? met.touched : met.broken) result.ends_after = end->time;
        result.certificate = certify_on_slope(scene, start, met);
        result.on_slope = std::move(flow);
    } else if (rolls(start)) {
        result.rolling = rolling_start(scene.body(), start.theta, start.omega);
        result.certificate = certify_rolling(*result.rolling, scene.mass, scene.friction);
    }
    result.reason = reason(scene, start, result.certificate);
    return result;
}

Solution simulate(const Scene& scene, const Settings& asked, double t_end,
                  const Checkpoint& checkpoint) {
    validate(asked, t_end);
    const CertifiedScene certified = certify(scene);
    const Settings settings = chosen(asked, certified.certificate.end.validity);
    Solution solution = solved(scene, certified, settings, t_end, checkpoint);
    if (settings.model == Model::contact) {
        solution.reason = in_contact(certified.reason);
        return solution;
    }
    if (certified.rolling || certified.on_slope) {
        judge_by_proof(certified, t_end, solution);
    } else {
        judge_by_watch(scene, t_end, checkpoint, solution);
    }
    if (settings.model == Model::multipliers) solution.reason = in_coordinates(solution.reason);
    return solution;
}

Solution simulate(const Scene& scene, const CoordinateState& start, const Settings& asked,
                  double t_end, const Checkpoint& checkpoint) {
    validate(asked, t_end);
    const Settings settings = chosen(asked, Validity::no_proof);
    const CoordinateStart from = coordinate_start(start);
    Solution solution = integrated(
        as_motion(scene, integrate_multipliers(scene, from, settings, t_end, checkpoint)), settings,
        t_end);
    judge_by_watch(scene, t_end, checkpoint, solution);
    solution.reason = in_coordinates(solution.reason);
    return solution;
}

double period(const Scene& scene) {
    CertifiedScene certified = certify(scene);
    if (certified.on_slope) {
        while (grow(*certified.on_slope)) continue;
        if (const auto found = period(*certified.on_slope)) return *found;
        throw std::invalid_argument("scene must repeat itself, but on a slope of " +
                                    brief(scene.slope) + " rad the body runs downhill for ever");
    }
    if (!certified.rolling) {
        throw std::invalid_argument("scene must start rolling, but " +
                                    why_not_rolling(scene, certified.start.state));
    }
    return period(rolling_flow(*certified.rolling));
}

}  // namespace rolling_ellipse
