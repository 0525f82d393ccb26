#include "outcome/turning_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "numerics/bisect.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

constexpr double most_quarters = 100'000;
constexpr std::size_t most_looks = 7'000'000;  // some seconds
constexpr int looks_a_step = 16;
constexpr int looks_a_quarter = 64;

void sort_once(std::vector<double>& times) {
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
}

// The times and those that divide the way from each to the next.
std::vector<double> divided(const std::vector<double>& times, int parts) {
    std::vector<double> found;
    found.reserve(times.size() * parts);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        for (int k = 0; k < parts; ++k) {
            found.push_back(times[i] + (times[i + 1] - times[i]) * k / parts);
        }
    }
    found.push_back(times.back());
    sort_once(found);
    return found;
}

// The stretch of one segment: each law as an overload.
class Survey {
  public:
    Survey(double begin, double unit, std::optional<Quantity> quantity, const Gauge& gauge,
           Stretch& found)
        : begin_(begin),
          unit_(unit),
          first_(found.times.front()),
          last_(found.times.back()),
          quantity_(quantity),
          gauge_(gauge),
          found_(found),
          times_(found.times) {}

    void operator()(const RollingFlow& flow) {
        const bool turns = flow.kind == MotionKind::rotation;
        if (flow.kind == MotionKind::rest) return still();
        if (!quantity_ && flow.kind == MotionKind::uniform) return look_evenly();
        if (flow.kind == MotionKind::uniform) return along() ? void() : still();
        if (turns && along()) return;
        const DoubleDouble half = flow.phase.half_turn;
        const DoubleDouble quarter = flow.phase.quarter_turn;
        const DoubleDouble flat = -flow.start_time;
        if (std::isinf(half.high)) {
            add({flat});
            return quantity_ ? void() : look_evenly();
        }
        if (turns) return repeat({flat, flat + quarter}, half);
        repeat({flat, flat + quarter, flat + half, flat + half + quarter}, half * 2.0);
    }

    void operator()(const SlopeFlow& flow) {
        unit_ *= flow.body.time;
        begin_ /= flow.body.time;
        if (flow.kind == MotionKind::rest) return still();
        if (flow.kind == MotionKind::uniform) {
            if (!quantity_) return look_evenly();
            if (is(Quantity::z)) return still();
            if (along() && flow.acceleration != 0) {
                add({{-flow.start.omega / flow.acceleration, 0.0}});
            }
            return;
        }
        if (flow.kind == MotionKind::libration) return rock(flow);
        add(flow.turnings);
        if (along()) return;
        add_axes();
        if (!quantity_) times_ = divided(times_, looks_a_quarter);
        if (is(Quantity::omega)) search(*quantity_, parts_a_quarter);
    }

    void operator()(const SteppedRolling& motion) {
        add_knots(motion.steps);
        if (!quantity_) return look_closely();
        search(is(Quantity::omega) ? Quantity::omega : Quantity::theta);
        if (is(Quantity::z)) add_axes();
    }

    void operator()(const SteppedMultipliers& motion) {
        std::visit([this](const auto& steps) { add_knots(steps); }, motion.steps);
        quantity_ ? search(*quantity_) : look_closely();
    }

    void operator()(const Slide& slide) {
        found_.where = "while it slides";
        std::vector<DoubleDouble> begins;
        for (const SlidePiece& piece : slide.pieces) begins.push_back(piece.centre.time);
        add(begins);
        quantity_ ? search_in_contact() : look_closely();
    }

    void operator()(const Settling&) {
        found_.where = "while it settles";
        quantity_ ? search_in_contact() : look_evenly();
    }

    void operator()(const Flight&) {
        found_.where = "in flight";
        if (!quantity_) return look_evenly();
        if (is(Quantity::omega)) return still();
        if (is(Quantity::theta)) return;
        if (is(Quantity::contact_x)) return search_in_contact();
        search(*quantity_);
    }

    void operator()(const Resting&) { still(); }
    void operator()(const Jam&) { still(); }

  private:
    static constexpr int parts_a_quarter = 8;

    bool is(Quantity quantity) const { return quantity_ == quantity; }
    // Whether it grows with the angle of a body that rolls.
    bool along() const { return quantity_ && !is(Quantity::z) && !is(Quantity::omega); }

    // The time after so long since the begin of the segment, in units of the law.
    double time(const DoubleDouble& since) const { return double(since + begin_) * unit_; }

    // Adds those times after the begin of the segment that lie inside.
    void add(const std::vector<DoubleDouble>& since) {
        for (const DoubleDouble& each : since) {
            const double t = time(each);
            if (first_ < t && t < last_) times_.push_back(t);
        }
        sort_once(times_);
    }

    template <class Steps>
    void add_knots(const Steps& steps) {
        std::vector<DoubleDouble> found;
        for (const auto& knot : steps.knots) found.push_back({knot.t, 0.0});
        add(found);
    }

    void still() {
        found_.where = "while it rests";
        if (!quantity_) return look_evenly();
        times_.resize(1);
        found_.constant = true;
    }

    // Times for a function.
    void look_closely() { times_ = divided(times_, looks_a_step); }

    void look_evenly() {
        const double quarters = quarters_of(gauge_(Quantity::theta, times_));
        times_ = divided({first_, last_}, looks_a_quarter * (8 + int(std::ceil(quarters))));
    }

    // Quarter turns from one angle to the next, to and fro.
    double quarters_of(const std::vector<double>& theta) const {
        double sum = 0.0;
        for (std::size_t i = 1; i < theta.size(); ++i) sum += std::abs(theta[i] - theta[i - 1]);
        require_few(sum / half_pi);
        return sum / half_pi;
    }

    void require_few(double quarters) const {
        if (!(quarters > most_quarters)) return;
        refuse_length(quantity_, "not be looked at over more than 100000 quarter turns",
                      "a motion of " + text(std::round(quarters)));
    }

    // Adds the turning points of a quantity that is smooth between the times.
    void search(Quantity quantity, int parts = 1) {
        times_ = divided(times_, parts);
        const Measure measure = [&](const auto& times) { return gauge_(quantity, times); };
        if (!add_turns(measure, gauge_.rounded_length(quantity), times_)) found_.monotone = false;
    }

    // Of a body whose centre does not follow from its angle.
    void search_in_contact() {
        const bool height = is(Quantity::z);
        if (!height && !is(Quantity::contact_x)) return search(*quantity_);
        search(Quantity::theta);
        add_axes();
        if (!height) search(Quantity::contact_x, parts_a_quarter);
    }

    // Adds the times at which theta, monotone between those before, passes multiples of pi/2: there
    // the height turns round.
    void add_axes() {
        const std::vector<double> theta = gauge_(Quantity::theta, times_);
        quarters_of(theta);
        std::vector<RootBracket> brackets;
        std::vector<double> axes;
        for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
            const auto [least, most] = std::minmax(theta[i], theta[i + 1]);
            const double first = std::floor(least / half_pi) + 1;
            const double count = std::ceil(most / half_pi) - first;
            const bool rises = theta[i] < theta[i + 1];
            for (double k = 0; k < count; ++k) {
                const double axis = (rises ? first + k : first + count - 1 - k) * half_pi;
                axes.push_back(axis);
                brackets.emplace_back(times_[i], times_[i + 1], theta[i] - axis,
                                      theta[i + 1] - axis);
            }
        }
        refine(brackets, [&](const std::vector<double>& at, const std::vector<std::size_t>& which) {
            std::vector<double> past = gauge_(Quantity::theta, at);
            for (std::size_t i = 0; i < past.size(); ++i) past[i] -= axes[which[i]];
            return past;
        });
        for (const RootBracket& bracket : brackets) times_.push_back(bracket.ends().high);
        sort_once(times_);
    }

    // Between two turning points.
    void rock(const SlopeFlow& flow) {
        const DoubleDouble first = flow.turnings[0];
        const DoubleDouble period = (flow.turnings[1] - first) * 2.0;
        std::vector<DoubleDouble> marks{first, flow.turnings[1], {0.0, 0.0}};
        if (!along()) {
            Stretch once{"", {first_, std::min(last_, time(period))}};
            Survey in_one(begin_, unit_, quantity_, gauge_, once);
            in_one.add({marks[0], marks[1], marks[0] + -period, marks[1] + -period});
            in_one.add_axes();
            if (is(Quantity::omega)) in_one.search(*quantity_, parts_a_quarter);
            found_.monotone = once.monotone;
            for (std::size_t i = 1; i + 1 < once.times.size(); ++i) {
                marks.push_back({once.times[i] / unit_, 0.0});
                marks.back() = marks.back() + -begin_;
            }
        }
        repeat(marks, period);
    }

    // Adds times, in units of the law since its begin, that come again in each period.
    void repeat(std::vector<DoubleDouble> marks, const DoubleDouble& period) {
        for (DoubleDouble& mark : marks) {
            mark = mark + -(period * std::floor(double(mark) / double(period)));
        }
        std::sort(marks.begin(), marks.end(),
                  [](const DoubleDouble& x, const DoubleDouble& y) { return double(x - y) < 0; });
        const double lasts = last_ / unit_ - begin_;
        const double count = std::floor((lasts - double(marks.back())) / double(period));
        std::vector<double> periods{0.0, 1.0, count, count + 1};
        if (quantity_ && count > 3) {
            found_.repetition = {marks.size(), period * unit_, count};
        } else {
            if (!quantity_) require_few(4 * lasts / double(period));
            periods.clear();
            for (double k = 0; k <= count + 1; ++k) periods.push_back(k);
        }
        times_ = {first_};
        for (const double k : periods) {
            for (const DoubleDouble& mark : marks) {
                times_.push_back(std::clamp(time(mark + period * k), first_, last_));
            }
        }
        times_.push_back(last_);
        if (!quantity_) times_ = divided(times_, looks_a_quarter);
    }

    double begin_;
    double unit_;
    double first_;
    double last_;
    std::optional<Quantity> quantity_;
    const Gauge& gauge_;
    Stretch& found_;
    std::vector<double>& times_;
};

}  // namespace

std::vector<Stretch> stretches(const Motion& motion, double last, std::optional<Quantity> quantity,
                               const Gauge& gauge) {
    const double unit = motion.units.time;
    std::size_t looks = 0;
    std::vector<Stretch> found;
    for (auto segment = motion.segments.begin(); segment != motion.segments.end(); ++segment) {
        const double begin = segment->begin * unit;
        if (begin > last) break;
        const auto next = segment + 1;
        const bool ends_here = next == motion.segments.end() || next->begin * unit > last;
        const double end = ends_here ? last : std::nextafter(next->begin * unit, 0.0);
        if (end < begin) continue;
        Stretch here{"while it rolls", {begin, end}, false, quantity.has_value()};
        Survey survey(segment->begin, unit, quantity, gauge, here);
        std::visit([&](const auto& law) { survey(itself(law)); }, segment->law);
        looks += here.times.size();
        if (looks > most_looks) {
            refuse_length(quantity, "not be looked at more than 7000000 times",
                          text(double(looks)) + " for a part of the motion");
        }
        found.push_back(std::move(here));
    }
    return found;
}

}  // namespace rolling_ellipse
