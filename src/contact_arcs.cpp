#include "contact_arcs.hpp"

#include <algorithm>

namespace rolling_ellipse {
namespace {

// The state of an arc, by the time since its start.
void sample_arc(const SteppedSliding& motion, const double* times, std::size_t n, State* states) {
    sample(motion, times, n, states);
}

void store_rolling(const Axes& axes, const std::vector<FlowSample>& samples, State* states) {
    for (const auto& [theta, omega, x] : samples) {
        *states++ = in_contact(geometry(axes, theta), theta, omega, x, 0.0, Mode::rolling);
    }
}

void sample_arc(const SteppedRolling& motion, const double* times, std::size_t n, State* states) {
    std::vector<FlowSample> samples(n);
    sample(motion, times, n, samples.data());
    store_rolling(motion.axes, samples, states);
}

void sample_arc(const ExactRolling& rolling, const double* times, std::size_t n, State* states) {
    std::vector<FlowSample> samples(n);
    FlowSampler{rolling.flow, times[n - 1], n}(times, n, samples.data());
    store_rolling(rolling.axes, samples, states);
}

void sample_arc(const Flight& flight, const double* times, std::size_t n, State* states) {
    for (std::size_t i = 0; i < n; ++i) states[i] = state_at(flight, times[i]);
}

void sample_arc(const Settling& settling, const double* times, std::size_t n, State* states) {
    const auto& [axes, lasts, start, end] = settling;
    for (std::size_t i = 0; i < n; ++i) {
        const double share = times[i] / lasts;
        const auto between = [share](double from, double to) { return from + share * (to - from); };
        const double theta = between(start.theta, end.theta);
        states[i] = {theta,
                     between(start.omega, end.omega),
                     between(start.x, end.x),
                     geometry(axes, theta).h,
                     between(start.x_dot, end.x_dot),
                     between(start.z_dot, end.z_dot),
                     Mode::flight};
    }
}

void sample_arc(const Jam& jam, const double*, std::size_t n, State* states) {
    std::fill_n(states, n, jam.state);
}

void sample_arc(const Resting& resting, const double*, std::size_t n, State* states) {
    std::fill_n(states, n, resting.state);
}

// The force of the ground on the body, by the law of its arc.
ContactForce force_on(const Scene&, const SteppedSliding& motion, const State& state) {
    return motion.equation.force(state.theta, state.omega);
}

ContactForce force_on(const Scene&, const Flight&, const State&) { return {0.0, 0.0}; }

ContactForce force_on(const Scene&, const Settling&, const State&) { return {0.0, 0.0}; }

ContactForce force_on(const Scene&, const Jam&, const State&) { return {0.0, 0.0}; }

template <class Rolling>
ContactForce force_on(const Scene& scene, const Rolling&, const State& state) {
    return rolling_force(scene, state.theta, state.omega);
}

}  // namespace

void sample(const ContactMotion& motion, const double* times, std::size_t n,
            ContactSample* samples) {
    std::vector<double> since;
    std::vector<State> states;
    for (std::size_t i = 0; i < n;) {
        // The last arc that has begun at times[i], and all that follow in it.
        const auto later =
            std::upper_bound(motion.arcs.begin(), motion.arcs.end(), times[i],
                             [](double t, const ContactArc& arc) { return t < arc.t0; });
        const ContactArc& arc = *(later - 1);
        since.clear();
        for (std::size_t j = i;
             j < n && times[j] >= arc.t0 && (later == motion.arcs.end() || times[j] < later->t0);
             ++j) {
            since.push_back(times[j] - arc.t0);
        }
        states.resize(since.size());
        std::visit(
            [&](const auto& of) {
                sample_arc(of, since.data(), since.size(), states.data());
                for (const State& state : states) {
                    samples[i++] = {state, force_on(motion.scene, of, state)};
                }
            },
            arc.motion);
    }
}

}  // namespace rolling_ellipse
