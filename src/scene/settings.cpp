#include "scene/settings.hpp"

#include <cmath>
#include <stdexcept>

#include "scene/field.hpp"

namespace rolling_ellipse {
namespace {

std::string quoted(const std::string& name) { return "'" + name + "'"; }

void require_tolerance(const std::string& name, double value) {
    if (!(value >= 0 && std::isfinite(value))) {
        refuse(name, "a finite number of at least 0", value);
    }
}

void require_count(const std::string& name, long count) {
    if (count < 1) refuse(name, "at least 1", std::to_string(count));
}

void validate_step(const Settings& settings, double t_end) {
    constexpr double smallest_step_ulps = 10;  // in ulps of the end time, as in error control
    const Method method = settings.method;
    const std::string for_method = " for method " + quoted(name(method));
    if (!settings.step) {
        if (method != Method::rk4 && method != Method::gauss && method != Method::radau) return;
        refuse("step", "given [s]" + for_method, "None");
    }
    const double step = *settings.step;
    if (method == Method::automatic || method == Method::exact) {
        refuse("step", "None" + for_method + ", which takes no fixed steps", step);
    }
    if (!(step > 0 && std::isfinite(step))) refuse("step", "a positive finite time [s]", step);
    if (step > t_end && t_end > 0) {
        refuse("step", "at most the time simulated, " + text(t_end) + " [s]", step);
    }
    const double smallest = smallest_step_ulps * (t_end - std::nextafter(t_end, 0.0));
    if (step < smallest && step < t_end) {
        refuse("step",
               "at least " + text(smallest) + " [s], ten units in the last place of the last time",
               step);
    }
}

// Rejects a method or a stabilization that the model lacks, and pairs of them that do not match.
void validate_method(const Settings& settings) {
    const Method method = settings.method;
    const std::string chosen = quoted(name(method));
    const std::string stabilization = quoted(name(settings.stabilization));
    if (settings.model == Model::contact && method != Method::automatic) {
        refuse("method", "'auto' for model 'contact'", chosen);
    }
    if (settings.model != Model::multipliers) {
        if (settings.stabilization == Stabilization::projection) return;
        refuse("stabilization",
               "left alone for model " + quoted(name(settings.model)) +
                   ", which has no constraints to drift from ('multipliers' has)",
               stabilization);
    }
    if (method == Method::exact || method == Method::gauss) {
        refuse("method", "one of 'dop853', 'dopri5', 'rk4', 'radau' for model 'multipliers'",
               chosen);
    }
    const bool is_index_2 = settings.stabilization == Stabilization::ggl;
    if (method == Method::radau && !is_index_2) {
        refuse("stabilization", "'ggl' for method 'radau'", stabilization);
    }
    if (method != Method::radau && is_index_2) {
        throw std::invalid_argument(
            "stabilization must not be 'ggl', which only method 'radau' can solve, for method " +
            chosen + ", got 'ggl'");
    }
}

void validate_stages(const Settings& settings) {
    if (!settings.stages) return;
    const std::string stages = std::to_string(*settings.stages);
    if (settings.method != Method::gauss) {
        refuse("stages",
               "None for method " + quoted(name(settings.method)) + " ('gauss' has 2, 3 or 4)",
               stages);
    }
    if (*settings.stages < 2 || *settings.stages > 4) refuse("stages", "2, 3 or 4", stages);
}

// Rejects an argument that needs events if the model or the method has none.
void require_events(const Settings& settings, const char* argument, const std::string& none,
                    const std::string& given) {
    const bool by_rolling = settings.method != Method::automatic;
    if (by_rolling || settings.model == Model::rolling || settings.model == Model::multipliers) {
        const std::string what = by_rolling ? "method " + quoted(name(settings.method))
                                            : "model " + quoted(name(settings.model));
        refuse(argument, none + " for " + what + " (model 'contact' follows them)", given);
    }
}

// Rejects blows that are out of order or outside the time of the motion.
void validate_blows(const Settings& settings, double t_end) {
    if (settings.blows.empty()) return;
    require_events(settings, "blows", "()", text(settings.blows.front().t) + " s");
    double last = 0.0;
    for (const Blow& blow : settings.blows) {
        if (!(blow.t >= last && blow.t <= t_end)) {
            refuse("blows",
                   "at times [s] that do not decrease, within the motion, [0, " + text(t_end) + "]",
                   text(blow.t) + (last > 0 ? " after " + text(last) : ""));
        }
        last = blow.t;
    }
}

void validate_stop(const Settings& settings) {
    if (settings.stop) require_events(settings, "stop", "None", "kinds of events");
    const bool counts = settings.stop.kinds != 0;
    const long most = counts ? settings.max_events : 1;
    if (settings.count < 1 || settings.count > most) {
        refuse("count",
               counts ? "from 1 to max_events, " + std::to_string(most)
                      : std::string("1 without kinds of events as stop"),
               std::to_string(settings.count));
    }
}

}  // namespace

void validate(const Settings& settings, double t_end) {
    require_tolerance("rtol", settings.rtol);
    require_tolerance("atol", settings.atol);
    if (settings.rtol == 0 && settings.atol == 0) {
        throw std::invalid_argument("rtol and atol must not both be 0, got 0.0 and 0.0");
    }
    validate_method(settings);
    constexpr double largest_gain = 1e50;  // its square times a residual must not overflow
    for (const double gain : settings.baumgarte) {
        if (!(gain >= 0 && gain <= largest_gain)) {
            refuse("baumgarte", "two finite gains of at least 0 and at most 1e50 [1/s]", gain);
        }
    }
    validate_step(settings, t_end);
    validate_stages(settings);
    require_count("max_steps", settings.max_steps);
    require_count("max_events", settings.max_events);
    if (settings.rest_speed && !(*settings.rest_speed > 0 && std::isfinite(*settings.rest_speed))) {
        refuse("rest_speed", "a positive finite speed [m/s]", *settings.rest_speed);
    }
    validate_blows(settings, t_end);
    validate_stop(settings);
}

}  // namespace rolling_ellipse
