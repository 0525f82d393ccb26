#include "reason.hpp"

#include <cmath>
#include <cstdio>

#include "geometry/ellipse.hpp"

namespace rolling_ellipse {
namespace {

std::string in_degrees(double angle) { return brief(angle * 180 / pi) + " deg"; }

std::string extremes_of(const Certificate& c) {
    if (!c.smallest_normal_force_angle) return "downhill its forces would grow beyond all bounds";
    return "the smallest N is " + brief(*c.smallest_normal_force) +
           " N (theta = " + in_degrees(*c.smallest_normal_force_angle) + "), the largest |F|/N " +
           brief(*c.largest_friction_needed) +
           " (theta = " + in_degrees(*c.largest_friction_needed_angle) + ")";
}

std::string why_rolling_ends(double friction) {
    if (std::isinf(friction)) return "N would have to pull";
    if (friction == 0) return "its contact slides, without friction";
    return "it would need more than the friction";
}

std::string why_rolling(const Scene& scene, const State& start, const Certificate& c) {
    if (c.end.validity == Validity::no_proof) {
        return "rolling: nothing to prove, " + why_not_rolling(scene, start);
    }
    const std::string extremes =
        extremes_of(c) + ", the friction coefficient " + brief(scene.friction);
    if (c.end.validity != Validity::valid && !c.end.angle) {
        return "rolling: holds from the start on, towards the tip it never reaches; before the "
               "start the same motion would break it; on the whole motion " +
               extremes;
    }
    switch (c.end.validity) {
        case Validity::valid:
            return (start.mode == Mode::rest ? "rest: in equilibrium, "
                                             : "rolling: proved valid for the whole motion, ") +
                   extremes;
        case Validity::edge:
            return "rolling: on the edge of its validity at theta = " + brief(*c.end.angle) +
                   " rad, closer than rounding can tell; " + extremes;
        default:
            break;
    }
    const bool at_once = *c.end.angle == start.theta;
    return (at_once ? "rolling: cannot start at theta = " : "rolling: ends at theta = ") +
           brief(*c.end.angle) + " rad, where " + why_rolling_ends(scene.friction) +
           "; on the whole motion " + extremes;
}

}  // namespace

std::string brief(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", value);
    return buffer;
}

std::string slip_removal(const InitialState& start) {
    if (start.slip_removed == 0) return {};
    return "infinite friction takes the slip of " + brief(start.slip_removed) +
           " m/s off at t = 0: the ground gives " + brief(start.reaction_x) + " N s along and " +
           brief(start.reaction_z) + " N s away from it, and " + brief(start.energy_lost) +
           " J are lost";
}

std::string why_it_rolls(const Continuation& next) {
    if (!next.may_fly) return {};
    return "at the start both are possible, to roll, wedged by friction, and to fly, as it turns "
           "too fast for its weight (Painleve): it goes on rolling";
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

std::string why_ended(Ending ending, const Settings& settings, double t, double t_end) {
    const std::string place = " at t = " + brief(t) + " s of " + brief(t_end) + " s";
    const bool in_contact = settings.model == Model::contact;  // no steps with an error
    switch (ending) {
        case Ending::completed:
            return {};
        case Ending::max_steps:
            return "max_steps = " + std::to_string(settings.max_steps) + " steps ended" + place +
                   ": allow more of them" +
                   (in_contact      ? ""
                    : settings.step ? ", or larger ones"
                                    : ", or loosen rtol and atol");
        case Ending::step_too_small:
            if (in_contact) return "the motion goes faster than doubles can follow" + place;
            return "no step of a size that changes t meets rtol and atol" + place + ": loosen them";
        case Ending::step_too_large:
            return "a step of " + brief(*settings.step) + " s cannot be solved" + place +
                   ": take smaller ones";
        case Ending::max_events:
            return "max_events = " + std::to_string(settings.max_events) + " events ended" + place +
                   ": allow more of them";
        case Ending::jammed:
            return "the sliding body jams" + place +
                   ": friction would have to push it into the ground (Painleve), and no motion of "
                   "a rigid body goes on";
        case Ending::undetermined:
            return "two motions of the sliding body go on" + place +
                   ": it flies off, or its contact is pressed by the friction that it needs for "
                   "that (Painleve), and rigid mechanics does not choose";
        case Ending::validity_lost:
            return "rolling is true until t = " + brief(t) +
                   " s only; what follows obeys the rolling equation, not the ground";
    }
    return {};
}

std::string reason(const Scene& scene, const ContactWatch& watch) {
    return "rolling: of a start in coordinates nothing is proved in advance; "
           "along the motion computed the smallest N is " +
           brief(watch.smallest_normal_force) +
           " N (t = " + brief(watch.smallest_normal_force_time) + " s), the largest |F|/N " +
           brief(watch.largest_friction_needed) +
           " (t = " + brief(watch.largest_friction_needed_time) + " s), the friction coefficient " +
           brief(scene.friction);
}

std::string reason(const Scene& scene, const InitialState& start, const Certificate& c) {
    std::string found = why_rolling(scene, start.state, c);
    const std::string more[] = {slip_removal(start),
                                why_it_rolls(first_continuation(scene, start.state))};
    for (const std::string& each : more) {
        if (!each.empty()) found += "; " + each;
    }
    return found;
}

}  // namespace rolling_ellipse
