// The code of a FlowKernel. It is compiled for each vector level in a source of its own, see
// numerics/lanes.hpp: nothing of the library is called.
#pragma once

#include "numerics/gauss_legendre.hpp"
#include "numerics/lanes.hpp"
#include "rolling/flow_reader.hpp"
#include "rolling/phase_rates.hpp"

namespace rolling_ellipse {
namespace {

using LaneSeries = Pack[table_size];

inline Pack load(const Eight& from, int lane) { return load(from.of + lane); }
inline void store(Pack values, Eight& to, int lane) { store(values, to.of + lane); }

// |dt/dtangent|, physics (29).
inline Pack time_rate(const PhaseRate<double>& rate, Mask<Pack> at_tip, Pack tangent) {
    const double kappa2 = rate.kappa * rate.kappa;
    const Pack tan2 = tangent * tangent;
    const Pack sin2 = (at_tip ? pack(1.0) : tan2) / (1 + tan2);
    const Pack under = (1 + tan2) * (at_tip ? tan2 + kappa2 : 1 + kappa2 * tan2);
    return sqrt(shape_factor2<Pack>(rate, rate.amplitude2 * sin2) / under);
}

void states(const PhaseRate<double>& rate, const PlaceBatch& at, StateBatch& found, int lane) {
    const Mask<Pack> at_tip = load(at.at_tip, lane) > 0;
    const Pack tangent = load(at.tangent, lane);
    const Pack from = load(at.from, lane);
    const Pack middle = 0.5 * (tangent + from);
    const Pack half = abs(0.5 * (tangent - from));
    // Places are so near to each other that eight nodes are exact to rounding.
    constexpr int nodes = 4;
    Pack sum{};
    for (int i = 0; i < nodes; ++i) {
        const Pack offset = half * gauss_tables::nodes_8[i];
        sum += gauss_tables::weights_8[i] * (time_rate(rate, at_tip, middle - offset) +
                                             time_rate(rate, at_tip, middle + offset));
    }
    store(sum * half, found.duration, lane);

    const Pack adjacent = 1 / sqrt(1 + tangent * tangent);
    const Pack opposite = tangent * adjacent;
    const Pack sin = at_tip ? adjacent : opposite;
    const Pack cos = at_tip ? opposite : adjacent;
    const Pack across = sqrt(cos * cos + rate.kappa * rate.kappa * (sin * sin));
    const Pack factor = sqrt(shape_factor2<Pack>(rate, rate.amplitude2 * (sin * sin)));
    const double amplitude = __builtin_sqrt(rate.amplitude2);
    const Pack body_sin = amplitude * sin;
    const Pack body_cos = rate.rotates ? cos : across;
    const Mask<Pack> near_tip = body_sin > body_cos;
    const Pack angle = octant_angle(min(body_sin, body_cos), max(body_sin, body_cos));
    store(body_sin, found.sin, lane);
    store(body_cos, found.cos, lane);
    store(near_tip ? pack(1.0) : pack(0.0), found.near_tip, lane);
    store(near_tip ? -angle : angle, found.angle, lane);
    store((rate.rotates ? across : amplitude * cos) / factor, found.omega, lane);
}

// Physics (18) with D h^2 = d0 + d1 q, u = h^2, q and p the square of the sine and the product of
// sine and cosine of the angle:
//     omega' u (d0 + d1 q) = -c2 p (g u h + S^2 omega^2),   q' = 2 p omega,   p' = (1 - 2 q) omega
void series(const TableConstants& body, const StateBatch& at, SeriesBatch& found, int lane) {
    const Pack sin = load(at.sin, lane);
    LaneSeries q{sin * sin}, p{sin * load(at.cos, lane)}, w{load(at.omega, lane)};
    Pack over_2h{}, over_mass{};
    LaneSeries u{}, h{}, inertia{}, mass{}, push{}, turning{};
    store(pack(0.0), found.angle[0], lane);
    store(pack(0.0), found.path[0], lane);
#pragma GCC unroll 16
    for (int k = 0; k < table_size; ++k) {
        u[k] = body.c2 * q[k];
        inertia[k] = body.d1 * q[k];
        if (k == 0) {
            u[0] += body.short_axis2;
            inertia[0] += body.d0;
            h[0] = sqrt(u[0]);
            over_2h = 0.5 / h[0];
            over_mass = 1 / (u[0] * inertia[0]);
        } else {
            h[k] = (u[k] - self_product(h, k, 1)) * over_2h;
        }
        store(w[k], found.omega[k], lane);
        if (k == table_order) break;
        mass[k] = product(u, inertia, k);
        push[k] = body.gravity * product(u, h, k) + body.short_axis2 * self_product(w, k);
        const Pack force = -body.c2 * product(p, push, k);
        turning[k] = (force - terms(mass, turning, k, 1, k)) * over_mass;
        const Pack qw = product(q, w, k);
        const double next = 1.0 / (k + 1);
        q[k + 1] = 2 * next * product(p, w, k);
        p[k + 1] = next * (w[k] - 2 * qw);
        w[k + 1] = next * turning[k];
        store(next * w[k], found.angle[k + 1], lane);
        store(next * product(h, w, k), found.path[k + 1], lane);
    }
}

inline Pack value(const Eight (&series)[table_size], Pack z, int lane) {
    Pack sum = load(series[table_order], lane);
    for (int k = table_order - 1; k >= 0; --k) sum = sum * z + load(series[k], lane);
    return sum;
}

// The last terms, of which one may be small by chance, are some roundings beside what the series is
// part of; what is left out is smaller by another twentieth.
inline Mask<Pack> holds(const Eight (&series)[table_size], Pack whole, Pack radius, int lane) {
    constexpr double rest = 1e-15;
    constexpr double rest_before = 2e-14;
    const Pack size = max(whole, max(abs(load(series[1], lane)) * radius,
                                     abs(load(series[2], lane)) * (radius * radius)));
    Pack power = radius;
    for (int k = 2; k < table_order; ++k) power *= radius;
    return (abs(load(series[table_order - 1], lane)) * power <= rest_before * size) &
           (abs(load(series[table_order], lane)) * (power * radius) <= rest * size);
}

void reach(const SeriesBatch& series, ReachBatch& found, int lane) {
    const Pack back = load(found.back, lane);
    const Pack forward = load(found.forward, lane);
    const Pack radius = max(back, forward);
    const Mask<Pack> good = holds(series.angle, load(found.angle, lane), radius, lane) &
                            holds(series.omega, abs(load(series.omega[0], lane)), radius, lane) &
                            holds(series.path, load(found.path, lane), radius, lane);
    store(good ? pack(1.0) : pack(0.0), found.holds, lane);
    store(value(series.path, -back, lane), found.path_back, lane);
    store(value(series.path, forward, lane), found.path_forward, lane);
}

// The most times that are on the way through `read` together.
constexpr int block = 64;
static_assert(block % lanes == 0 && batch_size % lanes == 0);

struct alignas(64) Block {
    double turns[block];  // whole half turns
    double time[block];   // since the nearest flat position, in two parts
    double low[block];
    // Since there, or since the tip that is so many quarters from it.
    double angle[block];
    double omega[block];
    double path[block];
    double quarters[block];
};

// t + start - n T without rounding. Of a late time the low part of n T is longer than a piece.
void reduce(const FlowReader& motion, const double* times, int n, Block& found) {
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
        store(turns, found.turns + i);
        store(time.high, found.time + i);
        store(time.low, found.low + i);
    }
}

struct Motions {
    Pack angle;
    Pack omega;
    Pack path;
};

// One series at several times: even and odd powers, as two sums need not wait for each other.
inline Motions together(const TableSeries& series, Pack z) {
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

// A series at one time: its columns side by side, and its even and odd rows.
inline void alone(const TableSeries& series, double z, Block& found, int i) {
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
    found.angle[i] = sum[0];
    found.omega[i] = sum[1];
    found.path[i] = sum[2];
}

// By halves, without a branch for the processor to guess: times may come in any order.
inline const FlowPiece& piece_at(const FlowReader& motion, double time) {
    int i = 0;
    for (int half = motion.half; half > 0; half /= 2) {
        i += time >= motion.ends[i + half - 1] ? half : 0;
    }
    return motion.pieces[i];
}

void look_up(const FlowReader& motion, int n, Block& block) {
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
            const Motions found = together(recent->series, z);
            store(found.angle, block.angle + i);
            store(found.omega, block.omega + i);
            store(found.path, block.path + i);
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

// What the motion is at these times; theta is NaN beyond its pieces. Returns whether one is.
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
            const Motions at = together(*motion.start, t * motion.per_unit);
            theta = at_start ? motion.theta + at.angle : theta;
            omega = at_start ? at.omega : omega;
            x = at_start ? motion.x + at.path : x;
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
    look_up(motion, n, block);
    return combine(motion, times, n, block, out);
}

bool read(const FlowReader& motion, const double* times, std::size_t n, const FlowColumns& out) {
    bool some_lost = false;
    std::size_t i = 0;
    for (; i + block <= n; i += block) {
        some_lost |= read_block(motion, times + i, block, out.from(i));
    }
    if (i == n) return some_lost;
    // The last of them fills what is left of a pack.
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

}  // namespace
}  // namespace rolling_ellipse
