// The settings that choose how a motion is computed, and the rules that they must obey.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "scene/scene.hpp"

namespace rolling_ellipse {

enum class Model { automatic, rolling, multipliers, contact };

enum class Method { automatic, exact, dop853, dopri5, rk4, gauss, radau };

// The stabilization of the multiplier model's constraints: none (an index-1 system), Baumgarte's
// feedback, projection after each step (optionally onto the energy, too), or the index-2 system of
// Gear, Gupta and Leimkuhler.
enum class Stabilization { none, baumgarte, projection, projection_energy, ggl };

template <>
inline constexpr std::array names<Model>{"auto", "rolling", "multipliers", "contact"};
template <>
inline constexpr std::array names<Method>{"auto", "exact", "dop853", "dopri5",
                                          "rk4",  "gauss", "radau"};
template <>
inline constexpr std::array names<Stabilization>{"none", "baumgarte", "projection",
                                                 "projection+energy", "ggl"};

// An impulse applied during a motion, at the time t [s].
struct Blow {
    double t;
    Impulse impulse;
};

// When a motion stops: at an event of the given kinds, or once the body is proved to rest, roll or
// slide for ever.
struct Stop {
    long kinds = 0;  // a bit mask: 1 << kind for each EventKind
    bool decided = false;

    explicit operator bool() const { return kinds != 0 || decided; }
};

struct Settings {
    Model model;
    Method method;
    double rtol;
    double atol;
    std::optional<double> step;  // step size [s]; if absent, error control chooses it
    std::optional<int> stages;   // stages of "gauss"; 4 if absent
    Stabilization stabilization;
    std::array<double, 2> baumgarte;  // alpha and beta [1/s]
    long max_steps;
    long max_events;
    // Bounces slower than this are summed [m/s]; if absent, 1e-6 sqrt(g min(a, b)).
    std::optional<double> rest_speed;
    std::vector<Blow> blows = {};  // in order of time
    Stop stop = {};
    long count = 1;  // stop at this many events of the kinds in `stop`

    bool is_for_events() const { return stop || !blows.empty(); }
};

inline constexpr std::tuple settings_fields{std::pair{"model", &Settings::model},
                                            std::pair{"method", &Settings::method},
                                            std::pair{"rtol", &Settings::rtol},
                                            std::pair{"atol", &Settings::atol},
                                            std::pair{"step", &Settings::step},
                                            std::pair{"stages", &Settings::stages},
                                            std::pair{"stabilization", &Settings::stabilization},
                                            std::pair{"baumgarte", &Settings::baumgarte},
                                            std::pair{"max_steps", &Settings::max_steps},
                                            std::pair{"max_events", &Settings::max_events},
                                            std::pair{"rest_speed", &Settings::rest_speed},
                                            std::pair{"blows", &Settings::blows},
                                            std::pair{"stop", &Settings::stop},
                                            std::pair{"count", &Settings::count}};

// Called from time to time during a long computation; throws to stop the computation.
using Checkpoint = std::function<void()>;

// Throws std::invalid_argument, naming the argument, the requirement and the value given.
void validate(const Settings& settings, double t_end);

}  // namespace rolling_ellipse
