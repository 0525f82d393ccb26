#include "scene/settings.hpp"

#include <cmath>
#include <stdexcept>

#include "scene/refuse.hpp"
#include "scene/scene.hpp"

namespace rolling_ellipse {
namespace {

bool needs_step(Method method) {
    return method == Method::rk4 || method == Method::gauss || method == Method::radau;
}

void require_tolerance(const std::string& name, double value) {
    if (!(value >= 0 && std::isfinite(value))) {
        refuse(name, "a finite number of at least 0", value);
    }
}

void require_count(const std::string& name, long count) {
    if (count < 1) {
        throw std::invalid_argument(name + " must be at least 1, got " + std::to_string(count));
    }
}

void validate_step(const Settings& settings, double t_end) {
    constexpr double smallest_step_ulps = 10;  // of the last time, as with error control
    const Method method = settings.method;
    if (!settings.step) {
        if (!needs_step(method)) return;
        throw std::invalid_argument("step must be given [s] for method '" + name(method) +
                                    "', got None");
    }
    const double step = *settings.step;
    if (method == Method::automatic || method == Method::exact) {
        refuse("step", "None for method '" + name(method) + "', which takes no fixed steps", step);
    }
    if (!(step > 0 && std::isfinite(step))) refuse("step", "a positive finite time [s]", step);
    if (step > t_end && t_end > 0) {
        refuse("step", "at most the time simulated, " + text(t_end) + " [s]", step);
    }
    const double smallest = smallest_step_ulps * (t_end - std::nextafter(t_end, 0.0));
    if (step < smallest && step < t_end) {
        refuse("step", "at least " + text(smallest) + " [s], which the last time still knows",
               step);
    }
}

// Each model has its methods, and each of these its stabilizations.
void validate_method(const Settings& settings) {
    const Method method = settings.method;
    const Stabilization stabilization = settings.stabilization;
    const std::string came = ", got '" + name(stabilization) + "'";
    if (settings.model == Model::contact && method != Method::automatic) {
        throw std::invalid_argument("method must be 'auto' for model 'contact', got '" +
                                    name(method) + "'");
    }
    if (settings.model != Model::multipliers) {
        if (stabilization == Stabilization::projection) return;
        throw std::invalid_argument(
            "stabilization must be left alone for model '" + name(settings.model) +
            "', which has no constraints to drift from ('multipliers' has)" + came);
    }
    if (method == Method::exact || method == Method::gauss) {
        throw std::invalid_argument(
            "method must be one of 'dop853', 'dopri5', 'rk4', 'radau' for model 'multipliers', "
            "got '" +
            name(method) + "'");
    }
    if ((method == Method::radau) != (stabilization == Stabilization::ggl)) {
        throw std::invalid_argument(
            (method == Method::radau ? "stabilization must be 'ggl' for method 'radau'"
                                     : "stabilization must not be 'ggl', which only method 'radau' "
                                       "can solve, for method '" +
                                           name(method) + "'") +
            came);
    }
}

void validate_baumgarte(const Settings& settings) {
    constexpr double largest_gain = 1e50;  // its square times a residual is still a force
    for (const double gain : settings.baumgarte) {
        if (!(gain >= 0 && gain <= largest_gain)) {
            refuse("baumgarte", "two finite gains of at least 0 and at most 1e50 [1/s]", gain);
        }
    }
}

void validate_stages(const Settings& settings) {
    if (!settings.stages) return;
    const std::string came = ", got " + std::to_string(*settings.stages);
    if (settings.method != Method::gauss) {
        throw std::invalid_argument("stages must be None for method '" + name(settings.method) +
                                    "' ('gauss' has 2, 3 or 4)" + came);
    }
    if (*settings.stages < 2 || *settings.stages > 4) {
        throw std::invalid_argument("stages must be 2, 3 or 4" + came);
    }
}

}  // namespace

void no_integrator_for(Method method) {
    throw std::logic_error("there is no integrator for the method '" + name(method) + "'");
}

void validate(const Settings& settings, double t_end) {
    require_tolerance("rtol", settings.rtol);
    require_tolerance("atol", settings.atol);
    if (settings.rtol == 0 && settings.atol == 0) {
        throw std::invalid_argument("rtol and atol must not both be 0, got 0.0 and 0.0");
    }
    validate_method(settings);
    validate_baumgarte(settings);
    validate_step(settings, t_end);
    validate_stages(settings);
    require_count("max_steps", settings.max_steps);
    require_count("max_events", settings.max_events);
    if (settings.rest_speed && !(*settings.rest_speed > 0 && std::isfinite(*settings.rest_speed))) {
        refuse("rest_speed", "a positive finite speed [m/s]", *settings.rest_speed);
    }
}

}  // namespace rolling_ellipse
