// The functions of a Kernel. Each vector level compiles them in its own source, so they call no
// function of the standard library (numerics/lanes.hpp).
#pragma once

#include "rolling/level/kernel.hpp"
#include "rolling/level/motion.hpp"
#include "rolling/level/table_code.hpp"

namespace rolling_ellipse {
namespace {

void rates(const PhaseRate<double>& rate, const PhaseMap<double>& map, double quarters,
           const double* offsets, int count, PhaseRates<double>& found) {
    // Local copies, which the compiler need not load again after a store into `found`.
    const PhaseRate<double> constants = rate;
    const PhaseMap<double> coordinate = map;
    for (int i = 0; i < count; i += lanes) {
        const PhaseIncrement<Pack> at =
            phase_rate_at(constants, coordinate, quarters, load(offsets + i));
        store(at.time, found.time + i);
        store(at.angle, found.angle + i);
        store(at.path, found.path + i);
    }
}

// Bodies with times that are refused, or with motions that stay long at the tip, are left open.
void sample(const RollingStart* starts, const double* times, const std::uint32_t* places, int count,
            FlowSample* samples, bool* is_open) {
    PhaseMotion<Pack> motion;
    for (int first = 0; first < count; first += lanes) {
        PhaseStart<Pack> start{};
        Pack t{};
        for (int lane = 0; lane < lanes; ++lane) {  // the last body fills the remaining lanes
            const int at = first + lane < count ? first + lane : count - 1;
            set_lane(start, lane, starts[places[at]]);
            t[lane] = times[places[at]];
        }
        set_motion(motion, start);
        const Mask<Pack> is_late = abs(t) > 1e15 * motion.phase.half_turn.high;
        const Mask<Pack> left = is_late | motion.phase.map.has_tail;
        const MotionSample<Pack> now = sample_at(motion, start, left ? Pack{} : t);
        for (int lane = 0; lane < lanes && first + lane < count; ++lane) {
            samples[places[first + lane]] = {now.theta[lane], now.omega[lane], now.x[lane]};
            is_open[first + lane] = left[lane] != 0;
        }
    }
}

constexpr const char* level = lanes == 2 ? "sse2" : lanes == 4 ? "avx2" : "avx512";
constexpr Kernel compiled = {level, rates, sample, states, series, first_beyond, read};

}  // namespace
}  // namespace rolling_ellipse
