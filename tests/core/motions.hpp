// Scenes and settings shared by the test programs.
#pragma once

#include <cstdio>
#include <cstring>
#include <optional>
#include <vector>

#include "geometry/ellipse.hpp"
#include "scene/scene.hpp"
#include "scene/settings.hpp"

namespace rolling_ellipse {

// A 2:1 elliptical disc of 10 kg on level ground.
inline Scene ellipse(double theta, double omega, double friction = infinity) {
    Scene scene{};
    scene.a = 2.0;
    scene.b = 1.0;
    scene.mass = 10.0;
    scene.gravity = 9.81;
    scene.inertia = scene.mass * uniform_disc_gyration2(scene.a, scene.b);
    scene.friction = friction;
    scene.theta = theta;
    scene.omega = omega;
    return scene;
}

inline Scene skidding(double theta, double omega, double x_dot, double friction) {
    Scene scene = ellipse(theta, omega, friction);
    scene.x_dot = x_dot;
    return scene;
}

inline Scene bouncing(double theta, double omega, double friction) {
    Scene scene = ellipse(theta, omega, friction);
    scene.restitution = 0.5;
    return scene;
}

inline Settings settings_of(Model model, Method method, std::optional<double> step = {},
                            Stabilization stabilization = Stabilization::projection) {
    Settings settings{};
    settings.model = model;
    settings.method = method;
    settings.stabilization = stabilization;
    settings.rtol = 1e-10;
    settings.atol = 1e-12;
    settings.step = step;
    settings.max_steps = 1'000'000;
    settings.max_events = 10'000;
    return settings;
}

inline Scene on_slope(Scene scene, double slope) {
    scene.slope = slope;
    return scene;
}

template <class Each>
bool same_bits(const std::vector<Each>& one, const std::vector<Each>& other) {
    return one.size() == other.size() &&
           std::memcmp(one.data(), other.data(), one.size() * sizeof(Each)) == 0;
}

// Prints the verdict of a test program and returns its exit code.
inline int verdict(int failures) {
    std::printf(failures == 0 ? "all hold\n" : "%d do not hold\n", failures);
    return failures == 0 ? 0 : 1;
}

}  // namespace rolling_ellipse
