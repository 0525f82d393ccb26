#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contact/segments.hpp"
#include "proof/certificate.hpp"
#include "proof/law.hpp"
#include "proof/slope.hpp"

namespace rolling_ellipse {
namespace {

constexpr std::size_t usual_events = 16;  // capacity reserved at the first event

// The kind of the event that leads to the mode `next`; if this is sliding, the given kind.
EventKind kind_of(Mode next, EventKind sliding) {
    if (next == Mode::rest) return EventKind::rest;
    if (next == Mode::rolling) return EventKind::stick;
    return next == Mode::flight ? EventKind::lift_off : sliding;
}

// The state just after an event other than a blow, and the impulse of the ground at an impact.
// Everything is in SI units.
InitialState start_after(const Scene& scene, EventKind kind, const State& before,
                         const State& after) {
    InitialState start{after, 0.0, 0.0, before.omega};
    if (kind != EventKind::impact) return start;
    start.reaction_x = scene.mass * (after.x_dot - before.x_dot);
    start.reaction_z = scene.mass * (after.z_dot - before.z_dot);
    start.energy_lost = energy_lost(scene, before, after);
    return start;
}

// Determines, piece by piece, whether a slide lasts for ever. Without friction, the energy gives
// omega^2, and hence all forces, as functions of the angle alone, so that half a turn or two
// turning points are enough to decide. With friction, swings repeat as long as the slip keeps its
// sign, and each full swing adds the same amount of slip. The slide therefore lasts for ever if the
// slip throughout one full swing exceeds the largest slip up to the end of the first full swing.
class EndlessSlide {
  public:
    EndlessSlide(const Slide& slide, double friction)
        : slide_(slide), friction_(friction), start_(slide.last) {}

    bool is_known() {
        if (slide_.pieces.empty()) return false;
        const double omega = slide_.last.omega.high;
        const double slip = std::abs(slide_.last.slip.high);
        const bool turns = before_ * omega < 0;
        before_ = omega;
        turns_ += turns;
        const bool stands = start_.omega.high == 0 && omega == 0;
        if (friction_ == 0) {
            const double turned = slide_.last.angle.high - start_.angle.high;
            return stands || turns_ == 2 || std::abs(turned) >= pi;
        }
        if (stands) return slip > std::abs(start_.slip.high);
        if (turns_ < 3) {
            most_ = std::max(most_, slip);
        } else if (turns && turns_ % 2 == 1) {
            if (least_ < infinity && least_ > most_) return true;
            least_ = slip;
        } else {
            least_ = std::min(least_, slip);
        }
        return false;
    }

  private:
    const Slide& slide_;
    const double friction_;
    const SlidePoint start_;
    double before_ = 0.0;  // angular velocity before the last piece
    long turns_ = 0;
    double most_ = 0.0;
    double least_ = infinity;
};

// The motion so far and its current state. Times, states and segments are in natural units;
// settings and events are in SI units.
class ContactRun {
  public:
    ContactRun(const Scene& scene, const InitialState& start, const Settings& settings,
               double t_end, const Checkpoint& checkpoint)
        : units_(natural_units(scene.body(), scene.mass)),
          given_(scene),
          scene_(in_units(scene, units_)),
          settings_(settings),
          t_end_(t_end),
          checkpoint_(checkpoint),
          left_(settings.count),
          rest_speed_(rest_speed(scene_, units_, settings)),
          motion_{units_, scene_, {}, {}, {}},
          start_(start) {}

    Integration<Motion> run() {
        for (const Blow& blow : settings_.blows) {
            follow_until(blow.t);
            if (ending_ || (stops_ && now() * units_.time < blow.t)) break;
            strike(blow);
        }
        follow_until(t_end_);
        const double t = ending_ || stops_ ? now() * units_.time : t_end_;
        return {std::move(motion_), ending_.value_or(Ending::completed), t, counts_};
    }

  private:
    // Follows the motion up to the time t [s] of the next blow or of the end. A motion that has
    // stopped is followed only through the remaining events of that instant.
    void follow_until(double t) {
        until_ = stops_ ? now() : std::min(t / units_.time, std::numeric_limits<double>::max());
        is_there_ = false;
        if (start_) begin(*std::exchange(start_, std::nullopt));
        while (!ending_ && !is_there_) {
            checkpoint_();
            follow();
        }
    }

    // Applies a blow as if it were the impulse of a scene that starts in the current state.
    void strike(const Blow& blow) {
        ContactSample before;
        Sampler(motion_, 1)(&blow.t, 1, &before);
        Scene struck = reached(given_, before.state);
        struck.impulse = blow.impulse;
        validate_blow(struck, geometry(struck.axes(), struck.theta),
                      "blows (at " + text(blow.t) + " s)");
        const InitialState start = initial_state(struck);
        InitialState after = start;
        after.state.mode = first_continuation(struck, start.state).mode;
        note({blow.t, EventKind::blow, before.state, after});
        ++struck_;
        start_ = start;
    }

    void stop() {
        stops_ = true;
        until_ = now();
    }

    // Stops a motion that is known to last for ever. Its ending is `never`, unless the motion is
    // decided and the settings ask to stop then.
    void last_for_ever(bool is_decided) {
        if (!settings_.stop || stops_ || struck_ < settings_.blows.size()) return;
        if (!settings_.stop.decided || !is_decided) ending_ = Ending::never;
        stop();
    }

    // Starts a motion, and chooses its first law. A body that touches the ground and moves into it
    // collides at once.
    void begin(const InitialState& start) {
        begun_ = now();
        scene_ = motion_.scene;
        axes_exchanged_ = false;
        turned_ = {};
        low_ = {};
        sliding_on_.reset();
        next_ = {Mode::flight};
        state_ = in_units(start.state, units_);
        gap_rate_ = start.gap_rate / units_.speed();
        const bool touches = state_.z == geometry(axes(), state_.theta).h;
        const double blur = angle_roundings(state_.theta);
        recount(state_, {state_.theta, 0.0});
        if (state_.mode != Mode::flight) {
            start_with(continuation(scene_, state_, true, blur));
        } else if (touches && gap_rate_ < 0) {
            hit(State(state_), geometry(axes(), state_.theta), gap_rate_);
        }
    }

    void start_with(const Continuation& next) {
        next_ = next;
        if (is_stuck() && !next_.has_jammed) note(EventKind::jam, state_);
    }

    Axes axes() const { return scene_.axes(); }

    // Returns the angle from the nearest flat position or tip, where a thin body is most sensitive
    // to its angle, and exchanges the axes of the scene after an odd number of quarter turns.
    DoubleDouble count_from_quarter(DoubleDouble theta) {
        if (const double rest = resolved(theta.high); rest != theta.high) {
            turned_ = turned_ + two_sum(theta.high, -rest) + theta.low;
            theta = {rest, 0.0};
        }
        const QuarterView angle = quarter_view(theta);
        turned_ = turned_ + half_pi_exact * angle.quarters;
        if (is_odd(angle.quarters)) {
            std::swap(scene_.a, scene_.b);
            axes_exchanged_ = !axes_exchanged_;
        }
        return angle.rest;
    }

    // Continues from a state after measuring its angle from the nearest flat position or tip;
    // returns the new angle.
    DoubleDouble recount(const State& state, const DoubleDouble& theta) {
        const Scene before = scene_;
        const DoubleDouble angle = count_from_quarter(theta);
        state_ = with_angle(before, state, axes(), angle.high);
        return angle;
    }

    void follow() {
        state_.mode = next_.mode;
        if (is_stuck()) return stop_stuck();
        if (next_.grazes) return graze();
        switch (next_.mode) {
            case Mode::rest:
                return rest();
            case Mode::rolling:
                if (scene_.rolling_resistance > 0) return slide();
                return scene_.slope == 0 ? roll_on_level_ground() : roll_on_slope();
            case Mode::sliding:
                return slide();
            case Mode::flight:
                return fly();
        }
    }

    void rest() {
        add_segment(
            Standing{state_, rolling_force(scene_, geometry(axes(), state_.theta), state_.omega)});
        last_for_ever(true);
        finish();
    }

    bool is_stuck() const { return next_.paradox != Painleve::determined; }

    void stop_stuck() {
        add_segment(Standing{state_, {0.0, 0.0}});
        ending_ = next_.paradox == Painleve::no_motion ? Ending::jammed : Ending::undetermined;
    }

    void roll_on_level_ground() {
        const RollingStart start = rolling_start(scene_.body(), state_.theta, state_.omega);
        const double friction = friction_to_roll();
        const bool at_limit = friction != scene_.friction;
        EndOfRolling end = end_of_rolling(start, friction);
        // At the limit of friction, theta must change by at least one rounding error before rolling
        // ends.
        if (at_limit && end.angle && std::abs(*end.angle - start.theta) < epsilon) {
            end.angle = start.theta + end.heading * epsilon;
        }
        const RollingFlow flow = rolling_flow(start, state_.x);
        const bool ends = end.validity == Validity::invalid;
        if (!ends) last_for_ever(true);
        roll(flow, ends ? time_of_end(flow, end) : infinity);
    }

    void roll_on_slope() {
        SlopeFlow flow =
            slope_flow(scene_.body(), scene_.slope, state_.theta, state_.omega, state_.x);
        const LawMeetings met =
            law_meetings(flow, friction_to_roll(), settings_.stop ? infinity : time_left());
        const double lasts = met.broken ? met.broken->time : infinity;
        if (lasts == infinity && settings_.stop) {
            while (grow(flow)) continue;
            last_for_ever(period(flow).has_value());
        }
        prepare(flow, std::min(lasts, time_left()));
        roll(std::move(flow), lasts);
    }

    // The friction coefficient of a body that rolls. At the limit of the law, rounding hides
    // whether the body rolls or slips; a slightly larger coefficient then lets it roll until the
    // difference is clear.
    double friction_to_roll() const {
        const ContactForce force =
            rolling_force(scene_, geometry(axes(), state_.theta), state_.omega);
        return at_the_limit(force, scene_.friction) ? beyond_the_limit(scene_.friction)
                                                    : scene_.friction;
    }

    template <class Flow>
    void roll(Flow flow, double lasts) {
        if (lasts == infinity) {
            validate_time(until_ * units_.time, (now() + longest_time(flow)) * units_.time);
        }
        const auto kept = std::make_shared<const Flow>(std::move(flow));
        if (lasts > 0) add_segment(kept);
        if (!advance(lasts)) return;
        const auto [end, omega, x] = sample(*kept, lasts);
        const double theta = count_from_quarter({end, 0.0}).high;
        state_ = without_slip(axes(), theta, omega, x, Mode::rolling);
        continue_by_forces(false);
    }

    // Follows a slide, or rolling with resistance.
    void slide() {
        std::optional<double> rolls_by;
        if (next_.mode == Mode::rolling) rolls_by = friction_to_roll();
        Slide slide = slide_from(scene_, state_, next_.side, sliding_on_, rolls_by);
        sliding_on_.reset();
        const SlideStop stop = extend(slide);
        State last = end_of(slide);
        const DoubleDouble theta = angle_at_end(slide);
        SlidePoint end = slide.last;
        if (stop == SlideStop::slip_vanishes) {
            end.omega = omega_without_slip(slide);
            last.omega = double(end.omega);
        }
        const double lasts = double(end.time);
        counts_.steps += static_cast<long>(slide.pieces.size());
        if (!slide.pieces.empty()) add_segment(std::move(slide));
        if (stop == SlideStop::too_many_pieces) return give_up(Ending::max_steps, lasts);
        if (stop == SlideStop::no_progress) return give_up(Ending::step_too_small, lasts);
        if (stop == SlideStop::time_is_over) return finish();
        if (!advance(lasts)) return;
        end.angle = recount(last, theta);
        if (stop == SlideStop::law_fails) return continue_by_forces(false);
        const State before = state_;
        if (stop == SlideStop::rotation_vanishes) {
            turn_back();
        } else {
            end.slip = {};
            end_slide(stop, before);
        }
        if (next_.mode != before.mode) return;
        if (state_.x_dot != before.x_dot) end.x_dot = {state_.x_dot, 0.0};
        sliding_on_ = end;
    }

    // Extends a slide until something ends it or, if the motion is to stop at an event, until the
    // slide is known to last for ever.
    SlideStop extend(Slide& slide) {
        SlideBounds bounds{time_left(), settings_.max_steps - counts_.steps};
        if (!settings_.stop) return slide_on(slide, bounds, checkpoint_);
        EndlessSlide endless(slide, scene_.friction);
        bool lasts_for_ever = false;
        const SlideStop stop = slide_on(slide, bounds, [&] {
            checkpoint_();
            lasts_for_ever = endless.is_known();
            if (lasts_for_ever) bounds.most_pieces = 0;
        });
        if (!lasts_for_ever) return stop;
        last_for_ever(scene_.slope == 0);
        return SlideStop::time_is_over;
    }

    // Continues after rotation has stopped, where rolling resistance reverses its couple or holds
    // the body. Only a change of mode is an event.
    void turn_back() {
        const Continuation next = continuation(scene_, state_);
        const bool goes_on = next.mode == state_.mode && next.paradox == Painleve::determined;
        if (goes_on) {
            next_ = next;
            motion_.turns.push_back(now() * units_.time);
        } else {
            continue_with(next, kind_of(next.mode, EventKind::slip), State(state_));
        }
    }

    void end_slide(SlideStop stop, const State& before) {
        if (stop == SlideStop::jams) {
            next_.paradox = Painleve::no_motion;
            return note(EventKind::jam, before);
        }
        if (stop == SlideStop::pressure_vanishes) {
            return continue_with({Mode::flight}, EventKind::lift_off, before);
        }
        state_ = without_slip(axes(), before.theta, before.omega, before.x, Mode::sliding);
        const Continuation next = continuation(scene_, state_);
        // If the body keeps sliding, its x_dot does not change; h omega would add a rounding error.
        if (next.mode == Mode::sliding && is_rolling_speed(before.x_dot, state_.x_dot)) {
            state_.x_dot = before.x_dot;
        }
        continue_with(next, kind_of(next.mode, EventKind::reverse), before);
    }

    // Follows a grazing contact as free flight. The two motions agree to 1e-14 until the body has
    // turned by `turn_of_grazing`.
    void graze() {
        const Flight free{axes(), scene_.ground_gravity(), state_, 0.0, next_.mode};
        const double lasts = turn_of_grazing / std::abs(state_.omega);
        add_segment(free);
        if (!advance(lasts)) return;
        const State moved = state_at(free, lasts);
        state_ = grazing(geometry(axes(), moved.theta), moved, next_.mode);
        next_ = continuation(scene_, state_);
    }

    void fly() {
        const Flight flight{axes(), scene_.ground_gravity(), state_, gap_rate_};
        const auto [lasts, small_rate] = touch_down(flight);
        State before = state_at(flight, is_over_after(lasts) ? time_left() : lasts);
        // Bounces down a slope may grow until the state is no longer finite.
        if (!is_finite(before)) return give_up(Ending::step_too_small, 0.0);
        add_segment(flight);
        if (!advance(lasts)) return;
        add_flight(flight, lasts, before);
        const Geometry at = geometry(axes(), before.theta);
        before.z = at.h;
        hit(before, at, small_rate ? *small_rate : gap_rate(before, at));
    }

    // Adds the changes of angle, x and x_dot during a flight to a state; stores the low parts of
    // the sums.
    void add_flight(const Flight& flight, double lasts, State& state) {
        const auto& [into, along] = flight.gravity;
        const double moved = lasts * (flight.start.x_dot + 0.5 * along * lasts);
        const DoubleDouble x = DoubleDouble{state_.x, low_.x} + (moved + lasts * low_.x_dot);
        const DoubleDouble x_dot = DoubleDouble{state_.x_dot, low_.x_dot} + along * lasts;
        const double low = low_.theta + lasts * low_.omega;
        const DoubleDouble turned = two_product(state_.omega, lasts) + low;
        const DoubleDouble theta = count_from_quarter(turned + state_.theta);
        state.theta = theta.high;
        state.x = x.high;
        state.x_dot = x_dot.high;
        low_ = {theta.low, low_.omega, x.low, x_dot.low};
    }

    void hit(const State& before, const Geometry& at, double approach) {
        const auto [after, low, rebound] =
            collision(scene_, at, before, approach, Restitution::stronge, low_);
        state_ = after;
        // A rebound slower than the rounding error of `speed_of_fall` counts as no rebound.
        if (!(rebound > epsilon * speed_of_fall(scene_))) {
            state_.z_dot = at.dh * state_.omega;
            return continue_with(continuation(scene_, state_), EventKind::impact, before);
        }
        const double c = free_acceleration(at, scene_.ground_gravity().into, state_.omega);
        const Bounce bounce{rebound, rebound / -approach, c};
        continue_with({Mode::flight}, EventKind::impact, before, rebound);
        low_ = low;
        if (!ending_ && settles(scene_, state_.omega, bounce, rest_speed_)) settle(bounce);
    }

    void settle(const Bounce& first) {
        const Settling bounces = settling(scene_, state_, first);
        add_segment(bounces);
        if (!advance(bounces.lasts)) return;
        recount(bounces.end, bounces.angle);
        continue_by_forces(true);
    }

    void continue_by_forces(bool may_roll) {
        const Continuation next = continuation(scene_, state_, may_roll);
        // A start at the limit of rolling changes its mode without an event.
        if (has_just_begun()) return start_with(next);
        continue_with(next, kind_of(next.mode, EventKind::slip), State(state_));
    }

    void continue_with(const Continuation& next, EventKind kind, const State& before,
                       double rebound = 0.0) {
        next_ = next;
        low_ = {};
        gap_rate_ = rebound;
        state_.mode = next.mode;
        note(kind, before);
        if (is_stuck() && !ending_) note(EventKind::jam, state_);
    }

    bool has_just_begun() const {
        const auto& events = motion_.events;
        return static_cast<double>(t_ + -begun_) == 0 &&
               (events.empty() || events.back().kind == EventKind::blow);
    }

    void note(EventKind kind, const State& before) {
        const State was = in_full(before);
        note({now() * units_.time, kind, was, start_after(given_, kind, was, in_full(state_))});
    }

    void note(const Event& event) {
        if (static_cast<long>(motion_.events.size()) == settings_.max_events) {
            ending_ = Ending::max_events;
            return;
        }
        if (motion_.events.empty()) motion_.events.reserve(usual_events);
        motion_.events.push_back(event);
        const bool counts = (settings_.stop.kinds >> int(event.kind) & 1) != 0;
        if (counts && --left_ == 0) stop();
    }

    // The state in SI units, with its total angle.
    State in_full(const State& state) const {
        return in_si(with_whole_angle(scene_, state, turned_, motion_.scene), units_);
    }

    template <class Law>
    void add_segment(Law law) {
        motion_.segments.push_back({now(), std::move(law), turned_ + low_.theta, axes_exchanged_});
    }

    double now() const { return static_cast<double>(t_); }
    double time_left() const { return static_cast<double>(-t_ + until_); }
    bool is_over_after(double lasts) const {
        return !(static_cast<double>(t_ + lasts) <= until_);  // t_ + infinity is NaN
    }

    // Advances the time to the end of the segment just added; false if `until_` comes first.
    bool advance(double lasts) {
        if (is_over_after(lasts)) {
            finish();
            return false;
        }
        t_ = t_ + lasts;
        return true;
    }

    void finish() {
        t_ = {until_, 0.0};
        is_there_ = true;
    }

    // Ends the motion early, at the time `lasts` after the start of its last segment.
    void give_up(Ending ending, double lasts) {
        t_ = t_ + lasts;
        ending_ = ending;
    }

    const Units units_;
    const Scene& given_;  // the scene in SI units
    Scene scene_;         // the scene, with axes exchanged after an odd number of quarter turns
    const Settings& settings_;
    const double t_end_;      // [s]
    double until_ = 0.0;      // time of the next blow, or of the end
    bool is_there_ = true;    // whether `until_` is reached
    std::size_t struck_ = 0;  // number of blows so far
    long left_;               // number of events of the chosen kinds left until the motion stops
    bool stops_ = false;      // whether the motion stops now
    double begun_ = 0.0;      // time of the start, or of the last blow
    const Checkpoint& checkpoint_;
    State state_;
    double gap_rate_;
    const double rest_speed_;
    Motion motion_;
    std::optional<InitialState> start_;     // start of the motion to be followed next
    std::optional<SlidePoint> sliding_on_;  // end of the last slide, if a slide follows it
    DoubleDouble turned_;                   // quarter turns subtracted from theta
    LowParts low_;                          // low parts of state_, preserved from impact to impact
    bool axes_exchanged_ = false;
    Continuation next_{Mode::flight};
    DoubleDouble t_;
    StepCounts counts_;
    std::optional<Ending> ending_;  // set if the motion ends early
};

}  // namespace

Integration<Motion> integrate_contact(const Scene& scene, const InitialState& start,
                                      const Settings& settings, double t_end,
                                      const Checkpoint& checkpoint) {
    return ContactRun(scene, start, settings, t_end, checkpoint).run();
}

}  // namespace rolling_ellipse
