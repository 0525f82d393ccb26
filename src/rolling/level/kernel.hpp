// Exact rolling of many bodies, and at many times of one motion by a table, with the inner loops of
// both. The same code is compiled for several vector levels (lanes_*.cpp) and gives the same bits
// at every level (numerics/lanes.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "numerics/series.hpp"
#include "rolling/level/flow.hpp"

namespace rolling_ellipse {

inline constexpr int table_order = 14;
inline constexpr int table_size = table_order + 1;
inline constexpr int series_columns = 4;  // angle, omega, path and one more: a row fills a register

// Power series in time of angle, angular velocity and path about a place. The last row is zero,
// since rows are read in pairs.
struct TableSeries {
    alignas(64) double rows[table_size + 1][series_columns];
};

// A place of a table, and the motion there on the way up.
struct TablePlace {
    double y;         // the coordinate of rolling/level/flow.hpp
    double sin, cos;  // sine and cosine of the angle from the flat position
    double quarters;  // 0 if the flat position is nearer, 1 if the tip is
    double angle;     // angle from the flat position or tip named by `quarters`
    double omega;
    double time, path;  // time and path since the previous place
    double radius;      // half the interval of the series, in units of its variable
    double holds;       // 1 if the series has full double precision in its radius, otherwise 0
};

// The series of an interval of times since the flat position.
struct FlowPiece {
    DoubleDouble centre;
    double low;
    double high;
    double quarters;  // quarters from the flat position to the origin of angle and path
    TableSeries series;
};

// A motion as the kernel reads it.
struct FlowReader {
    const FlowPiece* pieces;
    const double* ends;  // ends of the pieces, then infinities: 2 half - 1 numbers
    int half;
    double last_end;
    double per_unit;  // the variable of a series is per_unit times the time [1/s]
    // The time of a half turn; start_time is the time from the flat position to the start.
    DoubleDouble half_turn;
    double half_turns_per_time;
    DoubleDouble start_time;
    // `spin`: sign of the motion after even half turns; `alternates`: 1 if a half turn changes it.
    double spin;
    double alternates;
    double quarters_per_half_turn;
    // Quarter turns from the flat position to the flat position or tip nearest to the start.
    double quarters;
    DoubleDouble angle;  // theta of the start less its angle from `quarters`
    double path;         // path from the position `quarters` to the start
    double quarter_path;
    double theta;
    double x;
    double start_radius;  // largest |t| of the series about the start [s]
    TableSeries start;    // series about t = 0, with angle and path since then
};

// Arrays of the samples of many times.
struct FlowColumns {
    double* theta;
    double* omega;
    double* x;

    FlowColumns from(std::size_t begin) const { return {theta + begin, omega + begin, x + begin}; }
};

// Writes a sample into place i of the columns.
inline void store(const FlowSample& sample, const FlowColumns& columns, std::size_t i) {
    columns.theta[i] = sample.theta;
    columns.omega[i] = sample.omega;
    columns.x[i] = sample.x;
}

struct Kernel {
    const char* name;  // name of the vector level
    // The rates of one motion at y = quarters Y + offset, |quarters| <= 1. The arrays have room for
    // a whole number of packs.
    void (*rates)(const PhaseIntegrand<double>& integrand, const PhaseMap<double>& map,
                  double quarters, const double* offsets, int count, PhaseRates<double>& found);
    // The states of bodies, each at its own time: starts[p], times[p] and samples[p] for every p in
    // `places`. A body stays open if it has to be sampled alone. Null in the kernel that takes
    // bodies one by one.
    void (*sample)(const RollingStart* starts, const double* times, const std::uint32_t* places,
                   int count, FlowSample* samples, bool* is_open);
    // Computes the motion at each place from the coordinate y of the place.
    void (*states)(const PhaseIntegrand<double>& integrand, const PhaseMap<double>& map,
                   double amplitude, TablePlace* places, int count);
    // Writes the series about places into pieces, in these units; the path starts at 0.
    void (*series)(const SeriesConstants& body, double time_unit, double length_unit,
                   TablePlace* places, int count, FlowPiece* pieces);
    // Index of the first time that is NaN or beyond +-`most`; n if there is none.
    std::size_t (*first_beyond)(const double* times, std::size_t n, double most);
    // Samples a motion at many times. Where no piece reaches, theta is NaN; true if one is.
    bool (*read)(const FlowReader& motion, const double* times, std::size_t n,
                 const FlowColumns& out);
};

Kernel kernel_avx2();
Kernel kernel_avx512();

// The kernels that this processor can run, the fastest last. The first one takes bodies one by one.
const std::vector<Kernel>& kernels();

// The fastest kernel of this processor.
const Kernel& kernel();

// The states of n bodies, each at its own time, several side by side in the lanes of a vector
// register. A body has the same bits as alone, at every vector level and beside any others. The
// bodies are not validated; throws std::invalid_argument for a time that is out of range.
void sample(const Kernel& kernel, const RollingStart* starts, const double* times, std::size_t n,
            FlowSample* samples);

// The table of a rotation or a libration, for any time. Never copied: the reader, which a kernel
// takes, points to the pieces and their ends.
struct FlowTable {
    FlowTable() = default;
    FlowTable(FlowTable&&) = default;
    FlowTable& operator=(FlowTable&&) = default;

    std::vector<FlowPiece> pieces;
    std::vector<double> ends;
    FlowReader reader;
};

// The table of a motion; empty where no series holds.
std::optional<FlowTable> flow_table(const RollingFlow& flow);

// Sampler of a motion, to which it refers, for an expected number of times. A few times need no
// table, nor do rest and uniform rotation. The bits of a sample depend on its time only, not on the
// others.
class FlowSampler {
  public:
    FlowSampler(const RollingFlow& flow, std::size_t expected);

    void operator()(const double* times, std::size_t n, const FlowColumns& out) const;
    void operator()(const double* times, std::size_t n, FlowSample* samples) const;

  private:
    const RollingFlow& flow_;
    std::optional<FlowTable> table_;
};

}  // namespace rolling_ellipse
