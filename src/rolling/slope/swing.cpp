#include "rolling/slope/swing.hpp"

#include <algorithm>
#include <cmath>

#include "rolling/slope/panel.hpp"

namespace rolling_ellipse {
namespace {

SineCosine sine_cosine(double angle) { return {std::sin(angle), std::cos(angle)}; }

// --------------------------------------------------------------------------------- panels

WellPanel flat_panel(const SlopeBody& body, double angle, const SineCosine& at,
                     const SineCosine& from_rim) {
    const double grade = grade_at_flat(body);
    const double value = at.sine / (at.cosine * grade);
    return {angle, at, grade, value, root_of_squares(1.0, value), {0.0, 1.0}, from_rim};
}

// A well: the angle of its bottom from the flat position, and the angles from the bottom to the
// uphill and the downhill rim.
struct Well {
    double bottom;
    std::array<double, 2> to_rim;
    SineCosine at_bottom;
    SineCosine downhill;  // sine and cosine of to_rim[1]
};

// The sign of the angles from the bottom on a side of a well: uphill (0) or downhill (1).
double outwards(std::size_t side) { return side == 0 ? -1.0 : 1.0; }

// The panel about the bottom for a side of the well, with angles measured outwards (direction +1)
// or towards the bottom (-1).
WellPanel bottom_panel(const SlopeBody& body, const Well& well, std::size_t side,
                       double direction) {
    const double seen = outwards(side) * direction;
    const auto [s, c] = well.at_bottom;
    const auto [rim_s, rim_c] = well.downhill;
    return flat_panel(body, seen * well.bottom, {seen * s, c},
                      {-direction * rim_s, outwards(side) * rim_c});
}

// Points of a panel: sine and cosine of their angles ahead of its centre, times the same factor as
// `sin` and `cos`, and the derivative of the angle with respect to v.
struct WellPlaces : Positions {
    Pack ahead_sin;
    Pack ahead_cos;
    Pack turned;
};

[[gnu::always_inline]] inline WellPlaces places_at(const SlopeBody& body, const WellPanel& panel,
                                                   Pack v) {
    const Pack half = 0.5 * v;
    const auto [size, falling] = hyperbolic(abs(half));
    const Pack sinh = copysign(size, half);
    const Pack cosh = size + falling;
    const Pack change = 2 * sinh * (panel.rate * cosh + panel.value * sinh);
    const Pack growth = panel.rate * (cosh * cosh + sinh * sinh) + 2 * panel.value * (sinh * cosh);
    const Pack tan = panel.grade * (panel.value + change);
    const double centre = panel.grade * panel.value;
    const Pack over = 1 / (1 + tan * tan);
    WellPlaces at;
    at.ahead_sin = panel.grade * change;
    at.ahead_cos = 1 + centre * tan;
    at.turned = panel.grade * growth * over;
    static_cast<Positions&>(at) =
        positions(body, panel.at.sine * at.ahead_cos + panel.at.cosine * at.ahead_sin,
                  panel.at.cosine * at.ahead_cos - panel.at.sine * at.ahead_sin,
                  over * (1 / (1 + square(centre))));
    return at;
}

// The coordinate v of a point, given its angle ahead of the centre; accurate even for a small
// angle. In a panel about a turning point, NaN for a point a quarter turn or more from the rim.
double coordinate(const WellPanel& panel, double ahead) {
    const double tan = std::tan(ahead);
    const double centre = panel.grade * panel.value;
    const double change = tan * (1 + square(centre)) / (panel.grade * (1 - tan * centre));
    if (panel.rate == 0) return 2 * std::asinh(std::sqrt(0.5 * change));
    const double x = panel.value;
    const double y = x + change;
    const double root = root_of_squares(1.0, y);
    return std::asinh(x * y > 0 ? change * (x + y) / (y * panel.rate + x * root)
                                : y * panel.rate - x * root);
}

// dW/dv, physics (62).
[[gnu::always_inline]] inline Pack moment_at(const SlopeBody& body, const WellPanel& panel,
                                             const WellPlaces& at) {
    return body.pull *
           (panel.to_bottom.sine * at.ahead_cos - panel.to_bottom.cosine * at.ahead_sin) *
           (panel.from_rim.sine * at.ahead_cos + panel.from_rim.cosine * at.ahead_sin) *
           (at.over * at.turned / at.h);
}

struct Reached {
    double angle;   // angle ahead of the centre
    double turned;  // derivative of the angle with respect to v
};

Reached reached(const SlopeBody& body, const WellPanel& panel, double v) {
    const WellPlaces at = places_at(body, panel, pack(v));
    return {std::atan(lane_of(at.ahead_sin, 0) / lane_of(at.ahead_cos, 0)), lane_of(at.turned, 0)};
}

// ------------------------------------------------------------------------- turning points

// The change of W from the centre of a panel to a coordinate v, with its first two derivatives.
struct Change {
    double energy;
    double rate;
    double bend;
};

// Integrates dW/dv by Gauss-Legendre quadrature. The complex zeros of D and h are pi/2 away, so
// that 12 nodes per part have an error of 1e-17.
ROLLING_ELLIPSE_WIDE Change change_of_energy(const SlopeBody& body, const WellPanel& panel,
                                             double to) {
    static_assert(lanes == 4);
    constexpr double widest = 1.4;
    const GaussRule& rule = gauss_rule(12);
    const auto rate = [&](Pack v) __attribute__((always_inline)) {
        return moment_at(body, panel, places_at(body, panel, v));
    };
    const int parts = std::max(1, static_cast<int>(std::ceil(to / widest)));
    const double half = 0.5 * to / parts;
    Pack sum{};
    for (int k = 0; k < parts; ++k) {
        for (int i = 0; i < rule.size / 2; i += 2) {
            const double x = rule.nodes[i];
            const double y = rule.nodes[i + 1];
            const Pack weights{rule.weights[i], rule.weights[i], rule.weights[i + 1],
                               rule.weights[i + 1]};
            sum += weights * rate(half * (2 * k + 1 + Pack{x, -x, y, -y}));
        }
    }
    double total = 0.0;
    for (int i = 0; i < lanes; ++i) total += lane_of(sum, i);
    const double near = 1e-4 * to;
    const Pack rates = rate(Pack{to, to - near, to + near, to});
    return {half * total, lane_of(rates, 0), (lane_of(rates, 2) - lane_of(rates, 1)) / (2 * near)};
}

// Estimates the coordinate between 0 and `most` at which W has changed by `energy` from its
// value at the bottom, from a cubic through four values of the moment divided by the coordinate.
ROLLING_ELLIPSE_WIDE double estimate(const SlopeBody& body, const WellPanel& panel, double energy,
                                     double most) {
    constexpr int steps = 3;
    constexpr double beyond = 1.25;  // usually the moment grows more slowly than at the bottom
    const double height = std::sqrt(body.short_axis2 + body.c2 * square(panel.at.sine));
    const double turned = panel.grade * panel.rate * square(panel.at.cosine);
    const double bend = body.pull * panel.from_rim.sine * square(turned) / height;
    const double unit = 0.25 * std::min(beyond * std::sqrt(2 * energy / std::abs(bend)), most);
    const Pack x = {1.0, 2.0, 3.0, 4.0};
    std::array<double, lanes> m;
    store(unit / x * moment_at(body, panel, places_at(body, panel, unit * x)), m.data());
    const double c0 = 4 * (m[0] + m[2]) - 6 * m[1] - m[3];
    const double c1 = (-26 * m[0] + 57 * m[1] - 42 * m[2] + 11 * m[3]) / 6;
    const double c2 = 1.5 * m[0] - 4 * m[1] + 3.5 * m[2] - m[3];
    const double c3 = (3 * (m[1] - m[2]) + m[3] - m[0]) / 6;
    double root = std::sqrt(2 * energy / c0);
    for (int i = 0; i < steps; ++i) {
        const double level = c0 / 2 + root * (c1 / 3 + root * (c2 / 4 + root * c3 / 5));
        const double moment = c0 + root * (c1 + root * (c2 + root * c3));
        root = std::min(root + (energy / root - root * level) / moment, 4.0);
    }
    return unit * root;
}

// The coordinate between 0 and `most` at which W has changed by `energy`; infinite if W changes by
// less. Uses Halley's method for the square root of the change, which is almost linear.
double coordinate_of(const SlopeBody& body, const WellPanel& panel, double energy, double guess,
                     double most) {
    constexpr int most_steps = 60;
    constexpr double converged = 3e-6;  // the next step would be about its cube
    double low = 0.0;
    double high = infinity;
    double v = guess;
    for (int i = 0; i < most_steps; ++i) {
        if (!(v > low && v < high)) v = 0.5 * (low + high);
        v = std::min(v, most);
        const auto [change, rate, bend] = change_of_energy(body, panel, v);
        if (change < energy && v == most) return infinity;
        (change < energy ? low : high) = v;
        const double missing = 2 * (energy - change) / (1 + std::sqrt(energy / change));
        const double step = missing / (rate + missing * (0.5 * bend / rate - 0.25 * rate / change));
        v += step;
        if (std::abs(step) <= converged * std::min(v, 1.0)) break;
    }
    return v;
}

// The angles from the turning points to the bottom, and the angle between the start and the turning
// point on the same side.
struct TurningPoints {
    std::array<double, 2> to_bottom;
    double ahead;
};

// The turning points of a motion that starts in a well; empty if a turning point is near a rim.
std::optional<TurningPoints> turning_points(const SlopeBody& body, const Well& well, double angle,
                                            double from_bottom, double energy) {
    constexpr double inside = 0.8;    // largest share of the way from the bottom to a rim
    constexpr double farthest = 1.5;  // [rad]
    const std::size_t here = from_bottom < 0 ? 0 : 1;
    const double away = std::abs(from_bottom);
    const std::array<double, 2> widest = {std::min(inside * well.to_rim[0], farthest),
                                          std::min(inside * well.to_rim[1], farthest)};
    if (away >= widest[here]) return std::nullopt;
    const WellPanel panels[] = {bottom_panel(body, well, 0, 1.0), bottom_panel(body, well, 1, 1.0)};
    const double whole =
        energy + change_of_energy(body, panels[here], coordinate(panels[here], away)).energy;
    if (!(whole > 0)) return std::nullopt;
    TurningPoints found{};
    for (const std::size_t i : {1, 0}) {
        const WellPanel& panel = panels[i];
        const double most = coordinate(panel, widest[i]);
        if (i != here || energy >= 0.5 * whole) {
            const double guess = estimate(body, panel, whole, most);
            if (!(guess < most)) return std::nullopt;
            const double v = coordinate_of(body, panel, whole, guess, most);
            if (!(v < most)) return std::nullopt;
            found.to_bottom[i] = reached(body, panel, v).angle;
            if (i == here) found.ahead = found.to_bottom[i] - away;
            continue;
        }
        if (energy > 0) {  // found from the start, which may be near the turning point
            const double seen = outwards(i) * angle;
            WellPanel local =
                flat_panel(body, seen, sine_cosine(seen), sine_cosine(away - well.to_rim[i]));
            local.to_bottom = sine_cosine(-away);
            const double guess = energy / change_of_energy(body, local, 0.0).rate;
            const double reach = coordinate(local, widest[i] - away);
            const double v = coordinate_of(body, local, energy, guess, reach);
            if (!(v < reach)) return std::nullopt;
            found.ahead = reached(body, local, v).angle;
        }
        found.to_bottom[i] = away + found.ahead;
    }
    return found;
}

// ---------------------------------------------------------------------------------- sides

// Appends the part of a panel from `first` to `last`, given W at `first`; returns W at `last`. At
// the turning point, W is 0, and dW/dv has a factor v.
ROLLING_ELLIPSE_WIDE double add_part(const SlopeBody& body, WellSide& side, std::size_t panel,
                                     double first, double last, double energy) {
    const PartRule& rule = part_rule();
    const bool turns = energy == 0;
    RunPart& part = side.parts.emplace_back();
    part.panel = panel;
    part.half = 0.5 * (last - first);
    part.middle = first + part.half;
    part.path = side.path_ahead;
    PartArray moment;
    PartArray from_start;  // the moment; at a turning point, divided by 1 + x
    for (int i = 0; i < part_order; i += lanes) {
        const Pack x = load(&rule.places[i]);
        const WellPlaces at = places_at(body, side.panels[panel], part.middle + part.half * x);
        const Pack turned = part.half * at.turned;
        const Pack gained = part.half * moment_at(body, side.panels[panel], at);
        store(at.h * turned, &part.advance[i]);
        store(turned * sqrt(0.5 * (body.d0 + body.d1 * at.sin2) / at.h2), &part.mass[i]);
        store(gained, &moment[i]);
        store(turns ? gained / (1 + x) : gained, &from_start[i]);
    }
    part.level = product(turns ? rule.moments : rule.integrals, from_start);
    for (int i = 0; i < part_order; ++i) {
        part.level[i] = turns ? square(1 + rule.places[i]) * part.level[i] : energy + part.level[i];
    }
    part.lasts = integral(node_times(part, 0.0));
    side.path_ahead += integral(part.advance);
    side.lasts = side.lasts + part.lasts;
    return energy + integral(moment);
}

// A side of a well, given the angles from both turning points to the bottom.
WellSide side_of_well(const SlopeBody& body, const Well& well, std::size_t i,
                      const std::array<double, 2>& to_bottoms) {
    constexpr double widest_gap = 0.6;   // beyond it, the rim has no effect near the turning point
    constexpr double widest_part = 1.0;  // the complex zeros of D and h are at least pi/2 away
    constexpr double safe = 1.5;         // limit on (width of a part)/(distance to a singularity)
    const double to_bottom = to_bottoms[i];
    const double from_rim = well.to_rim[i] - to_bottom;
    const WellPanel flat = bottom_panel(body, well, i, -1.0);
    const double angle = flat.angle - to_bottom;
    WellSide side{};
    side.heading = -outwards(i);
    side.panels = {{{angle, sine_cosine(angle), std::tan(std::min(from_rim, widest_gap)), 1.0, 0.0,
                     sine_cosine(to_bottom), sine_cosine(from_rim)},
                    flat}};
    side.parts.reserve(usual_parts);

    // The panels meet about halfway to the bottom, or to the zeros of D if they are nearer.
    const double way = 0.5 * std::min(to_bottom, root_of_squares(angle, flat.grade));
    const double first = coordinate(flat, way - to_bottom);
    const Reached at_first = reached(body, flat, first);
    const double after = to_bottom + at_first.angle;
    const double last = coordinate(side.panels[0], after);
    const double to_zero =
        std::min(root_of_squares(angle + after, flat.grade), to_bottom - after + to_bottoms[1 - i]);

    double energy = 0.0;
    const auto add = [&](std::size_t panel, double from, double width, double turned,
                         double to_singularity) {
        // in v, the distance from a singularity grows like the logarithm of the angle to it
        const double over_distance = turned / to_singularity + 0.5;
        const int count =
            static_cast<int>(std::ceil(width * std::max(over_distance / safe, 1 / widest_part)));
        for (int i = 0; i < count; ++i) {
            energy = add_part(body, side, panel, from + width * i / count,
                              from + width * (i + 1) / count, energy);
        }
    };
    add(0, 0.0, last, reached(body, side.panels[0], last).turned, to_zero);
    add(1, first, -first, at_first.turned, std::min(after, to_bottoms[1 - i]));
    return side;
}

// Time and path since the turning point of a side.
struct Ahead {
    double time;
    double path;
};

// The time and path to a point, given its angle from the turning point.
Ahead ahead_at(const WellSide& side, double angle, double to_bottom) {
    const double start[] = {angle, angle - to_bottom};
    std::optional<double> v[2];
    double time = 0.0;
    for (const RunPart& part : side.parts) {
        auto& at = v[part.panel];
        if (!at) at = coordinate(side.panels[part.panel], start[part.panel]);
        const double x = (*at - part.middle) / part.half;
        if (x <= 1 || &part == &side.parts.back()) {
            const PartReading of = reading_of(part, 0.0, part.lasts, node_times(part, 0.0));
            const double inside = std::clamp(x, -1.0, 1.0);
            return {time + value(of.time.integral, inside),
                    part.path + value(of.path.integral, inside)};
        }
        time += part.lasts;
    }
    return {};
}

// -------------------------------------------------------------------------------- reading

// The side and the part in which the body is at a given time, the time between its position and the
// end of the part nearer the turning point, and the direction of motion: +1 towards the bottom.
struct Phase {
    std::size_t side;
    std::size_t part;
    double since;
    double direction;
};

Phase phase_at(const Swing& swing, double time) {
    const DoubleDouble lasts = swing.lasts();
    const DoubleDouble since = DoubleDouble{time, 0.0} - swing.turned;
    const double swings = std::floor(double(since) / double(lasts));
    const DoubleDouble rest = since - lasts * swings;
    const std::size_t from = std::fmod(swings, 2.0) != 0 ? 1 : 0;
    const bool leaves = double(rest) <= double(swing.sides[from].lasts);
    const double after = double(leaves ? rest : lasts - rest);  // negative only due to rounding
    Phase found{leaves ? from : 1 - from, 0, std::abs(after), leaves == (after >= 0) ? 1.0 : -1.0};
    const auto& parts = swing.sides[found.side].parts;
    for (; found.part + 1 < parts.size() && found.since > parts[found.part].lasts; ++found.part) {
        found.since -= parts[found.part].lasts;
    }
    found.since = std::min(found.since, parts[found.part].lasts);
    return found;
}

ROLLING_ELLIPSE_WIDE WellReading well_reading(const RunPart& part) {
    PartArray level = part.level;
    for (int i = 0; i < part_order; ++i) {
        if (part.turns()) level[i] /= square(1 + part_rule().places[i]);
    }
    return {reading_of(part, 0.0, part.lasts, node_times(part, 0.0)),
            polynomial_through(level).value};
}

// The points at times since the start of a part.
ROLLING_ELLIPSE_WIDE void read_places(const SlopeBody& body, const WellPanel& panel,
                                      const WellReading& of, const std::array<double, lanes>& times,
                                      PlacesOnPart& places) {
    const RunPart& part = *of.part;
    const Pack x = places_in_part(of, load(times.data()));
    const WellPlaces at = places_at(body, panel, part.middle + part.half * x);
    const Pack speed = at.h * sqrt(2 * value(of.level, x) / (body.d0 + body.d1 * at.sin2));
    store(at.ahead_sin / at.ahead_cos, places.tan.data());
    store(part.path + value(of.path.integral, x), places.ahead.data());
    store(part.turns() ? (1 + x) * speed : speed, places.speed.data());
}

}  // namespace

std::optional<Swing> swing_from(const SlopeBody& body, const SlopePlace& start) {
    if (!body.equilibria || body.c2 == 0) return std::nullopt;
    const auto [lying, upright] = *body.equilibria;
    DoubleDouble angle = start.angle;  // from the flat position in the well
    double quarters = start.quarters;
    if (is_odd(quarters)) {
        angle = angle + half_pi_exact;
        quarters -= 1;
    }
    if (double(angle) > half_pi + upright) {
        angle = angle - half_turn;
        quarters += 2;
    }
    const double downhill = (half_pi + upright) - lying;
    const Well well{lying, {pi - downhill, downhill}, sine_cosine(lying), sine_cosine(downhill)};
    const double from_bottom = double(angle + -lying);
    const double energy = datum_of(body, start).energy;
    const auto turning = turning_points(body, well, double(angle), from_bottom, energy);
    if (!turning) return std::nullopt;
    const auto& [to_bottom, ahead] = *turning;
    Swing swing{{side_of_well(body, well, 0, to_bottom), side_of_well(body, well, 1, to_bottom)},
                quarters,
                {}};
    const std::size_t here = from_bottom < 0 ? 0 : 1;
    WellSide& side = swing.sides[here];
    WellSide& other = swing.sides[1 - here];
    const Ahead from = ahead_at(side, ahead, to_bottom[here]);
    const bool leaves = start.omega * side.heading > 0;
    swing.turned = {leaves ? -from.time : from.time, 0.0};
    if (here == 1) swing.turned = swing.turned - swing.lasts();
    side.path = -side.heading * from.path;
    other.path = side.path + side.heading * (side.path_ahead + other.path_ahead);
    return swing;
}

ROLLING_ELLIPSE_WIDE PartForces node_forces(const SlopeBody& body, const WellSide& side,
                                            const RunPart& part) {
    const auto positions_at = [&](Pack x) __attribute__((always_inline)) {
        return places_at(body, side.panels[part.panel], part.middle + part.half * x);
    };
    return forces_at(body, part, side.heading, 0.0, positions_at);
}

std::size_t SwingReader::operator()(const double* times, std::size_t n, SlopePlace* places) {
    static_assert(lanes == RunReader::most);
    std::array<Phase, lanes> phases{};
    std::array<double, lanes> since{};
    std::size_t count = 0;
    for (; count < std::min<std::size_t>(n, lanes); ++count) {
        const Phase phase = phase_at(swing_, times[count] / body_.time);
        if (count > 0 && (phase.side != phases[0].side || phase.part != phases[0].part)) break;
        phases[count] = phase;
        since[count] = phase.since;
    }
    std::fill(since.begin() + count, since.end(), since[0]);
    const WellSide& side = swing_.sides[phases[0].side];
    const RunPart& part = side.parts[phases[0].part];
    auto& readings = readings_[phases[0].side];
    readings.resize(side.parts.size());
    WellReading& reading = readings[phases[0].part];
    if (!reading.part) reading = well_reading(part);
    const WellPanel& panel = side.panels[part.panel];
    PlacesOnPart on_part;
    read_places(body_, panel, reading, since, on_part);
    for (std::size_t k = 0; k < count; ++k) {
        places[k] = {{times[k] / body_.time, 0.0},
                     swing_.quarters,
                     {side.heading * (panel.angle + std::atan(on_part.tan[k])), 0.0},
                     side.heading * phases[k].direction * on_part.speed[k],
                     {side.path + side.heading * on_part.ahead[k], 0.0}};
    }
    return count;
}

}  // namespace rolling_ellipse
