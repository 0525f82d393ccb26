#include "rolling/level/many_bodies.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "rolling/level/motion.hpp"

namespace rolling_ellipse {
namespace {

constexpr std::size_t most_bodies = 512;  // of one kernel call

FlowSample sample_alone(const RollingStart& start, double t) {
    const RollingFlow flow = rolling_flow(start);
    validate_time(t, longest_time(flow));
    return sample(flow, t);
}

// Bodies in the order of their steps in a quarter, so that those side by side take as many.
class Order {
  public:
    // Takes the body that has this start, unless it has to be alone.
    bool takes(const RollingStart& start, double t, std::uint32_t place) {
        const bool is_finite = std::abs(t) <= std::numeric_limits<double>::max();
        if (start.rests || start.view.c2 == 0 || t == 0 || !is_finite) return false;
        // A short move is the small difference of two times, which its power series is not.
        if (may_be_short(t, start.omega, start.body.gravity, start.view.short_axis)) return false;
        const PhaseRate<double> rate = phase_rate(phase_start(start));
        const double grade2 = rate.d0 / (rate.d1 * rate.amplitude2 + rate.d0);
        // A quarter is as long as this is small; at the separatrix it is 0.
        const double complement2 = square(rate.kappa) * grade2;
        if (!(complement2 > 1e-20)) return false;
        const int key = 2 * std::min(-std::ilogb(complement2), most_keys / 2 - 1) + rate.rotates;
        found_[count_] = {place, static_cast<std::uint32_t>(key)};
        ++ends_[key];
        ++count_;
        return true;
    }

    // The places, in order.
    int sort(std::uint32_t* places) {
        std::uint32_t begin = 0;
        for (std::uint32_t& end : ends_) begin += std::exchange(end, begin);
        for (int i = 0; i < count_; ++i) places[ends_[found_[i].key]++] = found_[i].place;
        return count_;
    }

  private:
    static constexpr int most_keys = 144;
    struct Found {
        std::uint32_t place;
        std::uint32_t key;
    };
    std::array<Found, most_bodies> found_;
    std::array<std::uint32_t, most_keys> ends_{};
    int count_ = 0;
};

}  // namespace

void sample(const Kernel& kernel, const RollingStart* starts, const double* times, std::size_t n,
            FlowSample* samples) {
    if (!kernel.sample) {
        for (std::size_t i = 0; i < n; ++i) samples[i] = sample_alone(starts[i], times[i]);
        return;
    }
    for (std::size_t begin = 0; begin < n; begin += most_bodies) {
        const std::size_t end = std::min(begin + most_bodies, n);
        Order order;
        for (std::size_t i = begin; i < end; ++i) {
            const bool is_alone = !order.takes(starts[i], times[i], static_cast<std::uint32_t>(i));
            if (is_alone) samples[i] = sample_alone(starts[i], times[i]);
        }
        std::array<std::uint32_t, most_bodies> places;
        std::array<bool, most_bodies> is_alone;
        const BodiesAtTimes bodies{starts, times, places.data(), order.sort(places.data())};
        kernel.sample(bodies, samples, is_alone.data());
        for (int k = 0; k < bodies.count; ++k) {
            const std::uint32_t i = places[k];
            if (is_alone[k]) samples[i] = sample_alone(starts[i], times[i]);
        }
    }
}

}  // namespace rolling_ellipse
