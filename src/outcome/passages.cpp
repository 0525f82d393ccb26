#include "outcome/passages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "numerics/bisect.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

int sign_of(double value) { return (value > 0) - (value < 0); }

// One stretch of a motion with the values of what is looked at.
struct Course {
    Stretch stretch;
    std::vector<double> values;
    double size;  // of the values
};

// A time with the quantity less its value there: 0 where it is no more than rounding of a touch.
struct Look {
    double t;
    double measure;
    bool is_last;  // of its stretch
};

class Search {
  public:
    // To the size of the values, of which their rounding is a part, comes a length.
    Search(std::optional<Quantity> quantity, Measure measure, double length, int direction,
           std::vector<Stretch> stretches)
        : quantity_(quantity),
          measure_(std::move(measure)),
          length_(length),
          direction_(direction) {
        for (Stretch& stretch : stretches) {
            std::vector<double> values = measure_(stretch.times);
            double size = 0.0;
            for (const double value : values) size = std::max(size, std::abs(value));
            courses_.push_back({std::move(stretch), std::move(values), size});
        }
    }

    // The times at which the quantity passes a value.
    std::vector<double> times_of(double value) const {
        std::vector<Look> looks;
        for (const Course& course : courses_) add_looks(course, value, looks);
        std::vector<double> times = passed(looks, value);
        std::sort(times.begin(), times.end());
        for (const Course& course : courses_) {
            if (course.stretch.repetition) repeat(course, value, times);
        }
        const auto is_same = [](double before, double t) {
            constexpr double ulps = 4;
            const double apart = t - before;
            if (apart > ulps * epsilon * before) return false;  // nearly always
            return !(apart > ulps * (std::nextafter(before, infinity) - before));
        };
        times.erase(std::unique(times.begin(), times.end(), is_same), times.end());
        return times;
    }

    std::vector<std::string> unproved() const {
        std::vector<std::string> found;
        for (const auto& [stretch, values, size] : courses_) {
            if (stretch.monotone) continue;
            if (std::find(found.begin(), found.end(), stretch.where) != found.end()) continue;
            found.push_back(stretch.where);
        }
        return found;
    }

  private:
    void add_looks(const Course& course, double value, std::vector<Look>& looks) const {
        constexpr double roundings = 8;
        const auto& [stretch, values, size] = course;
        const double rounding = roundings * epsilon * (size + std::abs(value) + length_);
        std::vector<Look> here;
        for (std::size_t i = 0; i < values.size(); ++i) {
            here.push_back({stretch.times[i], values[i] - value, false});
        }
        if (!stretch.monotone) add_minima(value, here);
        const auto is_rounding = [&](const Look& look) {
            return std::abs(look.measure) <= rounding;
        };
        const bool is_kept = stretch.constant || std::all_of(here.begin(), here.end(), is_rounding);
        const std::size_t first = looks.size();
        for (std::size_t i = 0; i < here.size(); ++i) {
            const auto rise = [&](std::size_t k) {
                return sign_of(here[k + 1].measure - here[k].measure);
            };
            const bool turns = i > 0 && i + 1 < here.size() && rise(i - 1) * rise(i) <= 0;
            looks.push_back(here[i]);
            if ((is_kept || turns) && is_rounding(here[i])) looks.back().measure = 0.0;
        }
        if (looks.size() > first) looks.back().is_last = true;
    }

    // Adds the least sizes between looks where these may reach 0: golden sections, side by side.
    void add_minima(double value, std::vector<Look>& looks) const {
        constexpr double golden = 0.6180339887498949;
        constexpr int sections = 45;  // to 1e-9 of the way between looks: a minimum is flat
        struct Dip {
            double low;
            double high;
            int side;
        };
        std::vector<Dip> dips;
        for (std::size_t i = 1; i + 1 < looks.size(); ++i) {
            const auto [before, here, after] =
                std::array{looks[i - 1].measure, looks[i].measure, looks[i + 1].measure};
            const double larger = std::max(std::abs(before), std::abs(after));
            const int side = sign_of(here);
            if (side == 0 || sign_of(before) != side || sign_of(after) != side) continue;
            if (std::abs(here) > std::min(std::abs(before), std::abs(after))) continue;
            if (std::abs(here) > 0.5 * larger) continue;
            dips.push_back({looks[i - 1].t, looks[i + 1].t, side});
        }
        if (dips.empty()) return;
        const auto values_at = [&](const auto& place) {
            std::vector<double> times;
            for (const Dip& dip : dips) times.push_back(place(dip));
            return measure_(times);
        };
        const auto left = [](const Dip& dip) { return dip.high - golden * (dip.high - dip.low); };
        const auto right = [](const Dip& dip) { return dip.low + golden * (dip.high - dip.low); };
        const auto middle = [](const Dip& dip) { return dip.low + 0.5 * (dip.high - dip.low); };
        for (int k = 0; k < sections; ++k) {
            const std::vector<double> at_left = values_at(left);
            const std::vector<double> at_right = values_at(right);
            for (std::size_t i = 0; i < dips.size(); ++i) {
                Dip& dip = dips[i];
                const bool falls = dip.side * at_left[i] > dip.side * at_right[i];
                const double cut = falls ? left(dip) : right(dip);
                (falls ? dip.low : dip.high) = cut;
            }
        }
        const std::vector<double> lowest = values_at(middle);
        for (std::size_t i = 0; i < dips.size(); ++i) {
            looks.push_back({middle(dips[i]), lowest[i] - value, false});
        }
        std::sort(looks.begin(), looks.end(),
                  [](const Look& x, const Look& y) { return x.t < y.t; });
    }

    bool is_wanted(int sense) const { return direction_ == 0 || direction_ == sense; }

    // Where the looks change their sign, in the sense that is asked for, and where they are 0.
    std::vector<double> passed(const std::vector<Look>& looks, double value) const {
        std::vector<double> found;
        std::vector<RootBracket> brackets;
        std::vector<double> sides;
        std::size_t next = 0;  // after the last look that was not 0
        int before = 0;        // its sign; 0 where there was none
        for (std::size_t i = 0; i < looks.size(); ++i) {
            const int now = sign_of(looks[i].measure);
            if (now == 0) continue;
            const bool crosses = before == -now;
            if (i > next) {  // the first look that is 0
                const int sense = before == 0 || crosses ? now : 0;
                if (is_wanted(sense)) found.push_back(looks[next].t);
            } else if (crosses && is_wanted(now)) {
                if (looks[i - 1].is_last) {
                    found.push_back(looks[i].t);
                } else {
                    // Turned so that it falls: a place where it is 0 is then the upper end.
                    brackets.emplace_back(looks[i - 1].t, looks[i].t, -now * looks[i - 1].measure,
                                          -now * looks[i].measure);
                    sides.push_back(-now);
                }
            }
            next = i + 1;
            before = now;
        }
        if (next < looks.size() && is_wanted(-before)) found.push_back(looks[next].t);
        refine(brackets, [&](const std::vector<double>& times, const auto& which) {
            std::vector<double> measures = measure_(times);
            for (std::size_t i = 0; i < times.size(); ++i) {
                measures[i] = sides[which[i]] * (measures[i] - value);
            }
            return measures;
        });
        for (const RootBracket& bracket : brackets) found.push_back(bracket.ends().high);
        return found;
    }

    // Adds the passages that a stretch repeats, from where it is farthest from the value on.
    void repeat(const Course& course, double value, std::vector<double>& times) const {
        constexpr double most = 1'000'000;
        const auto& [n, period, count] = *course.stretch.repetition;
        const auto& at = course.stretch.times;
        const auto nearer = [value](double x, double y) {
            return std::abs(x - value) < std::abs(y - value);
        };
        const auto first = course.values.begin() + 1;
        const std::size_t cut = std::max_element(first, first + n, nearer) - course.values.begin();
        const auto after = [&](double t) {
            return std::upper_bound(times.begin(), times.end(), t);
        };
        times.erase(after(at[cut + n]), after(at[cut + 2 * n]));
        const std::vector<double> one(after(at[cut]), after(at[cut + n]));
        const double in_all = double(one.size()) * (count - 1);
        if (in_all > most) {
            refuse_length(quantity_, "pass its value no more than 1000000 times",
                          "about " + text(in_all) + " of them");
        }
        std::vector<double> again;
        again.reserve(std::size_t(in_all));
        for (double k = 1; k < count && !one.empty(); ++k) {
            const DoubleDouble later = period * k;
            for (const double t : one) again.push_back(double(later + t));
        }
        times.insert(after(at[cut + n]), again.begin(), again.end());
    }

    std::optional<Quantity> quantity_;
    Measure measure_;
    double length_;
    int direction_;
    std::vector<Course> courses_;
};

}  // namespace

Passages passages(const Motion& motion, double last, Quantity quantity,
                  const std::vector<double>& values, int direction, const Checkpoint& checkpoint) {
    if (motion.segments.empty()) return {std::vector<std::vector<double>>(values.size()), {}};
    const Gauge gauge(motion, checkpoint);
    const Measure measure = [&](const auto& times) { return gauge(quantity, times); };
    const Search search(quantity, measure, gauge.rounded_length(quantity), direction,
                        stretches(motion, last, quantity, gauge));
    Passages found{{}, search.unproved()};
    for (const double value : values) found.times.push_back(search.times_of(value));
    return found;
}

Passages zeros(const Motion& motion, double last, const Measure& function, int direction,
               const Checkpoint& checkpoint) {
    if (motion.segments.empty()) return {{{}}, {}};
    function({motion.segments.front().begin * motion.units.time});  // one that is none says so
    const Gauge gauge(motion, checkpoint);
    const Search search(std::nullopt, function, 0.0, direction,
                        stretches(motion, last, std::nullopt, gauge));
    return {{search.times_of(0.0)}, search.unproved()};
}

}  // namespace rolling_ellipse
