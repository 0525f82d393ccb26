#include <cstdio>

#include "simulate.hpp"

namespace rolling_ellipse {

std::string brief(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", value);
    return buffer;
}

std::string why_not_rolling(const Scene& scene, const State& start) {
    if (start.mode == Mode::flight) return "the body is in the air";
    if (start.mode == Mode::sliding) {
        return "the body slides with " +
               brief(slip_velocity(start, geometry(scene.axes(), start.theta))) +
               " m/s at the contact";
    }
    return {};
}

std::string why_invalid(Validity validity, double t) {
    if (validity == Validity::no_proof) {
        return "the start violates the constraints, unlike any body on the ground";
    }
    const char* const rest =
        validity == Validity::edge
            ? "; there the law of contact is met only to within rounding errors, which hide "
              "whether rolling remains valid"
            : " only; after it the motion obeys the rolling equation, but not the laws of contact";
    return "rolling is valid until t = " + brief(t) + " s" + rest;
}

std::string why_ended(Ending ending, const Settings& settings, double t, double t_end) {
    if (ending == Ending::completed) return {};  // saves the cost of the text below
    const std::string place = " at t = " + brief(t) + " s of " + brief(t_end) + " s";
    const bool in_contact =
        settings.model == Model::contact;  // the contact model has no error-controlled steps
    switch (ending) {
        case Ending::completed:
        case Ending::validity_lost:  // see why_invalid
            break;
        case Ending::max_steps:
            return "max_steps = " + std::to_string(settings.max_steps) + " was reached" + place +
                   ": allow more steps" +
                   (in_contact      ? ""
                    : settings.step ? ", or larger ones"
                                    : ", or loosen rtol and atol");
        case Ending::step_too_small:
            if (in_contact) return "the motion is too fast for double precision" + place;
            return "no step of a size that changes t meets rtol and atol" + place + ": loosen them";
        case Ending::step_too_large:
            return "a step of " + brief(*settings.step) + " s cannot be solved" + place +
                   ": take smaller ones";
        case Ending::max_events:
            return "max_events = " + std::to_string(settings.max_events) + " was reached" + place +
                   ": allow more events";
        case Ending::jammed:
            return "the sliding body jams" + place +
                   ": friction would press it into the ground (Painleve), and no motion of a "
                   "rigid body is possible";
        case Ending::undetermined:
            return "two motions of the sliding body are possible" + place +
                   ": it flies off, or its own friction presses it against the ground (Painleve), "
                   "and rigid mechanics does not choose";
        case Ending::never:
            return "the motion never stops as asked: from t = " + brief(t) +
                   " s on it is proved to have no further event";
    }
    return {};
}

}  // namespace rolling_ellipse
