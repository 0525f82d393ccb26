#include "bindings/samples.hpp"

namespace rolling_ellipse::bindings {

py::ssize_t require_coordinates(const Array& q, const Array& q_dot) {
    const py::ssize_t n = require_matrix("q", q, 5);
    require_matrix("q_dot", q_dot, n, 5);
    return n;
}

CoordinateState state_at(const Array& q, const Array& q_dot, py::ssize_t row) {
    return {Eigen::Map<const Coordinates>(q.data(row, 0)),
            Eigen::Map<const Coordinates>(q_dot.data(row, 0))};
}

CoordinateState single_state(const Array& q, const Array& q_dot) {
    require_matrix("q", q, 1, 5);
    require_matrix("q_dot", q_dot, 1, 5);
    return state_at(q, q_dot, 0);
}

double* store_state(const State& state, double* to) {
    for (const double value :
         {state.theta, state.omega, state.x, state.z, state.x_dot, state.z_dot}) {
        *to++ = value;
    }
    return to;
}

double* store_event(const Event& event, double* to) {
    *to++ = event.t;
    *to++ = static_cast<int>(event.kind);
    for (const State* state : {&event.before, &event.after}) {
        to = store_state(*state, to);
        *to++ = static_cast<int>(state->mode);
    }
    return to;
}

FlowColumns columns(std::vector<Array>& arrays) {
    return {arrays[0].mutable_data(), arrays[1].mutable_data(), arrays[2].mutable_data()};
}

}  // namespace rolling_ellipse::bindings
