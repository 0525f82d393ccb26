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

Array event_rows(const std::vector<Event>& events) {
    Array table = matrix(events.size(), event_numbers);
    double* to = table.mutable_data();
    for (const Event& event : events) {
        *to++ = event.t;
        *to++ = static_cast<int>(event.kind);
        for (const State* state : {&event.before, &event.after}) {
            for (const auto& field : state_fields) *to++ = state->*field.number;
            *to++ = static_cast<int>(state->mode);
        }
    }
    return table;
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

void ContactColumns::store(const ContactSample* samples, py::ssize_t begin, py::ssize_t end) const {
    auto column = numbers.begin();
    const auto fill = [&](const auto& table, const auto& part) {
        for (const auto& field : table) {
            double* const values = *column++;
            for (py::ssize_t i = begin; i < end; ++i) {
                values[i] = samples[i - begin].*part.*field.number;
            }
        }
    };
    fill(state_fields, &ContactSample::state);
    fill(force_fields, &ContactSample::force);
    for (py::ssize_t i = begin; i < end; ++i) {
        modes[i] = static_cast<std::int8_t>(samples[i - begin].state.mode);
    }
}

}  // namespace rolling_ellipse::bindings
