#include "contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "contact/continuation.hpp"
#include "contact/settling.hpp"
#include "geometry/half_turns.hpp"
#include "proof/certificate.hpp"
#include "proof/law.hpp"
#include "proof/slope_end.hpp"
#include "scene/impact.hpp"

namespace rolling_ellipse {
namespace {

// The name of an event that leads to a mode; sliding has two.
EventKind kind_of(Mode next, EventKind sliding) {
    if (next == Mode::rest) return EventKind::rest;
    if (next == Mode::rolling) return EventKind::stick;
    return next == Mode::flight ? EventKind::lift_off : sliding;
}

class ContactRun {
  public:
    ContactRun(const Scene& scene, const State& start, double gap_rate,
               const EndOfRolling& end_of_rolling, const Settings& settings, double t_end,
               const Checkpoint& checkpoint)
        : units_(natural_units(scene.body(), scene.mass)),
          scene_(in_units(scene, units_)),
          settings_(settings),
          t_end_(std::min(t_end / units_.time, std::numeric_limits<double>::max())),
          checkpoint_(checkpoint),
          state_(in_units(start, units_)),
          first_end_(end_of_rolling),
          rest_speed_(rest_speed(scene_, units_, settings)),
          gap_rate_(gap_rate / units_.speed()),
          motion_{units_, scene_, {}, {}} {}

    Integration<Motion> run() {
        const double x_dot = state_.x_dot;
        DoubleDouble angle{state_.theta, 0.0};
        state_ = recounted(state_, angle);
        if (scene_.friction == 0) state_.x_dot = x_dot;  // which nothing but gravity changes
        next_ = first_continuation(scene_, state_);
        if (is_stuck()) note(EventKind::jam, state_);
        while (!ending_) {
            checkpoint_();
            state_.mode = next_.mode;
            if (is_stuck()) {
                stop_stuck();
            } else {
                follow();
            }
        }
        return {std::move(motion_), *ending_, t_ * units_.time, counts_};
    }

  private:
    Axes axes() const { return scene_.axes(); }

    // Where a segment begins, its angle is counted from the flat position or tip beside it, where a
    // thin body is the most sensitive to it: returns that angle, of which states have the high
    // part.
    DoubleDouble count_from_quarter(DoubleDouble theta) {
        if (const double rest = resolved(theta.high); rest != theta.high) {
            turned_ = turned_ + two_sum(theta.high, -rest) + theta.low;
            theta = {rest, 0.0};
        }
        const QuarterView angle = quarter_view(theta);
        turned_ = turned_ + half_pi_exact * angle.quarters + angle.rest.low;
        if (angle.is_odd()) {
            std::swap(scene_.a, scene_.b);
            axes_exchanged_ = !axes_exchanged_;
        }
        return angle.rest;
    }

    // The state, its angle counted so; it is told with all its digits, and becomes the new one.
    State recounted(const State& state, DoubleDouble& angle) {
        const Axes before = axes();
        angle = count_from_quarter(angle);
        return with_angle(before, state, axes(), angle.high);
    }

    void follow() {
        if (next_.grazes) return graze();
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

    void stop_rolling(double after, double end, double omega, double x) {
        const double theta = count_from_quarter({end, 0.0}).high;
        const State before =
            in_contact(geometry(axes(), theta), theta, omega, x, 0.0, Mode::rolling);
        t_ += after;
        state_ = before;
        const Continuation next = continuation(scene_, before, false);
        go_on_with(next, kind_of(next.mode, EventKind::slip), before);
    }

    void slide() {
        Slide slide = slide_from(scene_, state_, next_.side);
        if (sliding_on_) go_on_from(*sliding_on_, slide);
        sliding_on_.reset();
        const SlideStop stop = slide_on(slide, {t_end_ - t_, steps_left()}, checkpoint_);
        const double lasts = double(slide.last.time);
        const State last = end_of(slide);
        SlidePoint end = slide.last;
        end.angle = angle_at_end(slide);
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
        state_ = recounted(last, end.angle);
        end_slide(stop, State(state_));
        if (next_.mode == Mode::sliding) sliding_on_ = end;
    }

    // By a free motion, which is that of the contact to 1e-14 until it is turned on so far.
    void graze() {
        const Flight free{axes(), scene_.ground_gravity(), state_, 0.0, next_.mode};
        const double lasts = turn_of_grazing / std::abs(state_.omega);
        add_segment(free);
        if (t_ + lasts > t_end_) return finish();
        t_ += lasts;
        const State moved = state_at(free, lasts);
        const Geometry at = geometry(axes(), moved.theta);
        const double slip = next_.mode == Mode::sliding ? slip_velocity(moved, at) : 0.0;
        state_ = in_contact(at, moved.theta, moved.omega, moved.x, slip, next_.mode);
        next_ = continuation(scene_, state_);
    }

    void end_slide(SlideStop stop, const State& before) {
        if (stop == SlideStop::jams) {
            next_.paradox = Painleve::no_motion;
            return note(EventKind::jam, before);
        }
        if (stop == SlideStop::pressure_vanishes) {
            return go_on_with({Mode::flight}, EventKind::lift_off, before);
        }
        const Geometry at = geometry(axes(), before.theta);
        state_ = in_contact(at, before.theta, before.omega, before.x, 0.0, Mode::sliding);
        const Continuation next = continuation(scene_, state_);
        if (next.mode == Mode::sliding)
            state_.x_dot = before.x_dot;  // without the rounding of h omega
        go_on_with(next, kind_of(next.mode, EventKind::reverse), before);
    }

    void fly() {
        const Flight flight{axes(), scene_.ground_gravity(), state_, gap_rate_};
        const auto [lasts, small_rate] = touch_down(flight);
        const bool lands = t_ + lasts <= t_end_;
        State before = state_at(flight, lands ? lasts : t_end_ - t_);
        // Bounces down a slope may grow, each more than the last, until they leave the doubles.
        if (!is_finite(before)) {
            ending_ = Ending::step_too_small;
            t_end_ = t_;
            return finish();
        }
        add_segment(flight);
        if (!lands) return finish();
        before.theta = count_from_quarter(two_product(state_.omega, lasts) + state_.theta).high;
        const Geometry at = geometry(axes(), before.theta);
        before.z = at.h;
        t_ += lasts;
        hit(before, small_rate ? *small_rate : gap_rate(before, at));
    }

    void hit(const State& before, double approach) {
        const auto [after, rebound_or_less] = collision(scene_, before, approach);
        state_ = after;
        // Below a rounding of the speed of a fall it is none.
        const double rebound =
            rebound_or_less > epsilon * speed_of_fall(scene_) ? rebound_or_less : 0.0;
        const Geometry at = geometry(axes(), before.theta);
        const double c = free_acceleration(at, scene_.ground_gravity().into, state_.omega);
        const double ratio = rebound / -approach;
        if (rebound > 0 && !settles(scene_, state_.omega, {rebound, ratio, c}, rest_speed_)) {
            return go_on_with({Mode::flight}, EventKind::impact, before, rebound);
        }
        if (rebound > 0) {
            state_.mode = Mode::flight;
            note(EventKind::impact, before);
            if (!ending_) settle(rebound, c);
            return;
        }
        go_on_with(continuation(scene_, state_), EventKind::impact, before);
    }

    void settle(double rebound, double c) {
        const Settled found = settled(scene_, state_, rebound, c);
        DoubleDouble end = found.angle;
        add_segment(Settling{found.lasts, state_, found.state});
        if (t_ + found.lasts > t_end_) return finish();
        t_ += found.lasts;
        state_ = recounted(found.state, end);
        const State before = state_;
        const Continuation next = continuation(scene_, state_);
        go_on_with(next, kind_of(next.mode, EventKind::slip), before);
    }

    void go_on_with(const Continuation& next, EventKind kind, const State& before,
                    double rebound = 0.0) {
        next_ = next;
        gap_rate_ = rebound;
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
        motion_.segments.push_back({t_, std::move(law), turned_, axes_exchanged_});
    }

    void finish() {
        t_ = t_end_;
        if (!ending_) ending_ = Ending::completed;
    }

    long steps_left() const { return settings_.max_steps - counts_.steps; }

    // Times, states and segments are in units, which the settings are not.
    const Units units_;
    Scene scene_;  // with its axes exchanged after an odd number of quarter turns
    const Settings& settings_;
    double t_end_;
    const Checkpoint& checkpoint_;
    State state_;
    double gap_rate_;
    std::optional<SlidePoint> sliding_on_;  // the end of a slide that another one follows
    DoubleDouble turned_;                   // beside the angle of the state
    bool axes_exchanged_ = false;
    const EndOfRolling first_end_;
    const double rest_speed_;
    Continuation next_{Mode::flight};
    double t_ = 0.0;
    Motion motion_;
    StepCounts counts_;
    std::optional<Ending> ending_;
};

}  // namespace

Integration<Motion> integrate_contact(const Scene& scene, const State& start, double gap_rate,
                                      const EndOfRolling& end_of_rolling, const Settings& settings,
                                      double t_end, const Checkpoint& checkpoint) {
    Integration<Motion> found =
        ContactRun(scene, start, gap_rate, end_of_rolling, settings, t_end, checkpoint).run();
    if (found.ending == Ending::completed) found.followed_until = t_end;
    return found;
}

}  // namespace rolling_ellipse
