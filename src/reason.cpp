#include <cmath>
#include <cstdio>

#include "simulate.hpp"

namespace rolling_ellipse {
namespace {

// A phrase with the extremes of the forces, each with the place or time of its occurrence.
std::string extremes(double normal, const std::string& normal_at, double friction_needed,
                     const std::string& friction_at, double friction) {
    return "the smallest N is " + brief(normal) + " N (" + normal_at + "), the largest |F|/N is " +
           brief(friction_needed) + " (" + friction_at + "), the friction coefficient is " +
           brief(friction);
}

std::string extremes(const Certificate& c, double friction) {
    if (!c.smallest_normal_force_angle) {
        return "downhill its forces would grow without bound, the friction coefficient is " +
               brief(friction);
    }
    const auto at = [](double theta) { return "theta = " + brief(theta * 180 / pi) + " deg"; };
    return extremes(*c.smallest_normal_force, at(*c.smallest_normal_force_angle),
                    *c.largest_friction_needed, at(*c.largest_friction_needed_angle), friction);
}

std::string why_rolling_ends(double friction) {
    if (std::isinf(friction)) return "the ground would have to pull (N < 0)";
    if (friction == 0) return "the contact slides, as there is no friction";
    return "it would need more friction than there is";
}

std::string why_rolling(const Scene& scene, const State& start, const Certificate& c) {
    const Validity validity = c.end.validity;
    if (validity == Validity::no_proof) {
        return "rolling: not proved, since " + why_not_rolling(scene, start);
    }
    const std::string known = extremes(c, scene.friction);
    if (validity == Validity::valid) {
        return (start.mode == Mode::rest ? "rest: in equilibrium, "
                                         : "rolling: proved valid for the whole motion, ") +
               known;
    }
    if (!c.end.angle) {
        return "rolling: valid from the start on, towards a tip that it never reaches; before the "
               "start the same motion would not be valid; on the whole motion " +
               known;
    }
    const std::string angle = brief(*c.end.angle) + " rad";
    if (validity == Validity::edge) {
        return "rolling: at theta = " + angle +
               " on the edge of its validity, and rounding cannot tell on which side; " + known;
    }
    const bool at_once = *c.end.angle == start.theta;
    return (at_once ? "rolling: cannot start at theta = " : "rolling: ends at theta = ") + angle +
           ", where " + why_rolling_ends(scene.friction) + "; on the whole motion " + known;
}

}  // namespace

std::string brief(double value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.6g", value);
    return buffer;
}

std::string slip_removal(const InitialState& start) {
    if (start.slip_removed == 0) return {};
    return "infinite friction stops the slip of " + brief(start.slip_removed) +
           " m/s at t = 0: the ground gives an impulse of " + brief(start.reaction_x) +
           " N s along and " + brief(start.reaction_z) + " N s away from it, and " +
           brief(start.energy_lost) + " J are lost";
}

std::string why_it_rolls(const Continuation& next) {
    if (!next.may_fly) return {};
    return "at the start two motions are possible (Painleve): it rolls on, wedged by friction, or "
           "it flies off, since it turns too fast for its weight; rolling is chosen";
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
    if (ending == Ending::completed) return {};  // avoids the cost of the text below
    const std::string place = " at t = " + brief(t) + " s of " + brief(t_end) + " s";
    const bool in_contact =
        settings.model == Model::contact;  // the contact model has no steps of controlled error
    switch (ending) {
        case Ending::completed:
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
                   ": it flies off, or its own friction presses it on the ground (Painleve), and "
                   "rigid mechanics does not choose";
        case Ending::validity_lost:
            return "rolling is valid until t = " + brief(t) +
                   " s only; after it the motion obeys the rolling equation, but not the laws of "
                   "contact";
    }
    return {};
}

std::string reason(const Scene& scene, const ContactWatch& watch) {
    const auto at = [](double t) { return "t = " + brief(t) + " s"; };
    return "rolling: not proved in advance, since it starts from coordinates; along the computed "
           "motion " +
           extremes(watch.smallest_normal_force, at(watch.smallest_normal_force_time),
                    watch.largest_friction_needed, at(watch.largest_friction_needed_time),
                    scene.friction);
}

std::string reason(const Scene& scene, const InitialState& start, const Certificate& c) {
    std::string found = why_rolling(scene, start.state, c);
    const Continuation next = first_continuation(scene, start.state);
    for (const std::string& each : {slip_removal(start), why_it_rolls(next)}) {
        if (!each.empty()) found += "; " + each;
    }
    return found;
}

}  // namespace rolling_ellipse
