// A table of exact rolling, and the numbers of which it is made and by which it is read.
#pragma once

#include <cstddef>

#include "numerics/double_double.hpp"
#include "numerics/series.hpp"

namespace rolling_ellipse {

inline constexpr int table_order = 14;
inline constexpr int table_size = table_order + 1;
inline constexpr int series_columns = 4;  // angle, omega, path; a row of a series fills a register

// Angle, angular velocity and path as power series in time, from a place of the motion on. One
// more row, of zeros: rows are read in pairs.
struct TableSeries {
    alignas(64) double rows[table_size + 1][series_columns];
};

// A place of a table, and the motion there on the way up.
struct TablePlace {
    double y;         // the coordinate of rolling/level/phase.hpp
    double sin, cos;  // of the angle from the flat position
    double quarters;  // from the flat position to the nearer one of it and the tip: 0 or 1
    double angle;     // from there
    double omega;
    double time, path;  // since the place before
    double radius;  // of the time interval in which the series is used, in units of its variable
    double holds;   // 1 if the series has full double precision there, otherwise 0
};

struct FlowPiece {
    DoubleDouble centre;  // times since the flat position
    double low;
    double high;
    double quarters;  // from the flat position to where angle and path are counted from
    TableSeries series;
};

// A motion as its pieces see it.
struct FlowReader {
    const FlowPiece* pieces;
    const double* ends;  // of the pieces, and infinities: 2 half - 1 of them
    int half;
    double last_end;
    double per_unit;  // of time, to the variable of the series
    // Half turns and the time since the flat position.
    DoubleDouble half_turn;
    double half_turns_per_time;
    DoubleDouble start_time;
    // Which way it goes: spin after an even number of half turns, and whether it changes with them.
    double spin;
    double alternates;
    double quarters_per_half_turn;
    // The start.
    double quarters;
    DoubleDouble angle;  // theta less that of the start from its quarter
    double path;         // that of the start from its quarter
    double quarter_path;
    double theta;
    double x;
    double start_radius;  // of times for which its own series holds
    TableSeries start;    // about t = 0; angle and path are those since then
};

struct FlowColumns {
    double* theta;
    double* omega;
    double* x;

    FlowColumns from(std::size_t begin) const { return {theta + begin, omega + begin, x + begin}; }
};

}  // namespace rolling_ellipse
