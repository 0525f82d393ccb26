#include "contact/arcs.hpp"

#include <algorithm>

namespace rolling_ellipse {
namespace {

// Samples of an arc by the time since its start.
void sample_arc(const Scene&, const SteppedSliding& motion, const double* times, std::size_t n,
                ContactSample* samples) {
    sample(motion, times, n, samples);
}

template <class Sampler>
void sample_rolling(const Scene& scene, const Sampler& sampler, const double* times, std::size_t n,
                    ContactSample* samples) {
    const RollingDynamics dynamics(scene);
    std::vector<FlowSample> states(n);
    sampler(times, n, states.data());
    for (const auto& [theta, omega, x] : states) {
        const Geometry at = geometry(scene.axes(), theta);
        *samples++ = {in_contact(at, theta, omega, x, 0.0, Mode::rolling),
                      dynamics.force(at, omega)};
    }
}

void sample_arc(const Scene& scene, const SteppedRolling& motion, const double* times,
                std::size_t n, ContactSample* samples) {
    const auto sampler = [&motion](const double* at, std::size_t count, FlowSample* states) {
        sample(motion, at, count, states);
    };
    sample_rolling(scene, sampler, times, n, samples);
}

void sample_arc(const Scene& scene, const ExactRolling& rolling, const double* times, std::size_t n,
                ContactSample* samples) {
    sample_rolling(scene, FlowSampler{rolling.flow, times[n - 1], n}, times, n, samples);
}

void sample_arc(const Scene&, const Flight& flight, const double* times, std::size_t n,
                ContactSample* samples) {
    for (std::size_t i = 0; i < n; ++i) samples[i] = {state_at(flight, times[i]), {0.0, 0.0}};
}

void sample_arc(const Scene&, const Settling& settling, const double* times, std::size_t n,
                ContactSample* samples) {
    const auto& [axes, lasts, start, end] = settling;
    for (std::size_t i = 0; i < n; ++i) {
        const double share = times[i] / lasts;
        const auto between = [share](double from, double to) { return from + share * (to - from); };
        const double theta = between(start.theta, end.theta);
        const State state{theta,
                          between(start.omega, end.omega),
                          between(start.x, end.x),
                          geometry(axes, theta).h,
                          between(start.x_dot, end.x_dot),
                          between(start.z_dot, end.z_dot),
                          Mode::flight};
        samples[i] = {state, {0.0, 0.0}};
    }
}

void sample_arc(const Scene&, const Jam& jam, const double*, std::size_t n,
                ContactSample* samples) {
    std::fill_n(samples, n, ContactSample{jam.state, {0.0, 0.0}});
}

void sample_arc(const Scene& scene, const Resting& resting, const double*, std::size_t n,
                ContactSample* samples) {
    const ContactForce force = rolling_force(scene, resting.state.theta, resting.state.omega);
    std::fill_n(samples, n, ContactSample{resting.state, force});
}

}  // namespace

void sample(const ContactMotion& motion, const double* times, std::size_t n,
            ContactSample* samples) {
    std::vector<double> since;
    for (std::size_t i = 0; i < n;) {
        // The last arc that has begun at the time i, and all that follow in it.
        const auto time = [&](std::size_t j) { return times[j] / motion.units.time; };
        const auto later =
            std::upper_bound(motion.arcs.begin(), motion.arcs.end(), time(i),
                             [](double t, const ContactArc& arc) { return t < arc.t0; });
        const ContactArc& arc = *(later - 1);
        const double end = later == motion.arcs.end() ? infinity : later->t0;
        since.clear();
        for (std::size_t j = i; j < n && time(j) >= arc.t0 && time(j) < end; ++j) {
            since.push_back(time(j) - arc.t0);
        }
        std::visit(
            [&](const auto& of) {
                sample_arc(motion.scene, of, since.data(), since.size(), samples + i);
            },
            arc.motion);
        for (const std::size_t last = i + since.size(); i < last; ++i) {
            samples[i] = in_si(samples[i], motion.units);
        }
    }
}

}  // namespace rolling_ellipse
