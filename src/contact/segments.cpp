#include "contact/segments.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

namespace rolling_ellipse {
namespace {

// The type of sample that a law computes directly; `convert` derives the other types from it.
template <class Law>
using OwnSample = std::conditional_t<
    std::is_same_v<Law, SteppedMultipliers>, CoordinateState,
    std::conditional_t<std::is_same_v<Law, RollingFlow> || std::is_same_v<Law, SlopeFlow> ||
                           std::is_same_v<Law, SteppedRolling>,
                       FlowSample, ContactSample>>;

// These functions sample a law at times since its start. The other laws declare `sample` in their
// own headers.

void sample(const RollingFlow& flow, const double* times, std::size_t n, FlowSample* samples) {
    FlowSampler{flow, n}(times, n, samples);
}

// Rounding must not sink a flying body into the ground; a body in grazing contact stays on the
// ground.
void sample(const Flight& flight, const double* times, std::size_t n, ContactSample* samples) {
    const double tall = most_height(flight.axes);
    for (std::size_t i = 0; i < n; ++i) {
        State& state = samples[i].state;
        state = state_at(flight, times[i]);
        samples[i].force = {0.0, 0.0};
        if (state.z > tall) continue;
        const Geometry at = geometry(flight.axes, state.theta);
        if (flight.mode == Mode::flight) {
            state.z = std::max(state.z, at.h);
        } else {
            state = grazing(at, state, flight.mode);
        }
    }
}

// While bounces settle, omega and x_dot change linearly in time, and the rate of the gap falls
// linearly from the first rebound to 0. In all samples, the body therefore moves away from the
// ground, as it does at the start. theta and x are the integrals of their rates, plus a term linear
// in time that supplies the rest of the total change.
void sample(const Settling& settling, const double* times, std::size_t n, ContactSample* samples) {
    const auto& [axes, lasts, start, end, angle] = settling;
    const double rebound = gap_rate(start, geometry(axes, start.theta));
    for (std::size_t i = 0; i < n; ++i) {
        const double share = std::min(times[i] / lasts, 1.0);
        const auto between = [share](double from, double to) { return from + share * (to - from); };
        const auto change = [share, time = lasts](double rate, double last_rate, double in_all) {
            const double rest = in_all - time * (rate + 0.5 * (last_rate - rate));
            return share * (time * (rate + 0.5 * share * (last_rate - rate)) + rest);
        };
        const double theta = start.theta + change(start.omega, end.omega, end.theta - start.theta);
        const double omega = between(start.omega, end.omega);
        const Geometry at = geometry(axes, theta);
        const State state{theta,
                          omega,
                          start.x + change(start.x_dot, end.x_dot, end.x - start.x),
                          at.h,
                          between(start.x_dot, end.x_dot),
                          at.dh * omega + (1 - share) * rebound,
                          Mode::flight};
        samples[i] = {state, {0.0, 0.0}};
    }
}

void sample(const Standing& standing, const double*, std::size_t n, ContactSample* samples) {
    std::fill_n(samples, n, standing);
}

// These functions convert samples of a law to another type. In the multiplier model, the force is
// one of the unknowns.

template <class Law>
void convert(const Scene& scene, const Law&, const std::vector<FlowSample>& from,
             ContactSample* to) {
    const RollingEquation rolling(scene.body(), scene.slope);
    for (const auto& [theta, omega, x] : from) {
        const Geometry at = geometry(scene.axes(), theta);
        *to++ = {without_slip(at, theta, omega, x, Mode::rolling),
                 rolling.force(scene.mass, at, omega)};
    }
}

void convert(const Scene&, const SteppedMultipliers& motion,
             const std::vector<CoordinateState>& from, ContactSample* to) {
    using namespace coordinate;
    for (const CoordinateState& state : from) {
        const auto& [q, q_dot] = state;
        const auto lambda = accelerations(motion.body, motion.settings, state).multipliers;
        *to++ = {{q[theta], q_dot[theta], q[x], q[z], q_dot[x], q_dot[z], Mode::rolling},
                 {lambda[1], lambda[0]}};
    }
}

template <class Law>
void convert(const Scene&, const Law&, const std::vector<ContactSample>& from, FlowSample* to) {
    for (const auto& [state, force] : from) *to++ = {state.theta, state.omega, state.x};
}

template <class Law>
void convert(const Scene& scene, const Law&, const std::vector<ContactSample>& from,
             CoordinateState* to) {
    for (const auto& [state, force] : from) *to++ = coordinate_state(scene.axes(), state);
}

template <class Law, class Sample>
void evaluate(const Scene& scene, const Law& law, const double* times, std::size_t n,
              Sample* samples) {
    using Own = OwnSample<Law>;
    if constexpr (std::is_same_v<Sample, Own>) {
        sample(law, times, n, samples);
    } else {
        std::vector<std::conditional_t<std::is_same_v<Sample, ContactSample>, Own, ContactSample>>
            from(n);
        evaluate(scene, law, times, n, from.data());
        convert(scene, law, from, samples);
    }
}

double whole_angle(const DoubleDouble& turned, double theta) {
    return turned.high == 0 ? theta : static_cast<double>(turned + theta);
}

// These functions convert a sample to SI units and restore its total angle; the scene has the axes
// of the segment's law.

void complete(FlowSample& sample, const Motion& motion, const Scene&, const DoubleDouble& turned) {
    const Units& units = motion.units;
    sample = {whole_angle(turned, sample.theta), sample.omega / units.time,
              sample.x * units.length};
}

void complete(ContactSample& sample, const Motion& motion, const Scene& scene,
              const DoubleDouble& turned) {
    const Units& units = motion.units;
    State& state = sample.state;
    state = with_whole_angle(scene, state, turned, motion.scene);
    if (motion.rests) state.mode = Mode::rest;
    const double force = units.of(unit::force);
    sample = {in_si(state, units), {sample.force.normal * force, sample.force.friction * force}};
}

void complete(CoordinateState& state, const Motion& motion, const Scene&,
              const DoubleDouble& turned) {
    const Units& units = motion.units;
    const Coordinates lengths{units.length, units.length, 1.0, 1.0, units.length};
    state = {state.q.cwiseProduct(lengths), state.q_dot.cwiseProduct(lengths) / units.time};
    for (const int angle : {coordinate::theta, coordinate::psi}) {
        state.q[angle] = whole_angle(turned, state.q[angle]);
    }
}

}  // namespace

State with_whole_angle(const Scene& seen, State state, const DoubleDouble& turned,
                       const Scene& scene) {
    const double theta = whole_angle(turned, state.theta);
    // Far from the ground, or where the rounded angle is too coarse, only theta is replaced.
    if (state.z <= most_height(scene.axes()) && std::abs(theta) <= most_turned) {
        return with_angle(seen, state, scene.axes(), theta);
    }
    state.theta = theta;
    return state;
}

Motion single(const Scene& scene, decltype(Segment::law) law) {
    Motion motion{Units{}, scene, {}, {}, {}, false};
    motion.segments.push_back({0.0, std::move(law)});
    return motion;
}

Sampler::Sampler(const Motion& motion, std::size_t expected) : motion_(motion) {
    if (motion.segments.size() != 1 || !motion.units.are_si()) return;
    if (const auto* flow = std::get_if<Apart<RollingFlow>>(&motion.segments.front().law)) {
        flow_.emplace(**flow, expected);
    }
}

template <class Sample>
void Sampler::operator()(const double* times, std::size_t n, Sample* samples) const {
    if constexpr (std::is_same_v<Sample, FlowSample>) {
        if (flow_) return (*flow_)(times, n, samples);
    }
    const Units& units = motion_.units;
    const std::vector<Segment>& segments = motion_.segments;
    Scene exchanged = motion_.scene;
    std::swap(exchanged.a, exchanged.b);
    std::vector<double> since;
    since.reserve(n);
    for (std::size_t i = 0; i < n;) {
        // Time j in units of the motion. All times from i on that lie in the same segment are
        // sampled together.
        const auto time = [&, unit = units.time](std::size_t j) {
            return std::min(times[j] / unit, std::numeric_limits<double>::max());
        };
        const auto later =
            std::upper_bound(segments.begin(), segments.end(), time(i),
                             [](double t, const Segment& segment) { return t < segment.begin; });
        const Segment& segment = *(later - 1);
        const double end = later == segments.end() ? infinity : later->begin;
        since.clear();
        for (std::size_t j = i; j < n; ++j) {
            const double t = time(j);
            if (!(t >= segment.begin && t < end)) break;
            since.push_back(t - segment.begin);
        }
        const Scene& scene = segment.axes_exchanged ? exchanged : motion_.scene;
        std::visit(
            [&](const auto& law) {
                evaluate(scene, itself(law), since.data(), since.size(), samples + i);
            },
            segment.law);
        const std::size_t last = i + since.size();
        if (units.are_si() && segment.turned.high == 0 && !motion_.rests) i = last;
        for (; i < last; ++i) complete(samples[i], motion_, scene, segment.turned);
    }
}

void Sampler::operator()(const double* times, std::size_t n, const FlowColumns& out) const {
    if (flow_) return (*flow_)(times, n, out);
    std::vector<FlowSample> samples(n);
    (*this)(times, n, samples.data());
    for (std::size_t i = 0; i < n; ++i) store(samples[i], out, i);
}

template void Sampler::operator()(const double*, std::size_t, FlowSample*) const;
template void Sampler::operator()(const double*, std::size_t, ContactSample*) const;
template void Sampler::operator()(const double*, std::size_t, CoordinateState*) const;

std::vector<double> knot_times(const Motion& motion) {
    std::vector<double> times;
    const auto collect = [&times](const auto& steps) {
        for (const auto& knot : steps.knots) times.push_back(knot.t);
    };
    const auto& law = motion.segments.front().law;
    if (const auto* rolling = std::get_if<SteppedRolling>(&law)) collect(rolling->steps);
    if (const auto* multipliers = std::get_if<SteppedMultipliers>(&law)) {
        std::visit(collect, multipliers->steps);
    }
    return times;
}

}  // namespace rolling_ellipse
