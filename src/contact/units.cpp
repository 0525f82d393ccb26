#include "contact/units.hpp"

namespace rolling_ellipse {

Scene body_in_units(const Scene& scene, const Units& units) {
    Scene scaled{};
    scaled.a = scene.a / units.length;
    scaled.b = scene.b / units.length;
    scaled.mass = scene.mass / units.mass;
    scaled.gravity = scene.gravity / units.speed() * units.time;
    scaled.inertia = scene.inertia / units.mass / units.length / units.length;
    scaled.slope = scene.slope;
    scaled.friction = scene.friction;
    scaled.restitution = scene.restitution;
    return scaled;
}

State in_units(const State& state, const Units& units) {
    return {state.theta,
            state.omega * units.time,
            state.x / units.length,
            state.z / units.length,
            state.x_dot / units.speed(),
            state.z_dot / units.speed(),
            state.mode};
}

State in_si(const State& state, const Units& units) {
    return in_units(state, {1 / units.length, 1 / units.time, 1 / units.mass});
}

ContactSample in_si(const ContactSample& sample, const Units& units) {
    const double force = units.mass * units.speed() / units.time;
    return {in_si(sample.state, units),
            {sample.force.normal * force, sample.force.friction * force}};
}

FlowSample in_si(const FlowSample& sample, const Units& units) {
    return {sample.theta, sample.omega / units.time, sample.x * units.length};
}

CoordinateState in_si(const CoordinateState& state, const Units& units) {
    const Coordinates lengths{units.length, units.length, 1.0, 1.0, units.length};
    return {state.q.cwiseProduct(lengths), state.q_dot.cwiseProduct(lengths) / units.time};
}

}  // namespace rolling_ellipse
