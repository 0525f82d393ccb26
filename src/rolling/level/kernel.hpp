// The inner loops of exact rolling. The same code is compiled for several vector levels
// (lanes_*.cpp) and gives the same bits at every level (numerics/lanes.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "rolling/level/phase.hpp"
#include "rolling/level/start.hpp"
#include "rolling/level/table.hpp"

namespace rolling_ellipse {

struct Kernel {
    const char* name;  // of the vector level
    // The rates of one motion at y = quarters Y + offset, |quarters| <= 1. The arrays have room for
    // a whole number of packs.
    void (*rates)(const PhaseRate<double>& rate, const PhaseMap<double>& map, double quarters,
                  const double* offsets, int count, PhaseRates<double>& found);
    // The states of bodies, each at its own time: starts[p], times[p] and samples[p] for every p in
    // `places`. A body stays open if it has to be sampled alone. Null in the kernel that takes
    // bodies one by one.
    void (*sample)(const RollingStart* starts, const double* times, const std::uint32_t* places,
                   int count, FlowSample* samples, bool* is_open);
    // The motion at the coordinate of each place.
    void (*states)(const PhaseRate<double>& rate, const PhaseMap<double>& map, double amplitude,
                   TablePlace* places, int count);
    // The series of the pieces about places, in units of time and length; the path starts at 0.
    void (*series)(const SeriesConstants& body, double time_unit, double length_unit,
                   TablePlace* places, int count, FlowPiece* pieces);
    // Index of the first time that is NaN or larger than `most` in size; n if there is none.
    std::size_t (*first_beyond)(const double* times, std::size_t n, double most);
    // The motion at many times. Where no piece reaches, theta is NaN; returns whether one is.
    bool (*read)(const FlowReader& motion, const double* times, std::size_t n,
                 const FlowColumns& out);
};

Kernel kernel_avx2();
Kernel kernel_avx512();

// The kernels that this processor can run, the fastest last. The first one takes bodies one by one.
const std::vector<Kernel>& kernels();

// The fastest kernel of this processor.
const Kernel& kernel();

}  // namespace rolling_ellipse
