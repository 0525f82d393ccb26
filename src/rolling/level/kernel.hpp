// Exact rolling of many bodies at one time each, and of one body at many times with a table. The
// inner loops of both are compiled from the same code for several vector levels (lanes_*.cpp) and
// give the same bits at each level (numerics/lanes.hpp).
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
inline constexpr int series_columns = 4;  // angle, omega, path and padding: a row fills a register

// Power series in time for the angle, the angular velocity and the path, about a point. An extra
// row of zeros follows, since rows are read in pairs.
struct TableSeries {
    alignas(64) double rows[table_size + 1][series_columns];
};

// A point of a table, and the motion at this point on the way up from the flat position.
struct TablePlace {
    double y;         // the coordinate of rolling/level/flow.hpp
    double sin, cos;  // sine and cosine of the angle from the flat position
    double quarters;  // 0 if the flat position is nearer, 1 if the tip is
    double angle;     // angle from this flat position or tip
    double omega;
    double time, path;  // time and path from the previous point
    double radius;      // half-width of the interval of the series, in its unit of time
    double holds;       // 1 if the series has full double precision within its radius, else 0
};

// The series for an interval of the time since the flat position.
struct FlowPiece {
    DoubleDouble centre;
    double low;
    double high;
    double quarters;  // quarters from the flat position to the origin of angle and path
    TableSeries series;
};

// A motion in the form that the kernel reads.
struct FlowReader {
    const FlowPiece* pieces;
    const double* ends;  // 2 half - 1 numbers: the ends of the pieces, then infinities
    int half;
    double last_end;
    double per_unit;  // the variable of a series is per_unit times the time [1/s]
    // The duration of a half turn; start_time is the time from the flat position to the start.
    DoubleDouble half_turn;
    double half_turns_per_time;
    DoubleDouble start_time;
    // `spin` is the sign of omega after an even number of half turns; `alternates` is 1 if every
    // half turn changes this sign.
    double spin;
    double alternates;
    double quarters_per_half_turn;
    // Quarter turns from the flat position to the flat position or tip nearest the start.
    double quarters;
    DoubleDouble angle;  // theta at the position `quarters`
    double path;         // path from the position `quarters` to the start
    double quarter_path;
    double theta;
    double x;
    double start_radius;  // largest |t| of the series about the start [s]
    TableSeries start;    // series about t = 0, where its angle and path are 0
};

// Arrays for the samples of many times.
struct FlowColumns {
    double* theta;
    double* omega;
    double* x;

    FlowColumns from(std::size_t begin) const { return {theta + begin, omega + begin, x + begin}; }
};

inline void store(const FlowSample& sample, const FlowColumns& columns, std::size_t i) {
    columns.theta[i] = sample.theta;
    columns.omega[i] = sample.omega;
    columns.x[i] = sample.x;
}

struct Kernel {
    const char* name;  // name of the vector level
    // The rates of one motion at y = quarters Y + offset, |quarters| <= 1. The arrays are padded to
    // a whole number of Packs.
    void (*rates)(const PhaseIntegrand<double>& integrand, const PhaseMap<double>& map,
                  double quarters, const double* offsets, int count, PhaseRates<double>& found);
    // The states of bodies, each at its own time: starts[p], times[p] and samples[p] for every p in
    // `places`. `is_open` marks a body that must still be sampled alone. The pointer is null in the
    // kernel that computes bodies one by one.
    void (*sample)(const RollingStart* starts, const double* times, const std::uint32_t* places,
                   int count, FlowSample* samples, bool* is_open);
    // Computes the motion at each point from its coordinate y.
    void (*states)(const PhaseIntegrand<double>& integrand, const PhaseMap<double>& map,
                   double amplitude, TablePlace* places, int count);
    // Writes the series about the points into pieces. `time_unit` and `length_unit` are the units
    // of `body`; the path of each series starts at 0.
    void (*series)(const SeriesConstants& body, double time_unit, double length_unit,
                   TablePlace* places, int count, FlowPiece* pieces);
    // Index of the first time that is NaN or beyond +-`most`; n if there is none.
    std::size_t (*first_beyond)(const double* times, std::size_t n, double most);
    // Samples a motion at many times. theta is NaN at times beyond the last piece; returns whether
    // there are such times.
    bool (*read)(const FlowReader& motion, const double* times, std::size_t n,
                 const FlowColumns& out);
};

Kernel kernel_avx2();
Kernel kernel_avx512();

// The kernels that this processor can run, fastest last. The first computes bodies one by one.
const std::vector<Kernel>& kernels();

// The fastest kernel for this processor.
const Kernel& kernel();

// The states of n bodies, each at its own time, computed several at a time in the lanes of vectors.
// The bits of a state depend neither on the vector level nor on the other bodies. The bodies are
// not validated; throws std::invalid_argument for a time out of range.
void sample(const Kernel& kernel, const RollingStart* starts, const double* times, std::size_t n,
            FlowSample* samples);

// The table of series of a rotation or a libration. It cannot be copied, since its reader points to
// its pieces and their ends.
struct FlowTable {
    FlowTable() = default;
    FlowTable(FlowTable&&) = default;
    FlowTable& operator=(FlowTable&&) = default;

    std::vector<FlowPiece> pieces;
    std::vector<double> ends;
    FlowReader reader;
};

// The table of a motion; empty if no spacing of the points makes all series accurate.
std::optional<FlowTable> flow_table(const RollingFlow& flow);

// Samples a motion, to which the sampler keeps a reference. `expected` is the expected number of
// times. No table is built if this number is small, or for a body at rest or in uniform rotation.
// The bits of a sample do not depend on the other times.
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
