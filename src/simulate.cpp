#include "simulate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "proof/slope.hpp"

namespace rolling_ellipse {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Replaces the model "auto" with the simplest model that suffices for the scene, and the method
// "auto" with the default method of the model.
Settings chosen(Settings settings, Validity validity) {
    if (settings.model == Model::automatic) {
        const bool rolls = settings.method != Method::automatic;  // a named method implies rolling
        settings.model = rolls || validity == Validity::valid ? Model::rolling : Model::contact;
    }
    if (settings.method == Method::automatic) {
        const bool stepped = settings.model == Model::multipliers;
        settings.method = stepped ? Method::dop853 : Method::exact;
    }
    return settings;
}

// The initial state and, if the body rolls without resistance, its motion on level ground or on a
// slope.
struct Beginning {
    InitialState initial;
    std::optional<RollingStart> rolling;
    std::optional<SlopeFlow> on_slope;
};

Beginning beginning(const Scene& scene) {
    Beginning found{initial_state(scene), {}, {}};
    const State& start = found.initial.state;
    if (!rolls(start) || scene.rolling_resistance > 0) return found;
    if (scene.slope == 0) {
        found.rolling = rolling_start(scene.body(), start.theta, start.omega);
    } else {
        found.on_slope = slope_flow(scene.body(), scene.slope, start.theta, start.omega, start.x);
    }
    return found;
}

// The end of valid rolling. On a slope, the law of the contact is examined up to the time `until`,
// or without this bound if the motion touches the limit of the law. If rolling remains valid up to
// `until`, the time of its end is unknown (NaN).
EndOfRolling prove(const Scene& scene, Beginning& from, double until = infinity) {
    if (from.rolling) return end_of_rolling(*from.rolling, scene.friction);
    if (!from.on_slope) return {Validity::no_proof};
    LawMeetings met = law_meetings(*from.on_slope, scene.friction, until);
    if (met.touched) met = law_meetings(*from.on_slope, scene.friction);
    EndOfRolling end = end_of_rolling(met);
    if (!end.angle && until < infinity) end.time = unknown;
    return end;
}

// Whether it is clear without a proof that the contact model computes the motion. That model proves
// each arc of rolling itself, and only up to the end time.
bool is_proved_by_arcs(const Scene& scene, const Beginning& from, const Settings& asked) {
    if (asked.model == Model::contact || asked.is_for_events()) return true;
    return from.on_slope && asked.model == Model::automatic && asked.method == Method::automatic &&
           !may_hold_for_ever(scene, from.initial.state);
}

void end_validity(Validity validity, double t, double t_end, Solution& solution) {
    solution.valid_until = t;
    if (solution.ending == Ending::completed && t < t_end) {
        solution.ending = Ending::validity_lost;
        solution.message = why_invalid(validity, t);
    }
}

// Ends the validity of a computed rolling motion at the time that the proof gives.
void judge_by_proof(const Beginning& from, const EndOfRolling& end, double t_end,
                    Solution& solution) {
    if (std::isnan(end.time)) solution.valid_until = end.time;
    if (!end.angle) return;
    const auto* flow = std::get_if<Apart<RollingFlow>>(&solution.motion.segments.front().law);
    const double t =
        from.on_slope ? end.time : time_of_end(flow ? **flow : rolling_flow(*from.rolling), end);
    end_validity(end.validity, t, t_end, solution);
}

Integration<Motion> exact_rolling(const Scene& scene, const Beginning& from, double t_end) {
    if (from.on_slope) {
        SlopeFlow flow = *from.on_slope;
        prepare(flow, t_end);
        validate_time(t_end, longest_time(flow, t_end));
        return {single(scene, std::make_shared<const SlopeFlow>(std::move(flow))),
                Ending::completed, t_end};
    }
    const auto flow =
        std::make_shared<const RollingFlow>(rolling_flow(*from.rolling, from.initial.state.x));
    validate_time(t_end, longest_time(*flow));
    return {single(scene, flow), Ending::completed, t_end};
}

template <class Law>
Integration<Motion> as_motion(const Scene& scene, Integration<Law> result) {
    return {single(scene, std::move(result.motion)), result.ending, result.followed_until,
            result.counts};
}

Integration<Motion> solve(const Scene& scene, const Beginning& from, const Settings& settings,
                          double t_end, const Checkpoint& checkpoint) {
    const State& start = from.initial.state;
    if (settings.model == Model::contact) {
        return integrate_contact(scene, from.initial, settings, t_end, checkpoint);
    }
    require_no_resistance(scene, "model '" + name(settings.model) + "'", "model 'contact' has it");
    if (!rolls(start)) {
        throw std::invalid_argument("model '" + name(settings.model) +
                                    "' must start rolling, but " + why_not_rolling(scene, start));
    }
    if (settings.method == Method::exact) return exact_rolling(scene, from, t_end);
    if (settings.model == Model::multipliers) {
        return as_motion(scene, integrate_multipliers(scene, coordinate_start(scene, start),
                                                      settings, t_end, checkpoint));
    }
    return as_motion(scene, integrate_rolling(scene, start, settings, t_end, checkpoint));
}

// A message about blows that the motion did not reach; empty if there are none.
std::string what_is_missed(const std::vector<Blow>& blows, const std::vector<Event>& events) {
    const auto is_blow = [](const Event& event) { return event.kind == EventKind::blow; };
    const std::size_t struck = std::count_if(events.begin(), events.end(), is_blow);
    if (struck == blows.size()) return {};
    const std::string first = brief(blows[struck].t) + " s";
    return blows.size() - struck == 1 ? "; the blow at " + first + " was not reached"
                                      : "; the blows at " + first + " and later were not reached";
}

Solution solution(Integration<Motion> found, const Settings& settings, double t_end) {
    Solution solution{std::move(found), settings.model, settings.method};
    solution.message = why_ended(solution.ending, settings, solution.followed_until, t_end);
    solution.message += what_is_missed(settings.blows, solution.motion.events);
    return solution;
}

// Raises the maximum to a larger value; NaN counts as infinite.
void raise(double& maximum, double value) {
    if (!(value <= maximum)) maximum = std::isnan(value) ? infinity : value;
}

Losses losses_in(const std::vector<Invariants>& points) {
    const double start = points.front().energy.total();
    Losses worst;
    double size = 0.0;
    for (const auto& [energy, residual] : points) {
        size = std::max(size, energy.kinetic + std::abs(energy.potential));
        raise(worst.energy, std::abs(energy.total() - start));
        raise(worst.constraints, residual);
    }
    worst.energy /= size;
    return worst;
}

}  // namespace

Certificate certify(const Scene& scene) {
    Beginning from = beginning(scene);
    if (from.rolling) return certify_rolling(*from.rolling, scene.mass, scene.friction);
    if (!from.on_slope) return {{Validity::no_proof}, {}, {}, {}, {}};
    const LawMeetings met = law_meetings(*from.on_slope, scene.friction);
    return certify_on_slope(scene, from.initial.state, end_of_rolling(met));
}

Solution simulate(const Scene& scene, const Settings& asked, double t_end,
                  const Checkpoint& checkpoint) {
    validate(asked, t_end);
    Beginning from = beginning(scene);
    const bool chooses = asked.model == Model::automatic && asked.method == Method::automatic;
    const EndOfRolling end = is_proved_by_arcs(scene, from, asked)
                                 ? EndOfRolling{Validity::no_proof}
                                 : prove(scene, from, chooses ? infinity : t_end);
    const Settings settings = chosen(asked, end.validity);
    Solution result = solution(solve(scene, from, settings, t_end, checkpoint), settings, t_end);
    if (settings.model != Model::contact) {
        judge_by_proof(from, end, t_end, result);
        const State& start = from.initial.state;
        result.motion.rests =
            start.mode == Mode::rest && first_continuation(scene, start).mode == Mode::rest;
    }
    return result;
}

Solution simulate(const Scene& scene, const CoordinateState& start, const Settings& asked,
                  double t_end, const Checkpoint& checkpoint) {
    validate(asked, t_end);
    const Settings settings = chosen(asked, Validity::no_proof);
    Solution result =
        solution(as_motion(scene, integrate_multipliers(scene, coordinate_start(start), settings,
                                                        t_end, checkpoint)),
                 settings, t_end);
    end_validity(Validity::no_proof, 0.0, t_end, result);
    return result;
}

double valid_until(const Scene& scene, const Solution& solution) {
    if (!std::isnan(solution.valid_until)) return solution.valid_until;
    Beginning from = beginning(scene);
    return prove(scene, from).time;
}

std::optional<Losses> losses(const Solution& solution) {
    if (solution.motion.segments.empty()) return {};
    const auto& law = solution.motion.segments.front().law;
    const long evaluations = solution.counts.evaluations;
    if (const auto* rolling = std::get_if<SteppedRolling>(&law)) {
        return losses_in(invariants(*rolling, evaluations));
    }
    if (const auto* multipliers = std::get_if<SteppedMultipliers>(&law)) {
        Losses found = losses_in(invariants(*multipliers, evaluations));
        found.projected = multipliers->most_projected;
        return found;
    }
    return {};
}

double period(const Scene& scene) {
    require_no_resistance(scene, "a period", "the body comes to rest: see events");
    Beginning from = beginning(scene);
    if (from.rolling) return period(rolling_flow(*from.rolling));
    if (!from.on_slope) {
        throw std::invalid_argument("scene must start rolling, but " +
                                    why_not_rolling(scene, from.initial.state));
    }
    while (grow(*from.on_slope)) continue;
    if (const auto found = period(*from.on_slope)) return *found;
    throw std::invalid_argument("scene must repeat itself, but on a slope of " +
                                brief(scene.slope) + " rad the body runs downhill for ever");
}

}  // namespace rolling_ellipse
