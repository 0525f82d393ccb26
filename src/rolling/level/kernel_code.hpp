// The functions of a Kernel. They are compiled in a separate source file for each vector level, and
// therefore call no function of the standard library (numerics/lanes.hpp).
#pragma once

#include "rolling/level/kernel.hpp"
#include "rolling/level/motion.hpp"

namespace rolling_ellipse {
namespace {

void rates(const PhaseIntegrand<double>& integrand, const PhaseMap<double>& map, double quarters,
           const double* offsets, int count, PhaseRates<double>& found) {
    // The compiler need not reload local copies after a store into `found`.
    const PhaseIntegrand<double> constants = integrand;
    const PhaseMap<double> coordinate = map;
    for (int i = 0; i < count; i += lanes) {
        const PhaseIncrement<Pack> at =
            phase_rate_at(constants, coordinate, quarters, load(offsets + i));
        store(at.time, found.time + i);
        store(at.angle, found.angle + i);
        store(at.path, found.path + i);
    }
}

// Computes the states of bodies side by side. `is_open` marks bodies whose times are so late that
// they must be sampled alone.
void sample(const RollingStart* starts, const double* times, const std::uint32_t* places, int count,
            FlowSample* samples, bool* is_open) {
    PhaseMotion<Pack> motion;
    for (int first = 0; first < count; first += lanes) {
        PhaseStart<Pack> start{};
        Pack t{};
        for (int lane = 0; lane < lanes; ++lane) {  // the last body fills the remaining lanes
            const int at = first + lane < count ? first + lane : count - 1;
            set_lane(start, lane, phase_start(starts[places[at]]));
            t[lane] = times[places[at]];
        }
        set_motion(motion, start);
        const Mask<Pack> is_long = negated(is_short(motion, t));
        if (any(is_long)) set_quarter(motion.phase);
        const Mask<Pack> is_late = is_long & (abs(t) > 1e15 * motion.phase.half_turn.high);
        const MotionSample<Pack> now = sample_at(motion, start, is_late ? Pack{} : t);
        for (int lane = 0; lane < lanes && first + lane < count; ++lane) {
            samples[places[first + lane]] = {now.theta[lane], now.omega[lane], now.x[lane]};
            is_open[first + lane] = is_late[lane] != 0;
        }
    }
}

// One member of several points, one point in each lane; lanes beyond either end repeat the first or
// last point.
inline Pack gathered(const TablePlace* places, int count, int first, double TablePlace::* number) {
    Pack found{};
    for (int lane = 0; lane < lanes; ++lane) {
        const int i = first + lane < count ? first + lane : count - 1;
        set_lane(found, lane, places[i < 0 ? 0 : i].*number);
    }
    return found;
}

void states(const PhaseIntegrand<double>& integrand, const PhaseMap<double>& map, double amplitude,
            TablePlace* places, int count) {
    // Between neighbouring points, eight nodes suffice for full double precision.
    constexpr GaussRule rule = gauss_rules[6];
    static_assert(rule.size == 8);
    for (int first = 0; first < count; first += lanes) {
        const Pack y = gathered(places, count, first, &TablePlace::y);
        const Pack from = gathered(places, count, first - 1, &TablePlace::y);
        const Pack middle = 0.5 * (y + from);
        const Pack half = 0.5 * (y - from);
        Pack time{}, path{};
        for (int i = 0; i < rule.size / 2; ++i) {
            const Pack offset = half * rule.nodes[i];
            const PhaseIncrement<Pack> before = phase_rate_at(integrand, map, 0.0, middle - offset);
            const PhaseIncrement<Pack> after = phase_rate_at(integrand, map, 0.0, middle + offset);
            time += rule.weights[i] * (before.time + after.time);
            path += rule.weights[i] * (before.path + after.path);
        }
        time *= half;
        path *= half;

        const Mask<Pack> at_tip = y > 0.5 * map.quarter;
        const PhasePlace<Pack> place = {at_tip ? pack(1.0) : Pack{}, at_tip ? y - map.quarter : y};
        const auto [sin, cos, omega] = motion_point(integrand, amplitude, phase_point(map, place));
        const Mask<Pack> near_tip = sin > cos;
        const Pack angle = octant_angle(min(sin, cos), max(sin, cos));
        for (int lane = 0; lane < lanes && first + lane < count; ++lane) {
            TablePlace& at = places[first + lane];
            at.sin = sin[lane];
            at.cos = cos[lane];
            at.quarters = near_tip[lane] ? 1.0 : 0.0;
            at.angle = near_tip[lane] ? -angle[lane] : angle[lane];
            at.omega = omega[lane];
            at.time = time[lane];
            at.path = path[lane];
        }
    }
}

// Whether a series is accurate: its last term may be at most 1e-15, and the term before it 2e-14,
// times the largest of its terms of order 1 and 2 and the number to which the series is added. The
// last two are tested, since one may be small by chance; the omitted ones are about a twentieth of
// the last.
inline Mask<Pack> holds(const std::array<Pack, table_size>& series, Pack whole, Pack radius) {
    constexpr double rest = 1e-15;
    constexpr double rest_before = 2e-14;
    const Pack size = max(whole, max(abs(series[1]) * radius, abs(series[2]) * (radius * radius)));
    Pack power = radius;
    for (int k = 2; k < table_order; ++k) power *= radius;
    return (abs(series[table_order - 1]) * power <= rest_before * size) &
           (abs(series[table_order]) * (power * radius) <= rest * size);
}

void series(const SeriesConstants& body, double time_unit, double length_unit, TablePlace* places,
            int count, FlowPiece* pieces) {
    const double per_unit = 1 / time_unit;
    for (int first = 0; first < count; first += lanes) {
        const Pack sin = gathered(places, count, first, &TablePlace::sin);
        const Pack cos = gathered(places, count, first, &TablePlace::cos);
        const Pack omega = gathered(places, count, first, &TablePlace::omega) * time_unit;
        const Pack radius = gathered(places, count, first, &TablePlace::radius);
        const auto motion = motion_series<table_order>(body, sin, cos, omega);
        const Pack path = abs(sin) * __builtin_sqrt(body.short_axis2);
        const Mask<Pack> good = holds(motion.angle, abs(sin), radius) &
                                holds(motion.omega, abs(omega), radius) &
                                holds(motion.path, path, radius);
        for (int lane = 0; lane < lanes && first + lane < count; ++lane) {
            TablePlace& at = places[first + lane];
            at.holds = good[lane] ? 1.0 : 0.0;
            auto& rows = pieces[first + lane].series.rows;
            for (int k = 0; k < table_size; ++k) {
                rows[k][0] = motion.angle[k][lane];
                rows[k][1] = motion.omega[k][lane] * per_unit;
                rows[k][2] = motion.path[k][lane] * length_unit;
            }
            rows[0][0] = at.angle;
        }
    }
}

// Number of times that each stage of `read` processes together.
constexpr int block = 64;
static_assert(block % lanes == 0);

struct alignas(64) Block {
    double turns[block];  // whole half turns
    double time[block];   // time since the nearest flat position, in two parts
    double low[block];
    // Angle and path from the nearest flat position, or from the tip `quarters` away from it.
    double angle[block];
    double omega[block];
    double path[block];
    double quarters[block];
};

// Subtracts the duration of whole half turns from t + start_time in double-double arithmetic: at
// late times, even the low part of this duration is longer than a piece.
void reduce(const FlowReader& motion, const double* times, int n, Block& block) {
    const DoubleDouble period = motion.half_turn;
    const DoubleDouble start = motion.start_time;
    for (int i = 0; i < n; i += lanes) {
        const Pack t = load(times + i);
        const Pack turns = nearest((t + start.high) * motion.half_turns_per_time);
        const PackPair turned = two_product(turns, pack(period.high));
        const PackPair rest = two_sum(t, -turned.high);
        const PackPair high = two_sum(rest.high, pack(start.high));
        const Pack low = (rest.low + high.low) - (turned.low + turns * period.low) + start.low;
        const PackPair time = two_sum(high.high, low);
        store(turns, block.turns + i);
        store(time.high, block.time + i);
        store(time.low, block.low + i);
    }
}

// Evaluates one series at several times, with independent sums of even and odd powers.
inline MotionSample<Pack> together(const TableSeries& series, Pack z) {
    const auto& rows = series.rows;
    const Pack z2 = z * z;
    const auto column = [&](int i) {
        Pack even = pack(rows[table_order][i]);
        Pack odd = pack(rows[table_order - 1][i]);
#pragma GCC unroll 16
        for (int k = table_order - 2; k > 0; k -= 2) {
            even = even * z2 + rows[k][i];
            odd = odd * z2 + rows[k - 1][i];
        }
        even = even * z2 + rows[0][i];
        return even + odd * z;
    };
    return {column(0), column(1), column(2)};
}

// Evaluates a series at one time, with its columns and its even and odd rows in separate lanes.
inline void alone(const TableSeries& series, double z, Block& block, int i) {
    constexpr int parts = 2 * series_columns / lanes;
    const double z2 = z * z;
    Pack sums[parts];
#pragma GCC unroll 16
    for (int part = 0; part < parts; ++part) {
        sums[part] = load(series.rows[table_order] + part * lanes);
#pragma GCC unroll 16
        for (int k = table_order - 2; k >= 0; k -= 2) {
            sums[part] = sums[part] * z2 + load(series.rows[k] + part * lanes);
        }
    }
    alignas(64) double even_odd[2 * series_columns];
#pragma GCC unroll 16
    for (int part = 0; part < parts; ++part) store(sums[part], even_odd + part * lanes);
    using Row [[gnu::vector_size(series_columns * sizeof(double))]] = double;
    Row even, odd;
    __builtin_memcpy(&even, even_odd, sizeof even);
    __builtin_memcpy(&odd, even_odd + series_columns, sizeof odd);
    const Row sum = even + odd * z;
    block.angle[i] = sum[0];
    block.omega[i] = sum[1];
    block.path[i] = sum[2];
}

// Finds the piece for a time by bisection, without branches, which would be mispredicted for
// unsorted times.
inline const FlowPiece& piece_at(const FlowReader& motion, double time) {
    int i = 0;
    for (int half = motion.half; half > 0; half /= 2) {
        i += time >= motion.ends[i + half - 1] ? half : 0;
    }
    return motion.pieces[i];
}

// Evaluates, for each time of the block, the series of the piece that contains it.
void sample_series(const FlowReader& motion, int n, Block& block) {
    const FlowPiece* recent = motion.pieces;
    for (int i = 0; i < n; i += lanes) {
        const Pack time = load(block.time + i);
        const Pack low = load(block.low + i);
        const Pack since = abs(time);
        const Pack since_low = time < 0 ? -low : low;
        const auto holds = [&](const FlowPiece& piece) {
            return !any((since < piece.low) | (since >= piece.high));
        };
        if (!holds(*recent)) recent = &piece_at(motion, since[0]);
        if (holds(*recent)) {
            const Pack z = ((since - recent->centre.high) + (since_low - recent->centre.low)) *
                           motion.per_unit;
            const MotionSample<Pack> at = together(recent->series, z);
            store(at.theta, block.angle + i);
            store(at.omega, block.omega + i);
            store(at.x, block.path + i);
            store(pack(recent->quarters), block.quarters + i);
            continue;
        }
        for (int lane = 0; lane < lanes; ++lane) {
            const FlowPiece& piece = piece_at(motion, since[lane]);
            const double z =
                ((since[lane] - piece.centre.high) + (since_low[lane] - piece.centre.low)) *
                motion.per_unit;
            alone(piece.series, z, block, i + lane);
            block.quarters[i + lane] = piece.quarters;
        }
    }
}

// Converts the values of the series in a block to samples. theta is NaN at times beyond the last
// piece; returns whether there are any.
bool combine(const FlowReader& motion, const double* times, int n, const Block& block,
             const FlowColumns& out) {
    bool some_lost = false;
    for (int i = 0; i < n; i += lanes) {
        const Pack t = load(times + i);
        const Pack turns = load(block.turns + i);
        const Pack time = load(block.time + i);
        const Pack odd = turns - 2 * nearest(0.5 * turns);
        const Pack spin = motion.spin - (2 * motion.spin * motion.alternates) * (odd * odd);
        const Pack heading = time < 0 ? -spin : spin;
        const Pack quarters = motion.quarters_per_half_turn * turns +
                              (heading * load(block.quarters + i) - motion.quarters);
        const PackPair turned = two_product(quarters, pack(half_pi_exact.high));
        const PackPair angle = two_sum(turned.high, pack(motion.angle.high));
        const Pack low = angle.low + turned.low + quarters * half_pi_exact.low + motion.angle.low;
        Pack theta = angle.high + (low + heading * load(block.angle + i));
        Pack omega = spin * load(block.omega + i);
        Pack x = motion.x +
                 ((quarters * motion.quarter_path - motion.path) + heading * load(block.path + i));
        const Mask<Pack> at_start = abs(t) <= motion.start_radius;
        if (any(at_start)) {
            const MotionSample<Pack> at = together(motion.start, t * motion.per_unit);
            theta = at_start ? motion.theta + at.theta : theta;
            omega = at_start ? at.omega : omega;
            x = at_start ? motion.x + at.x : x;
        }
        const Mask<Pack> lost = (abs(time) >= motion.last_end) & ~at_start;
        if (any(lost)) {
            some_lost = true;
            theta = lost ? pack(__builtin_nan("")) : theta;
        }
        store(theta, out.theta + i);
        store(omega, out.omega + i);
        store(x, out.x + i);
    }
    return some_lost;
}

bool read_block(const FlowReader& motion, const double* times, int n, const FlowColumns& out) {
    Block block;
    reduce(motion, times, n, block);
    sample_series(motion, n, block);
    return combine(motion, times, n, block, out);
}

bool read(const FlowReader& motion, const double* times, std::size_t n, const FlowColumns& out) {
    bool some_lost = false;
    std::size_t i = 0;
    for (; i + block <= n; i += block) {
        some_lost |= read_block(motion, times + i, block, out.from(i));
    }
    if (i == n) return some_lost;
    // The last time fills the remaining lanes of a pack.
    const int left = int(n - i);
    double last[block], theta[block], omega[block], x[block];
    for (int j = 0; j < block; ++j) last[j] = times[j < left ? i + j : n - 1];
    const int whole = (left + lanes - 1) / lanes * lanes;
    some_lost |= read_block(motion, last, whole, {theta, omega, x});
    for (int j = 0; j < left; ++j) {
        out.theta[i + j] = theta[j];
        out.omega[i + j] = omega[j];
        out.x[i + j] = x[j];
    }
    return some_lost;
}

std::size_t first_beyond(const double* times, std::size_t n, double most) {
    std::size_t i = 0;
    Mask<Pack> within = Pack{} == Pack{};
    for (; i + lanes <= n; i += lanes) within &= abs(load(times + i)) <= most;
    if (any(negated(within))) i = 0;
    while (i < n && times[i] <= most && -times[i] <= most) ++i;
    return i;
}

constexpr const char* level = lanes == 2 ? "sse2" : lanes == 4 ? "avx2" : "avx512";
constexpr Kernel compiled = {level, rates, sample, states, series, first_beyond, read};

}  // namespace
}  // namespace rolling_ellipse
