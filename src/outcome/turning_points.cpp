#include "outcome/turning_points.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "numerics/bernstein.hpp"
#include "numerics/bisect.hpp"
#include "numerics/lu.hpp"

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

// ------------------------------------------------------------- polynomials through nine places

// The dense output of "dop853" has degree 7; other quantities are met by shorter parts.
constexpr int degree = 8;

// Chebyshev's nodes on [0, 1], to four digits, and a place between them at which their polynomial
// is compared with the quantity.
constexpr std::array<double, degree + 2> places = {0.0076, 0.067, 0.1786, 0.329, 0.41,
                                                   0.5,    0.671, 0.8214, 0.933, 0.9924};
constexpr int compared = 4;

// The polynomials binomial(degree, i) s^i (1-s)^(degree-i).
Eigen::Matrix<double, degree + 1, 1> bernstein_basis(double s) {
    constexpr auto binomial = detail::binomials<degree>();
    Eigen::Matrix<double, degree + 1, 1> row;
    for (int i = 0; i <= degree; ++i) {
        row[i] = binomial[i];
        for (int k = 0; k < degree; ++k) row[i] *= k < i ? s : 1 - s;
    }
    return row;
}

// The Bernstein coefficients of the polynomial through the values at the nodes.
Eigen::Matrix<double, degree + 1, 1> coefficients(const double* values) {
    using Matrix = Eigen::Matrix<double, degree + 1, degree + 1>;
    const auto node = [](int i) { return i < compared ? i : i + 1; };
    static const LU<double, degree + 1> basis = [&] {
        Matrix matrix;
        for (int i = 0; i <= degree; ++i) {
            matrix.row(i) = bernstein_basis(places[node(i)]).transpose();
        }
        return LU<double, degree + 1>(matrix);
    }();
    Eigen::Matrix<double, degree + 1, 1> at_nodes;
    for (int i = 0; i <= degree; ++i) at_nodes[i] = values[node(i)];
    return basis.solve(at_nodes);
}

struct Part {
    double low;
    double high;
    double missed = infinity;  // by the polynomial on the part that this one is half of
    int depth = 0;
};

// Adds the turning points of a quantity in parts of a motion. Where the polynomial misses a tenth
// place by more than rounding, the part is halved, which makes it better by 2^9 if the quantity is
// smooth. False where that does not help: nothing is shown there.
bool add_turns(const Measure& measure, double size, std::vector<Part> parts,
               std::vector<double>& times) {
    constexpr double roundings = 1000;  // the inverse of the basis has a norm of 300
    constexpr int deepest = 16;
    constexpr int trials = 3;  // halvings after which the polynomial has to be better than before
    bool all_met = true;
    while (!parts.empty()) {
        std::vector<double> at;
        at.reserve(parts.size() * places.size());
        for (const Part& part : parts) {
            for (const double s : places) at.push_back(part.low + (part.high - part.low) * s);
        }
        const std::vector<double> values = measure(at);
        std::vector<Part> halves;
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const auto& [low, high, missed_before, depth] = parts[i];
            const double* const here = values.data() + i * places.size();
            const auto bernstein = coefficients(here);
            const double missed =
                std::abs(bernstein_basis(places[compared]).dot(bernstein) - here[compared]);
            const auto [least, most] = std::minmax_element(here, here + places.size());
            const double noise =
                epsilon * (roundings * size + 8 * high / (high - low) * (*most - *least));
            if (missed > noise) {
                const double middle = low + 0.5 * (high - low);
                if (depth < deepest && low < middle && middle < high &&
                    (depth < trials || missed < 0.5 * missed_before)) {
                    halves.push_back({low, middle, missed, depth + 1});
                    halves.push_back({middle, high, missed, depth + 1});
                    times.push_back(middle);
                    continue;
                }
                all_met = false;
            }
            Bernstein<degree - 1> rate;
            for (int k = 0; k < degree; ++k) {
                rate.coefficients[k] = {bernstein[k + 1] - bernstein[k], 0.0};
                rate.coefficients[k].magnitude = noise / margin({0.0, 1.0});
            }
            for (const double s : roots_on_unit_interval(rate)) {
                times.push_back(low + (high - low) * s);
            }
        }
        parts = std::move(halves);
    }
    return all_met;
}

// --------------------------------------------------------------------------- laws of a motion

constexpr bool grows_with_the_angle(std::optional<Quantity> quantity) {
    return quantity && *quantity != Quantity::z && *quantity != Quantity::omega;
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
        const auto& [half, quarter] = std::tie(flow.phase.half_turn, flow.phase.quarter_turn);
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
    bool along() const { return grows_with_the_angle(quantity_); }

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
        throw std::invalid_argument(
            std::string(name_of(quantity_)) + " must not be looked at over more than " +
            std::to_string(long(most_quarters)) + " quarter turns, got a motion of " +
            short_text(quarters) + ": simulate a shorter one");
    }

    // Adds the turning points of a quantity that is smooth between the times.
    void search(Quantity quantity, int parts = 1) {
        constexpr std::size_t together = 1024;
        const std::vector<double> from = divided(times_, parts);
        const Measure measure = [&](const auto& times) { return gauge_(quantity, times); };
        double size = 0.0;
        for (const double value : measure(from)) size = std::max(size, std::abs(value));
        if (quantity == Quantity::x || quantity == Quantity::contact_x) size += gauge_.length();
        times_ = from;
        for (std::size_t i = 0; i + 1 < from.size(); i += together) {
            std::vector<Part> some;
            for (std::size_t k = i; k + 1 < from.size() && k < i + together; ++k) {
                some.push_back({from[k], from[k + 1]});
            }
            if (!add_turns(measure, size, std::move(some), times_)) found_.monotone = false;
        }
        sort_once(times_);
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
        std::vector<DoubleDouble> marks{first, flow.turnings[1]};
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
        const auto less = [](const DoubleDouble& x, const DoubleDouble& y) {
            return double(x - y) < 0;
        };
        for (DoubleDouble& mark : marks) {
            mark = mark + -(period * std::floor(double(mark) / double(period)));
        }
        std::sort(marks.begin(), marks.end(), less);
        const auto same = [](const DoubleDouble& x, const DoubleDouble& y) {
            return double(y - x) <= 0;
        };
        marks.erase(std::unique(marks.begin(), marks.end(), same), marks.end());
        const double lasts = last_ / unit_ - begin_;
        const double count = std::floor((lasts - double(marks.back())) / double(period));
        std::vector<double> all{first_};
        const auto add_period = [&](double k) {
            for (const DoubleDouble& mark : marks) {
                all.push_back(std::clamp(time(mark + period * k), first_, last_));
            }
        };
        if (quantity_ && count > 3) {
            for (const double k : {0.0, 1.0, count, count + 1}) add_period(k);
            found_.repetition = {marks.size(), period * unit_, count};
            all.push_back(last_);
            times_ = std::move(all);
            return;
        }
        if (!quantity_) require_few(4 * lasts / double(period));
        for (double k = 0; k <= count + 1; ++k) add_period(k);
        all.push_back(last_);
        sort_once(all);
        times_ = std::move(all);
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

const char* name_of(std::optional<Quantity> quantity) {
    constexpr const char* names[] = {"theta", "x", "z", "omega", "contact_x"};
    return quantity ? names[static_cast<int>(*quantity)] : "function";
}

std::string short_text(double value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, "%.3g", value);
    return digits;
}

Gauge::Gauge(const Motion& motion, const Checkpoint& checkpoint)
    : motion_(motion),
      checkpoint_(checkpoint),
      sample_(motion, looks_a_quarter),
      axes_{motion.scene.a * motion.units.length, motion.scene.b * motion.units.length},
      has_coordinates_(std::holds_alternative<SteppedMultipliers>(motion.segments.front().law)) {}

std::vector<double> Gauge::operator()(Quantity quantity, const std::vector<double>& times) const {
    constexpr std::size_t together = 1024;
    std::vector<double> values(times.size());
    for (std::size_t i = 0; i < times.size(); i += together) {
        checkpoint_();
        measure(quantity, times.data() + i, std::min(together, times.size() - i),
                values.data() + i);
    }
    return values;
}

void Gauge::measure(Quantity quantity, const double* times, std::size_t n, double* values) const {
    const auto take = [&](auto sample, const auto& value) {
        std::vector<decltype(sample)> samples(n);
        sample_(times, n, samples.data());
        std::transform(samples.begin(), samples.end(), values, value);
    };
    const auto of_state = [&](double theta, double omega, double x, double z) {
        switch (quantity) {
            case Quantity::theta:
                return theta;
            case Quantity::x:
                return x;
            case Quantity::z:
                return z;
            case Quantity::omega:
                return omega;
            default:
                return x + geometry(axes_, theta).dh;
        }
    };
    if (has_coordinates_) {
        using namespace coordinate;
        take(CoordinateState{}, [&](const CoordinateState& at) {
            return of_state(at.q[theta], at.q_dot[theta], at.q[x], at.q[z]);
        });
    } else if (quantity == Quantity::z) {
        take(ContactSample{}, [](const ContactSample& at) { return at.state.z; });
    } else {
        take(FlowSample{},
             [&](const FlowSample& at) { return of_state(at.theta, at.omega, at.x, 0.0); });
    }
}

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
            throw std::invalid_argument(
                std::string(name_of(quantity)) + " must not be looked at more than " +
                std::to_string(most_looks) + " times, got " + std::to_string(looks) +
                " for a part of the motion: simulate a shorter one");
        }
        found.push_back(std::move(here));
    }
    return found;
}

}  // namespace rolling_ellipse
