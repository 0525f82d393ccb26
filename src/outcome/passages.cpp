#include "outcome/passages.hpp"

#include <algorithm>
#include <cmath>

#include "numerics/bisect.hpp"

namespace rolling_ellipse {
namespace {

int sign_of(double value) { return (value > 0) - (value < 0); }

// A time, and the observable at this time minus the requested value; exactly 0 where the observable
// touches that value to within rounding.
struct Reading {
    double t;
    double excess;
    bool is_last;  // the last reading of its stretch
};

struct Search {
    const Observable& of;
    int direction;
    std::vector<Stretch> stretches;

    // The times at which the observable passes a value.
    std::vector<double> times_of(double value) const {
        std::vector<Reading> readings;
        for (const Stretch& stretch : stretches) add_readings(stretch, value, readings);
        std::vector<double> times = passages_in(readings, value);
        std::sort(times.begin(), times.end());
        for (const Stretch& stretch : stretches) {
            if (stretch.period) repeat(stretch, value, times);
        }
        const auto is_same = [](double before, double t) {
            constexpr double ulps = 4;
            return t - before <= ulps * (std::nextafter(before, infinity) - before);
        };
        times.erase(std::unique(times.begin(), times.end(), is_same), times.end());
        return times;
    }

    void add_readings(const Stretch& stretch, double value, std::vector<Reading>& readings) const {
        constexpr double roundings = 8;
        const std::vector<double>& values = stretch.values;
        double size = 0.0;
        for (const double each : values) size = std::max(size, std::abs(each));
        const double rounding = roundings * epsilon * (size + std::abs(value) + of.length);
        const auto is_rounding = [&](double each) { return std::abs(each - value) <= rounding; };
        const bool is_kept = std::all_of(values.begin(), values.end(), is_rounding);
        const auto rise = [&](std::size_t i) {
            return sign_of((values[i + 1] - value) - (values[i] - value));
        };
        for (std::size_t i = 0; i < values.size(); ++i) {
            const bool is_last = i + 1 == values.size();
            const bool turns = i == 0 || is_last || rise(i - 1) * rise(i) <= 0;
            const bool touches = (is_kept || turns) && is_rounding(values[i]);
            readings.push_back({stretch.times[i], touches ? 0.0 : values[i] - value, is_last});
        }
    }

    bool is_wanted(int sense) const { return direction == 0 || direction == sense; }

    // The times of zeros, and of sign changes between readings, in the requested direction.
    std::vector<double> passages_in(const std::vector<Reading>& readings, double value) const {
        std::vector<double> passed;
        struct Crossing {
            RootBracket bracket;
            int side;
        };
        std::vector<Crossing> crossings;
        std::size_t next = 0;  // index of the reading after the last one that is not 0
        int before = 0;        // sign of the last reading that is not 0; 0 if none
        for (std::size_t i = 0; i < readings.size(); ++i) {
            const int now = sign_of(readings[i].excess);
            if (now == 0) continue;
            const bool crosses = before == -now;
            if (i > next) {  // zeros after the last nonzero reading; readings[next] is the first
                const int sense = before == 0 || crosses ? now : 0;
                if (is_wanted(sense)) passed.push_back(readings[next].t);
            } else if (crosses && is_wanted(now)) {
                if (readings[i - 1].is_last) {
                    passed.push_back(readings[i].t);
                } else {
                    // The factor -now makes the excess fall, so that a time with an excess of 0
                    // becomes the upper end.
                    const RootBracket bracket(readings[i - 1].t, readings[i].t,
                                              -now * readings[i - 1].excess,
                                              -now * readings[i].excess);
                    crossings.push_back({bracket, -now});
                }
            }
            next = i + 1;
            before = now;
        }
        if (next < readings.size() && is_wanted(-before)) passed.push_back(readings[next].t);
        for (;;) {  // all brackets in parallel, since many samples are cheaper at once
            std::vector<double> times;
            std::vector<Crossing*> open;
            for (Crossing& crossing : crossings) {
                const auto t = crossing.bracket.next();
                if (!t) continue;
                times.push_back(*t);
                open.push_back(&crossing);
            }
            if (open.empty()) break;
            const std::vector<double> values = of.measure(times);
            for (std::size_t k = 0; k < open.size(); ++k) {
                open[k]->bracket.take(times[k], open[k]->side * (values[k] - value));
            }
        }
        for (const Crossing& crossing : crossings) passed.push_back(crossing.bracket.ends().high);
        return passed;
    }

    // Adds the passages between the first and the last periods: copies of the passages in one
    // period. This period starts at the time in the first period at which the observable is
    // farthest from the value.
    void repeat(const Stretch& stretch, double value, std::vector<double>& times) const {
        constexpr double most = 1'000'000;
        const auto& at = stretch.times;
        const DoubleDouble period = *stretch.period;
        std::size_t cut = 0;
        for (std::size_t i = 0; at[i] < at.front() + period.high; ++i) {
            const auto distance = [&](std::size_t k) {
                return std::abs(stretch.values[k] - value);
            };
            if (distance(i) > distance(cut)) cut = i;
        }
        const auto after = [&](double t) {
            return std::upper_bound(times.begin(), times.end(), t);
        };
        const std::vector<double> one(after(at[cut]), after(double(period + at[cut])));
        const double count = std::floor((at.back() - at[cut]) / period.high) - 1;
        if (double(one.size()) * count > most) {
            refuse_length(of, "pass its value no more than 1000000 times",
                          "about " + text(double(one.size()) * count) + " of them");
        }
        std::vector<double> again;
        for (double k = 0; k < count && !one.empty(); ++k) {
            const DoubleDouble later = period * k;
            for (const double t : one) again.push_back(double(later + t));
        }
        const auto rest = times.erase(after(at[cut]), after(double(period * count + at[cut])));
        times.insert(rest, again.begin(), again.end());
    }
};

}  // namespace

Passages passages(const Motion& motion, double last, const Observable& of,
                  const std::vector<double>& values, int direction, const Checkpoint& checkpoint) {
    if (motion.segments.empty()) return {std::vector<std::vector<double>>(values.size()), {}};
    Passages result;
    const Search search{of, direction, stretches(motion, last, of, checkpoint)};
    for (const double value : values) result.times.push_back(search.times_of(value));
    for (const Stretch& stretch : search.stretches) {
        const auto& known = result.unproved;
        if (stretch.proved || std::count(known.begin(), known.end(), stretch.where)) continue;
        result.unproved.push_back(stretch.where);
    }
    return result;
}

}  // namespace rolling_ellipse
