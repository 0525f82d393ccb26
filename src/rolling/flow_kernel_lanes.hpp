// The code of a FlowKernel. It is compiled for each vector level in a source of its own: all of it
// is without linkage, and nothing of the library is called, so that no code of one level can stand
// in for that of another.
#pragma once

#include "numerics/gauss_legendre.hpp"
#include "rolling/flow_kernel.hpp"

namespace rolling_ellipse {
namespace {

using Lanes [[gnu::vector_size(lanes * sizeof(double))]] = double;
using Row [[gnu::vector_size(series_columns * sizeof(double))]] = double;
using Mask = decltype(Lanes{} < Lanes{});
using LaneSeries = Lanes[table_size];

[[gnu::always_inline]] inline Lanes load(const double* from) {
    Lanes found;
    __builtin_memcpy(&found, from, sizeof found);
    return found;
}

[[gnu::always_inline]] inline Lanes load(const Eight& from) { return load(from.of); }

[[gnu::always_inline]] inline void store(const Lanes& values, double* to) {
    __builtin_memcpy(to, &values, sizeof values);
}

[[gnu::always_inline]] inline void store(const Lanes& values, Eight& to) { store(values, to.of); }

[[gnu::always_inline]] inline Row row(const double* from) {
    Row found;
    __builtin_memcpy(&found, from, sizeof found);
    return found;
}

[[gnu::always_inline]] inline Lanes all(double value) { return value + Lanes{}; }

[[gnu::always_inline]] inline Lanes root(const Lanes& values) {
    Lanes found;
    for (int i = 0; i < lanes; ++i) found[i] = __builtin_sqrt(values[i]);
    return found;
}

[[gnu::always_inline]] inline Lanes absolute(const Lanes& values) {
    return values < 0 ? -values : values;
}

[[gnu::always_inline]] inline Lanes larger(const Lanes& one, const Lanes& other) {
    return one > other ? one : other;
}

[[gnu::always_inline]] inline bool any(const Mask& mask) {
    long long found = 0;
    for (int i = 0; i < lanes; ++i) found |= mask[i];
    return found != 0;
}

// The nearest whole number, for numbers up to 2^51.
[[gnu::always_inline]] inline Lanes nearest(const Lanes& values) {
    constexpr double shift = 6755399441055744.0;  // 1.5 * 2^52
    return (values + shift) - shift;
}

// What a sum x + y misses (D. E. Knuth), and a product (T. J. Dekker, Numer. Math. 18 (1971) 224).
[[gnu::always_inline]] inline Lanes missed(const Lanes& x, const Lanes& y, const Lanes& sum) {
    const Lanes y_part = sum - x;
    return (x - (sum - y_part)) + (y - y_part);
}

template <class Number>
[[gnu::always_inline]] inline Number high_half(const Number& value) {
    const Number scaled = value * 134217729.0;  // 2^27 + 1
    return scaled - (scaled - value);
}

[[gnu::always_inline]] inline Lanes product_missed(const Lanes& x, double y, const Lanes& product) {
    const Lanes x1 = high_half(x);
    const Lanes x2 = x - x1;
    const double y1 = high_half(y);
    const double y2 = y - y1;
    return ((x1 * y1 - product) + x1 * y2 + x2 * y1) + x2 * y2;
}

// scale^2 D (H + h), physics (28, 29).
[[gnu::always_inline]] inline Lanes shape_factor2(const PhaseRate& rate, const Lanes& sin2_phi) {
    const Lanes h2 = square(rate.short_axis) + rate.c2 * sin2_phi;
    return rate.scale2 * (rate.d0 + rate.d1 * sin2_phi) * (rate.energy_height + root(h2)) / h2;
}

// |dt/dtangent|, physics (29).
[[gnu::always_inline]] inline Lanes time_rate(const PhaseRate& rate, const Mask& at_tip,
                                              const Lanes& tangent) {
    const double kappa2 = square(rate.kappa);
    const Lanes tan2 = tangent * tangent;
    const Lanes sin2 = (at_tip ? all(1.0) : tan2) / (1 + tan2);
    const Lanes under = (1 + tan2) * (at_tip ? tan2 + kappa2 : 1 + kappa2 * tan2);
    return root(shape_factor2(rate, rate.amplitude2 * sin2) / under);
}

void states(const PhaseRate& rate, bool rotates, const PlaceBatch& at, StateBatch& found) {
    const Mask at_tip = load(at.at_tip) > 0;
    const Lanes tangent = load(at.tangent);
    const Lanes from = load(at.from);
    const Lanes middle = 0.5 * (tangent + from);
    const Lanes half = absolute(0.5 * (tangent - from));
    // Places are so near to each other that eight nodes are exact to rounding.
    constexpr int nodes = 4;
    Lanes sum{};
    for (int i = 0; i < nodes; ++i) {
        const Lanes offset = half * gauss_tables::nodes_8[i];
        sum += gauss_tables::weights_8[i] * (time_rate(rate, at_tip, middle - offset) +
                                             time_rate(rate, at_tip, middle + offset));
    }
    store(sum * half, found.duration);

    const Lanes adjacent = 1 / root(1 + tangent * tangent);
    const Lanes opposite = tangent * adjacent;
    const Lanes sin = at_tip ? adjacent : opposite;
    const Lanes cos = at_tip ? opposite : adjacent;
    const Lanes across = root(cos * cos + square(rate.kappa) * (sin * sin));
    const Lanes factor = root(shape_factor2(rate, rate.amplitude2 * (sin * sin)));
    const double amplitude = __builtin_sqrt(rate.amplitude2);
    store(amplitude * sin, found.sin);
    store(rotates ? cos : across, found.cos);
    store((rotates ? across : amplitude * cos) / factor, found.omega);
}

// Physics (18) with D h^2 = d0 + d1 q, u = h^2, q and p the square of the sine and the product of
// sine and cosine of the angle:
//     omega' u (d0 + d1 q) = -c2 p (g u h + S^2 omega^2),   q' = 2 p omega,   p' = (1 - 2 q) omega
void series(const TableConstants& body, const StateBatch& at, SeriesBatch& found) {
    const Lanes sin = load(at.sin);
    LaneSeries q{sin * sin}, p{sin * load(at.cos)}, w{load(at.omega)};
    LaneSeries u{}, h{}, inertia{}, mass{}, push{}, turning{};
    store(all(0.0), found.angle[0]);
    store(all(0.0), found.path[0]);
#pragma GCC unroll 16
    for (int k = 0; k < table_size; ++k) {
        u[k] = body.c2 * q[k];
        inertia[k] = body.d1 * q[k];
        if (k == 0) {
            u[0] += body.short_axis2;
            inertia[0] += body.d0;
            h[0] = root(u[0]);
        } else {
            h[k] = (u[k] - self_product(h, k, 1)) / (2 * h[0]);
        }
        store(w[k], found.omega[k]);
        if (k == table_order) break;
        mass[k] = product(u, inertia, k);
        push[k] = body.gravity * product(u, h, k) + body.short_axis2 * self_product(w, k);
        const Lanes force = -body.c2 * product(p, push, k);
        turning[k] = (force - terms(mass, turning, k, 1, k)) / mass[0];
        const Lanes qw = product(q, w, k);
        const double next = 1.0 / (k + 1);
        q[k + 1] = 2 * next * product(p, w, k);
        p[k + 1] = next * (w[k] - 2 * qw);
        w[k + 1] = next * turning[k];
        store(next * w[k], found.angle[k + 1]);
        store(next * product(h, w, k), found.path[k + 1]);
    }
}

[[gnu::always_inline]] inline Lanes value(const Eight (&series)[table_size], const Lanes& z) {
    Lanes sum = load(series[table_order]);
    for (int k = table_order - 1; k >= 0; --k) sum = sum * z + load(series[k]);
    return sum;
}

// The last terms, of which one may be small by chance, are some roundings beside what the series is
// part of; what is left out is smaller by another twentieth.
[[gnu::always_inline]] inline Mask holds(const Eight (&series)[table_size], const Lanes& whole,
                                         const Lanes& radius) {
    constexpr double rest = 1e-15;
    constexpr double rest_before = 2e-14;
    const Lanes size = larger(whole, larger(absolute(load(series[1])) * radius,
                                            absolute(load(series[2])) * (radius * radius)));
    Lanes power = radius;
    for (int k = 2; k < table_order; ++k) power *= radius;
    return (absolute(load(series[table_order - 1])) * power <= rest_before * size) &
           (absolute(load(series[table_order])) * (power * radius) <= rest * size);
}

void reach(const SeriesBatch& series, ReachBatch& found) {
    const Lanes back = load(found.back);
    const Lanes forward = load(found.forward);
    const Lanes radius = larger(back, forward);
    const Mask good = holds(series.angle, load(found.angle), radius) &
                      holds(series.omega, absolute(load(series.omega[0])), radius) &
                      holds(series.path, load(found.path), radius);
    store(good ? all(1.0) : all(0.0), found.holds);
    store(value(series.path, -back), found.path_back);
    store(value(series.path, forward), found.path_forward);
}

struct Motions {
    Lanes angle;
    Lanes omega;
    Lanes path;
};

// One series at eight times.
[[gnu::always_inline]] inline Motions together(const TableSeries& series, const Lanes& z) {
    const auto& rows = series.rows;
    Motions sum{all(rows[table_order][0]), all(rows[table_order][1]), all(rows[table_order][2])};
#pragma GCC unroll 16
    for (int k = table_order - 1; k >= 0; --k) {
        sum.angle = sum.angle * z + rows[k][0];
        sum.omega = sum.omega * z + rows[k][1];
        sum.path = sum.path * z + rows[k][2];
    }
    return sum;
}

// A series at one time, its three columns side by side.
[[gnu::always_inline]] inline Row alone(const TableSeries& series, double z) {
    Row sum = row(series.rows[table_order]);
#pragma GCC unroll 16
    for (int k = table_order - 1; k >= 0; --k) sum = sum * z + row(series.rows[k]);
    return sum;
}

[[gnu::always_inline]] inline const FlowPiece& piece_at(const FlowReader& motion, double time) {
    const double bucket = time * motion.buckets_per_time;
    const std::size_t last = motion.buckets - 1;
    std::size_t i = motion.first[bucket < double(last) ? std::size_t(bucket) : last];
    while (i + 1 < motion.count && time >= motion.pieces[i].high) ++i;
    return motion.pieces[i];
}

// Eight times; see FlowKernel::read.
[[gnu::always_inline]] inline bool read_eight(const FlowReader& motion, const Lanes& t,
                                              Lanes& theta, Lanes& omega, Lanes& x) {
    // The time since the nearest flat position, in two parts: t + start - n T without rounding.
    const DoubleDouble period = motion.half_turn;
    const Lanes n = nearest((t + motion.start_time.high) * motion.half_turns_per_time);
    const Lanes turned = n * period.high;
    const Lanes rest = t - turned;
    const Lanes time = rest + motion.start_time.high;
    const Lanes low = (missed(t, -turned, rest) + missed(rest, all(motion.start_time.high), time)) -
                      (product_missed(n, period.high, turned) + n * period.low) +
                      motion.start_time.low;
    const Mask before = time < 0;
    const Lanes since = before ? -time : time;
    const Lanes since_low = before ? -low : low;

    const Lanes odd = n - 2 * nearest(0.5 * n);
    const Lanes spin = motion.spin - (2 * motion.spin * motion.alternates) * (odd * odd);
    const Lanes heading = before ? -spin : spin;

    const Mask at_start = absolute(t) <= motion.start_radius;
    const Mask beyond = since >= motion.pieces[motion.count - 1].high;
    const bool some_at_start = any(at_start);
    const FlowPiece& first = piece_at(motion, since[0]);
    Motions at;
    Lanes quarters;
    if (!some_at_start && !any((since < first.low) | (since >= first.high))) {
        const Lanes z =
            ((since - first.centre.high) + (since_low - first.centre.low)) * motion.per_unit;
        at = together(first.series, z);
        quarters = all(first.quarters);
    } else if (some_at_start && !any(!at_start)) {
        at = together(*motion.start, t * motion.per_unit);
        quarters = all(0.0);
    } else {
        Eight of[3], to;
        for (int i = 0; i < lanes; ++i) {
            const FlowPiece& piece = piece_at(motion, since[i]);
            const double z = ((since[i] - piece.centre.high) + (since_low[i] - piece.centre.low)) *
                             motion.per_unit;
            const Row found =
                at_start[i] ? alone(*motion.start, t[i] * motion.per_unit) : alone(piece.series, z);
            for (int column = 0; column < 3; ++column) of[column].of[i] = found[column];
            to.of[i] = piece.quarters;
        }
        at = {load(of[0]), load(of[1]), load(of[2])};
        quarters = load(to);
    }

    const Lanes all_quarters =
        motion.quarters_per_half_turn * n + (heading * quarters - motion.quarters);
    const Lanes turns = all_quarters * half_pi_exact.high;
    const Lanes angle = turns + motion.angle.high;
    const Lanes angle_low = missed(turns, all(motion.angle.high), angle) +
                            product_missed(all_quarters, half_pi_exact.high, turns) +
                            all_quarters * half_pi_exact.low + motion.angle.low;
    theta = angle + (angle_low + heading * at.angle);
    omega = spin * at.omega;
    x = motion.x + ((all_quarters * motion.quarter_path - motion.path) + heading * at.path);
    if (some_at_start) {
        theta = at_start ? motion.theta + at.angle : theta;
        omega = at_start ? at.omega : omega;
        x = at_start ? motion.x + at.path : x;
    }
    const Mask lost = beyond & !at_start;
    if (!any(lost)) return false;
    theta = lost ? all(__builtin_nan("")) : theta;
    return true;
}

std::size_t first_beyond(const double* times, std::size_t n, double most) {
    std::size_t i = 0;
    Mask within = Lanes{} == Lanes{};
    for (; i + lanes <= n; i += lanes) within &= absolute(load(times + i)) <= most;
    if (any(!within)) i = 0;
    while (i < n && times[i] <= most && -times[i] <= most) ++i;
    return i;
}

bool read(const FlowReader& motion, const double* times, std::size_t n, const FlowColumns& out) {
    bool some_lost = false;
    Lanes theta, omega, x;
    std::size_t i = 0;
    for (; i + lanes <= n; i += lanes) {
        some_lost |= read_eight(motion, load(times + i), theta, omega, x);
        store(theta, out.theta + i);
        store(omega, out.omega + i);
        store(x, out.x + i);
    }
    if (i == n) return some_lost;
    Lanes last = all(times[n - 1]);
    const std::size_t left = n - i;
    for (std::size_t j = 0; j < left; ++j) last[j] = times[i + j];
    some_lost |= read_eight(motion, last, theta, omega, x);
    for (std::size_t j = 0; j < left; ++j) {
        out.theta[i + j] = theta[j];
        out.omega[i + j] = omega[j];
        out.x[i + j] = x[j];
    }
    return some_lost;
}

constexpr FlowKernel compiled = {states, series, reach, first_beyond, read};

}  // namespace
}  // namespace rolling_ellipse
