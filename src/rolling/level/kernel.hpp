// The inner loops of exact rolling: the same code for several vector levels (lanes_*.cpp), of which
// the best one of the machine is taken, with the same bits at every level (see numerics/lanes.hpp).
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
    // The rates of one motion at y = quarters Y + offset, |quarters| <= 1; there is room for a
    // whole number of packs of offsets.
    void (*rates)(const PhaseRate<double>& rate, const PhaseMap<double>& map, double quarters,
                  const double* offsets, int count, PhaseWays<double>& found);
    // The states of bodies, written to their places; and for every body of the list whether it is
    // one of those that have to be taken alone. Null in the kernel that takes bodies one by one.
    void (*sample)(const RollingStart* starts, const double* times, const std::uint32_t* places,
                   int count, FlowSample* samples, bool* is_open);
    // The motion at the coordinate of each place.
    void (*states)(const PhaseRate<double>& rate, const PhaseMap<double>& map, double amplitude,
                   TablePlace* places, int count);
    // The series of the pieces about places, in units of time and length; the path starts at 0.
    void (*series)(const SeriesConstants& body, double time_unit, double length_unit,
                   TablePlace* places, int count, FlowPiece* pieces);
    // The first time that is not within most in size, NaN neither; n if there is none.
    std::size_t (*first_beyond)(const double* times, std::size_t n, double most);
    // The motion at many times; theta is NaN where no piece reaches. Returns whether one is.
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
