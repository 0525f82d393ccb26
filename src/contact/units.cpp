#include "contact/units.hpp"

#include <iterator>
#include <utility>

namespace rolling_ellipse {
namespace {

// A loop over the table that is unrolled, since every sample goes through it.
template <std::size_t... Row>
State scaled(State state, const Units& units, std::index_sequence<Row...>) {
    ((state.*state_fields[Row].number *= units.of(state_fields[Row].unit)), ...);
    return state;
}

}  // namespace

Scene in_units(const Scene& scene, const Units& units) {
    Scene scaled{};
    for (const SceneField& field : scene_fields) {
        if (const auto value = field.of(scene)) field.set(scaled, *value / units.of(field.unit));
    }
    return scaled;
}

State in_units(const State& state, const Units& units) {
    return in_si(state, {1 / units.length, 1 / units.time, 1 / units.mass});
}

State in_si(const State& state, const Units& units) {
    return scaled(state, units, std::make_index_sequence<std::size(state_fields)>());
}

ContactSample in_si(const ContactSample& sample, const Units& units) {
    const double force = units.of(unit::force);
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
