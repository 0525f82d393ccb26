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

py::tuple event_columns() {
    py::list names;
    names.append("t");
    names.append("kind");
    for (const char* when : {"_before", "_after"}) {
        for (const auto& field : state_fields) names.append(std::string(field.name) + when);
        names.append(std::string("mode") + when);
    }
    return names;
}

double* store_event(const Event& event, double* to) {
    *to++ = event.t;
    *to++ = static_cast<int>(event.kind);
    for (const State* state : {&event.before, &event.after}) {
        to = store(*state, state_fields, to);
        *to++ = static_cast<int>(state->mode);
    }
    return to;
}

Event event_of(const EventRow& row) {
    Event event{row[0], static_cast<EventKind>(row[1]), {}, {}};
    const double* from = row.data() + 2;
    for (State* state : {&event.before, &event.after}) {
        from = read(*state, state_fields, from);
        state->mode = static_cast<Mode>(*from++);
    }
    return event;
}

FlowColumns columns(std::vector<Array>& arrays) {
    return {arrays[0].mutable_data(), arrays[1].mutable_data(), arrays[2].mutable_data()};
}

}  // namespace rolling_ellipse::bindings
