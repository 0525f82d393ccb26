// How fast time, angle and path grow along the coordinate y of rolling/phase_map.hpp, at several
// places side by side: most of the work of an exact motion.
//
// With L, S the long and short semi-axes, c^2 = L^2 - S^2, phi the angle from the flat position,
// H = E/(m g) the height of the energy and D = (d0 + d1 sin^2 phi)/h^2, physics (28), the integral
// of physics (27) becomes that of physics (29),
//     dt/dphase = scale sqrt(D (H + h)) / sqrt(cos^2 phase + kappa^2 sin^2 phase),
//     sin phi   = amplitude sin phase,
// rotation (phase = phi) and libration (phase = u of sin phi = sin phi_max sin u) are one integral:
//     rotation:  amplitude 1, scale^2 = 1/(2 g (H^2 - S^2)),   kappa^2 = (H^2 - L^2)/(H^2 - S^2)
//     libration: amplitude^2 = (H^2 - S^2)/c^2, scale^2 = 1/(2 g c^2), kappa^2 = (L^2 - H^2)/c^2
// No term is a difference that cancels, but for H - L itself. Along y
//     dphase/dy = speed sqrt((g^2 cos^2 + sin^2) (cos^2 + kappa^2 sin^2)),
// whose last root cancels that of the integrand. The path of the centre grows by h dphi.
#pragma once

#include <array>
#include <cstddef>

#include "rolling/phase_map.hpp"

namespace rolling_ellipse {

// The constants of the integrand above.
struct PhaseRate {
    double short_axis;     // S
    double c2;             // L^2 - S^2
    double energy_height;  // H
    double amplitude2;
    double scale2;
    double kappa;
    double d0;
    double d1;
    bool rotates;
};

inline constexpr std::size_t phase_lanes = 8;
using PhaseLanes = std::array<double, phase_lanes>;

// What a way along y takes, or its rate: time [s], angle [rad], path of the centre [m].
struct PhaseWay {
    double time;
    double angle;
    double path;
};

struct PhaseWays {
    PhaseLanes time;
    PhaseLanes angle;
    PhaseLanes path;
};

// The rates at y = quarters Y + offset, |quarters| <= 1, |offset| <= 5/2 Y.
PhaseWays phase_rates(const PhaseRate& rate, const PhaseMap& map, int quarters,
                      const PhaseLanes& offset);

}  // namespace rolling_ellipse
