// The table of an exact motion: its places, its pieces, and the numbers by which it is read.
#pragma once

#include <cstddef>

#include "numerics/double_double.hpp"
#include "numerics/series.hpp"

namespace rolling_ellipse {

inline constexpr int table_order = 14;
inline constexpr int table_size = table_order + 1;
inline constexpr int series_columns = 4;  // angle, omega, path; a row of a series fills a register

// Power series in time of angle, angular velocity and path about a place. The last row is zero,
// since rows are read in pairs.
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

// The series of an interval of times since the flat position.
struct FlowPiece {
    DoubleDouble centre;
    double low;
    double high;
    double quarters;  // from the flat position to the origin of angle and path
    TableSeries series;
};

// A motion as the kernel reads it.
struct FlowReader {
    const FlowPiece* pieces;
    const double* ends;  // of the pieces, then infinities: 2 half - 1 numbers
    int half;
    double last_end;
    double per_unit;  // variable of the series over time [1/s]
    // The time of a half turn, and the time of the start since the flat position.
    DoubleDouble half_turn;
    double half_turns_per_time;
    DoubleDouble start_time;
    // Sign of the motion after an even number of half turns, and 1 if each half turn changes it.
    double spin;
    double alternates;
    double quarters_per_half_turn;
    // The start, as quarters and an offset.
    double quarters;
    DoubleDouble angle;  // theta less the offset of the angle
    double path;         // offset of the path
    double quarter_path;
    double theta;
    double x;
    double start_radius;  // largest |t| of the series about the start [s]
    TableSeries start;    // about t = 0, with angle and path since then
};

// Arrays of the samples of many times.
struct FlowColumns {
    double* theta;
    double* omega;
    double* x;

    FlowColumns from(std::size_t begin) const { return {theta + begin, omega + begin, x + begin}; }
};

}  // namespace rolling_ellipse
