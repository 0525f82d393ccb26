#include "contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contact/continuation.hpp"
#include "geometry/half_turns.hpp"
#include "proof/certificate.hpp"
#include "proof/law.hpp"
#include "proof/slope_end.hpp"
#include "scene/impact.hpp"
#include "scene/refuse.hpp"

namespace rolling_ellipse {
namespace {

// What an event is called that leads to a mode; sliding has two names.
EventKind kind_of(Mode next, EventKind sliding) {
    switch (next) {
        case Mode::rest:
            return EventKind::rest;
        case Mode::rolling:
            return EventKind::stick;
        case Mode::flight:
            return EventKind::lift_off;
        case Mode::sliding:
            return sliding;
    }
    return sliding;
}

class ContactRun {
  public:
    ContactRun(const Scene& scene, const State& start, const EndOfRolling& end_of_rolling,
               const Settings& settings, double t_end, const Checkpoint& checkpoint)
        : units_(natural_units(scene)),
          scene_(body_in_units(scene, units_)),
          axes_(scene_.axes()),
          settings_(settings),
          t_end_(std::min(t_end / units_.time, std::numeric_limits<double>::max())),
          checkpoint_(checkpoint),
          state_(in_units(start, units_)),
          first_end_(end_of_rolling),
          rest_speed_(rest_speed()),
          motion_{units_, scene_, {}, {}} {}

    Integration<Motion> run() {
        resolve_angle();
        next_ = first_continuation(scene_, state_);
        if (is_stuck()) note(EventKind::jam, state_);
        while (!ending_) {
            checkpoint_();
            state_.mode = next_.mode;
            take_half_turns_off();
            if (is_stuck()) {
                stop_stuck();
            } else {
                follow();
            }
        }
        return {std::move(motion_), *ending_, t_ * units_.time, counts_};
    }

  private:
    // At the start, and where a flight or a slide turned the body so often.
    void resolve_angle() {
        const double rest = resolved(state_.theta);
        if (rest != state_.theta) turn_off(two_sum(state_.theta, -rest), rest);
    }

    // From an event on: the ellipse is the same after half a turn, and near a flat position its
    // angle has more digits.
    void take_half_turns_off() {
        resolve_angle();
        const double half_turns = std::nearbyint(state_.theta / pi);
        if (half_turns == 0 || motion_.segments.empty()) return;
        const DoubleDouble rest = DoubleDouble{state_.theta, 0.0} - half_turn * half_turns;
        turn_off(half_turn * half_turns + rest.low, rest.high);
    }

    // Leave the rest of the angle in the state.
    void turn_off(const DoubleDouble& turned, double rest) {
        turned_ = turned_ + turned;
        state_ = with_angle(axes_, state_, rest);
    }

    void follow() {
        switch (next_.mode) {
            case Mode::rest:
                return rest();
            case Mode::rolling:
                return scene_.slope == 0 ? roll_exactly() : roll_on_slope();
            case Mode::sliding:
                return slide();
            case Mode::flight:
                return fly();
        }
    }

    void rest() {
        add_segment(Resting{state_});
        finish();
    }

    bool is_stuck() const { return next_.paradox != Painleve::determined; }

    void stop_stuck() {
        add_segment(Jam{state_});
        ending_ = next_.paradox == Painleve::no_motion ? Ending::jammed : Ending::undetermined;
    }

    void roll_exactly() {
        const RollingStart start = rolling_start(scene_.body(), state_.theta, state_.omega);
        const RollingFlow flow = rolling_flow(start, state_.x);
        const EndOfRolling end = end_of_this_rolling(start);
        const double lasts = end.validity == Validity::invalid ? time_of_end(flow, end) : infinity;
        if (lasts == infinity) {
            validate_time(t_end_ * units_.time, (t_ + longest_time(flow)) * units_.time);
        }
        if (lasts > 0) add_segment(std::make_shared<const RollingFlow>(flow));
        if (t_ + lasts > t_end_) return finish();
        const FlowSample last = sample(flow, lasts);
        stop_rolling(lasts, last.theta, last.omega, last.x);
    }

    EndOfRolling end_of_this_rolling(const RollingStart& start) const {
        const bool is_first = motion_.segments.empty() && turned_.high == 0;
        const double friction = friction_to_roll();
        const bool at_limit = friction != scene_.friction;
        if (is_first && !at_limit) return first_end_;
        EndOfRolling end = end_of_rolling(start, friction);
        // With less friction than angles tell from none it ends where it starts.
        if (at_limit && end.angle && std::abs(*end.angle - start.theta) < epsilon) {
            end.angle = start.theta + end.heading * epsilon;
        }
        return end;
    }

    void roll_on_slope() {
        SlopeFlow flow =
            slope_flow(scene_.body(), scene_.slope, state_.theta, state_.omega, state_.x);
        const double left = t_end_ - t_;
        const LawMeetings met = law_meetings(flow, friction_to_roll(), left);
        const double lasts = met.broken ? met.broken->time : infinity;
        prepare(flow, std::min(lasts, left));
        if (lasts == infinity) {
            validate_time(t_end_ * units_.time, (t_ + longest_time(flow)) * units_.time);
        }
        const FlowSample last = lasts < infinity ? sample(flow, lasts) : FlowSample{};
        if (lasts > 0) add_segment(std::make_shared<const SlopeFlow>(std::move(flow)));
        if (t_ + lasts > t_end_) return finish();
        stop_rolling(lasts, last.theta, last.omega, last.x);
    }

    // At the limit but for rounding it may be that the ground holds the body, and that it slips:
    // it rolls until that is clear.
    double friction_to_roll() const {
        const ContactForce force = rolling_force(scene_, state_.theta, state_.omega);
        return at_the_limit(force, scene_.friction) ? beyond_the_limit(scene_.friction)
                                                    : scene_.friction;
    }

    void stop_rolling(double after, double theta, double omega, double x) {
        const Geometry at = geometry(axes_, theta);
        const State before = in_contact(at, theta, omega, x, 0.0, Mode::rolling);
        t_ += after;
        state_ = before;
        const Continuation next = continuation(scene_, before, false);
        go_on_with(next, kind_of(next.mode, EventKind::slip), before);
    }

    void slide() {
        Slide slide = slide_from(scene_, state_, next_.side);
        const SlideStop stop = slide_on(slide, {t_end_ - t_, steps_left()}, checkpoint_);
        const double lasts = double(slide.last.time);
        const ContactSample last = end_of(slide);
        counts_.steps += static_cast<long>(slide.pieces.size());
        if (!slide.pieces.empty()) add_segment(std::move(slide));
        if (stop == SlideStop::too_many_pieces || stop == SlideStop::no_progress) {
            const bool too_many = stop == SlideStop::too_many_pieces;
            ending_ = too_many ? Ending::max_steps : Ending::step_too_small;
            t_end_ = t_ + lasts;  // all there is
            return finish();
        }
        if (stop == SlideStop::time_is_over || t_ + lasts > t_end_) return finish();
        t_ += lasts;
        state_ = last.state;
        end_slide(stop, last.state);
    }

    void end_slide(SlideStop stop, const State& before) {
        if (stop == SlideStop::jams) {
            next_.paradox = Painleve::no_motion;
            return note(EventKind::jam, before);
        }
        if (stop == SlideStop::pressure_vanishes) {
            return go_on_with({Mode::flight}, EventKind::lift_off, before);
        }
        const Geometry at = geometry(axes_, before.theta);
        state_ = in_contact(at, before.theta, before.omega, before.x, 0.0, Mode::sliding);
        const Continuation next = continuation(scene_, state_);
        go_on_with(next, kind_of(next.mode, EventKind::reverse), before);
    }

    void fly() {
        const Flight flight{axes_, scene_.ground_gravity(), state_};
        const auto [lasts, grazes] = touch_down(flight);
        const bool lands = t_ + lasts <= t_end_;
        State before = state_at(flight, lands ? lasts : t_end_ - t_);
        if (!is_known(before)) {
            ending_ = Ending::step_too_small;
            t_end_ = t_;
            return finish();
        }
        add_segment(flight);
        if (!lands) return finish();
        const Geometry at = geometry(axes_, before.theta);
        before.z = at.h;
        if (grazes) before.z_dot = at.dh * before.omega;
        t_ += lasts;
        hit(before);
    }

    // Down a wall a body flies farther than doubles reach, if it is let for long enough.
    static bool is_known(const State& state) {
        return std::isfinite(state.theta) && std::isfinite(state.x) && std::isfinite(state.z) &&
               std::isfinite(state.x_dot) && std::isfinite(state.z_dot);
    }

    void hit(const State& before) {
        const Geometry at = geometry(axes_, before.theta);
        state_ = after_collision(scene_, before);
        const double rebound = std::max(state_.z_dot - at.dh * state_.omega, 0.0);
        const double c = free_acceleration(at, scene_.ground_gravity().into, state_.omega);
        const double ratio = rebound / (at.dh * before.omega - before.z_dot);
        if (rebound > 0 && !settles(rebound, ratio, c)) {
            return go_on_with({Mode::flight}, EventKind::impact, before);
        }
        if (rebound > 0) {
            state_.mode = Mode::flight;
            note(EventKind::impact, before);
            if (!ending_) settle(rebound, c);
            return;
        }
        go_on_with(continuation(scene_, state_), EventKind::impact, before);
    }

    // Whether a rebound is the first of bounces that are too small and too short to tell apart.
    // They take place under one c and h', an error of the square of how long they last beside the
    // time in which a body falls or turns by b/a: no more than the share of the speed at which it
    // rests. Those that do not shrink are none where each is less than a rounding.
    bool settles(double rebound, double ratio, double c) const {
        if (rebound > rest_speed_ || c <= 0) return false;
        const auto [least, most] = std::minmax(scene_.a, scene_.b);
        const double rate =
            std::max(std::sqrt(scene_.gravity / least), std::abs(state_.omega) * most / least);
        const double longest = std::sqrt(rest_speed_ / speed_of_fall());
        const bool shrinks = ratio < largest_ratio_that_settles;
        if (!shrinks && rebound > epsilon * speed_of_fall()) return false;
        return 2 * rebound * rate <= longest * c * (shrinks ? 1 - ratio : 1.0);
    }

    // Infinitely many bounces that shrink by a ratio take a finite time, physics (57); so small
    // ones do it in place, under the c of their beginning.
    void settle(double rebound, double c) {
        constexpr double negligible_share = 1e-12;  // of the rebound: what is left adds no digit
        const Geometry at = geometry(axes_, state_.theta);
        const GroundGravity gravity = scene_.ground_gravity();
        State moving = state_;
        double lasts = 0.0;
        double turned = 0.0;
        double moved = 0.0;
        double speed = rebound;
        while (speed > negligible_share * rebound) {
            const double hop = 2 * speed / c;
            const double gained =
                (gravity.along - at.dh * square(moving.omega)) * hop;  // slip in flight
            // of the centre, which moves as the slip and (h + h' turned) omega say
            const double velocity = moving.x_dot + at.dh * turned * moving.omega;
            moved += (velocity + 0.5 * gravity.along * hop) * hop;
            lasts += hop;
            turned += moving.omega * hop;
            moving.x_dot += gained;
            moving.z_dot = at.dh * moving.omega - speed;
            moving = after_collision(scene_, moving);
            const double next = moving.z_dot - at.dh * moving.omega;
            if (!(next < largest_ratio_that_settles * speed)) break;
            speed = std::max(next, 0.0);
        }
        const double theta = state_.theta + turned;
        const State settled =
            in_contact(geometry(axes_, theta), theta, zero_if_negligible(moving.omega),
                       state_.x + moved, slip_beyond_rounding(moving, at), Mode::flight);
        add_segment(Settling{lasts, state_, settled});
        if (t_ + lasts > t_end_) return finish();
        t_ += lasts;
        state_ = settled;
        const State before = state_;
        const Continuation next = continuation(scene_, state_);
        go_on_with(next, kind_of(next.mode, EventKind::slip), before);
    }

    void go_on_with(const Continuation& next, EventKind kind, const State& before) {
        next_ = next;
        state_.mode = next.mode;
        note(kind, before);
        if (is_stuck() && !ending_) note(EventKind::jam, state_);
    }

    void note(EventKind kind, const State& before) {
        if (static_cast<long>(motion_.events.size()) == settings_.max_events) {
            ending_ = Ending::max_events;
        } else {
            motion_.events.push_back({t_ * units_.time, kind, seen(before), seen(state_)});
        }
    }

    State seen(State state) const {
        state.theta = static_cast<double>(turned_ + state.theta);
        return in_si(state, units_);
    }

    template <class Law>
    void add_segment(Law law) {
        motion_.segments.push_back({t_, std::move(law), turned_});
    }

    void finish() {
        t_ = t_end_;
        if (!ending_) ending_ = Ending::completed;
    }

    double speed_of_fall() const {
        return std::sqrt(scene_.gravity * std::min(scene_.a, scene_.b));
    }

    double rest_speed() const {
        constexpr double small = 1e-6;
        // Where bounces are summed, c and h' stay what they are: an error of this size.
        constexpr double large = 1e-2;
        const double unit = speed_of_fall();
        if (!settings_.rest_speed) return small * unit;
        const double speed = *settings_.rest_speed / units_.speed();
        if (speed > large * unit) {
            refuse("rest_speed",
                   "at most " + text(large * unit * units_.speed()) +
                       " [m/s], a hundredth of sqrt(g min(a, b))",
                   *settings_.rest_speed);
        }
        return speed;
    }

    long steps_left() const { return settings_.max_steps - counts_.steps; }

    // The ratio of a rebound to the last up to which bounces are summed: 1e5 of them at most.
    static constexpr double largest_ratio_that_settles = 0.9999;

    // Times, states and segments are in units, which the settings are not.
    const Units units_;
    const Scene scene_;
    const Axes axes_;
    const Settings& settings_;
    double t_end_;
    const Checkpoint& checkpoint_;
    State state_;
    DoubleDouble turned_;  // beside the angle of the state
    const EndOfRolling first_end_;
    const double rest_speed_;
    Continuation next_{Mode::flight};
    double t_ = 0.0;
    Motion motion_;
    StepCounts counts_;
    std::optional<Ending> ending_;
};

}  // namespace

Integration<Motion> integrate_contact(const Scene& scene, const State& start,
                                      const EndOfRolling& end_of_rolling, const Settings& settings,
                                      double t_end, const Checkpoint& checkpoint) {
    Integration<Motion> found =
        ContactRun(scene, start, end_of_rolling, settings, t_end, checkpoint).run();
    if (found.ending == Ending::completed) found.followed_until = t_end;
    return found;
}

}  // namespace rolling_ellipse
