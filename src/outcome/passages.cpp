#include "outcome/passages.hpp"

#include <algorithm>
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
    Search(const Asked& of, int direction, std::vector<Stretch> stretches)
        : of_(of), direction_(direction) {
        for (Stretch& stretch : stretches) {
            std::vector<double> values = of.measure(stretch.times);
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
            if (course.stretch.period) repeat(course, value, times);
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
        const double rounding = roundings * epsilon * (size + std::abs(value) + of_.length);
        std::vector<Look> here;
        for (std::size_t i = 0; i < values.size(); ++i) {
            here.push_back({stretch.times[i], values[i] - value, false});
        }
        const auto is_rounding = [&](const Look& look) {
            return std::abs(look.measure) <= rounding;
        };
        const bool is_kept = std::all_of(here.begin(), here.end(), is_rounding);
        const std::size_t first = looks.size();
        for (std::size_t i = 0; i < here.size(); ++i) {
            const auto rise = [&](std::size_t k) {
                return sign_of(here[k + 1].measure - here[k].measure);
            };
            const bool is_end = i == 0 || i + 1 == here.size();
            const bool turns = is_end || rise(i - 1) * rise(i) <= 0;
            looks.push_back(here[i]);
            if ((is_kept || turns) && is_rounding(here[i])) looks.back().measure = 0.0;
        }
        if (looks.size() > first) looks.back().is_last = true;
    }

    bool is_wanted(int sense) const { return direction_ == 0 || direction_ == sense; }

    // Where the looks change their sign, in the sense that is asked for, and where they are 0.
    std::vector<double> passed(const std::vector<Look>& looks, double value) const {
        std::vector<double> found;
        struct Crossing {
            RootBracket bracket;
            int side;
        };
        std::vector<Crossing> crossings;
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
                    const RootBracket bracket(looks[i - 1].t, looks[i].t,
                                              -now * looks[i - 1].measure, -now * looks[i].measure);
                    crossings.push_back({bracket, -now});
                }
            }
            next = i + 1;
            before = now;
        }
        if (next < looks.size() && is_wanted(-before)) found.push_back(looks[next].t);
        for (;;) {  // side by side: each look costs less so
            std::vector<double> places;
            std::vector<Crossing*> open;
            for (Crossing& crossing : crossings) {
                const auto place = crossing.bracket.next();
                if (!place) continue;
                places.push_back(*place);
                open.push_back(&crossing);
            }
            if (open.empty()) break;
            const std::vector<double> values = of_.measure(places);
            for (std::size_t k = 0; k < open.size(); ++k) {
                open[k]->bracket.take(places[k], open[k]->side * (values[k] - value));
            }
        }
        for (const Crossing& crossing : crossings) found.push_back(crossing.bracket.ends().high);
        return found;
    }

    // Adds those between the first and the last periods: from where, in the first one, the quantity
    // is farthest from the value, they come again.
    void repeat(const Course& course, double value, std::vector<double>& times) const {
        constexpr double most = 1'000'000;
        const auto& at = course.stretch.times;
        const DoubleDouble period = *course.stretch.period;
        std::size_t cut = 0;
        for (std::size_t i = 0; at[i] < at.front() + period.high; ++i) {
            const auto far = [&](std::size_t k) { return std::abs(course.values[k] - value); };
            if (far(i) > far(cut)) cut = i;
        }
        const auto after = [&](double t) {
            return std::upper_bound(times.begin(), times.end(), t);
        };
        const std::vector<double> one(after(at[cut]), after(double(period + at[cut])));
        const double count = std::floor((at.back() - at[cut]) / period.high) - 1;
        if (double(one.size()) * count > most) {
            refuse_length(of_, "pass its value no more than 1000000 times",
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

    const Asked& of_;
    int direction_;
    std::vector<Course> courses_;
};

}  // namespace

Passages passages(const Motion& motion, double last, Quantity quantity,
                  const std::vector<double>& values, int direction, const Checkpoint& checkpoint) {
    if (motion.segments.empty()) return {std::vector<std::vector<double>>(values.size()), {}};
    const Asked of = asked(motion, quantity, checkpoint);
    const Search search(of, direction, stretches(motion, last, of, checkpoint));
    Passages found{{}, search.unproved()};
    for (const double value : values) found.times.push_back(search.times_of(value));
    return found;
}

Passages zeros(const Motion& motion, double last, const Measure& function, int direction,
               const Checkpoint& checkpoint) {
    if (motion.segments.empty()) return {{{}}, {}};
    function({motion.segments.front().begin * motion.units.time});  // one that is none says so
    const Asked of{std::nullopt, function, 0.0};
    const Search search(of, direction, stretches(motion, last, of, checkpoint));
    return {{search.times_of(0.0)}, search.unproved()};
}

}  // namespace rolling_ellipse
