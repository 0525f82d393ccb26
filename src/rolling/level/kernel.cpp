#include "rolling/level/kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "rolling/level/kernel_code.hpp"

namespace rolling_ellipse {
namespace {

constexpr std::size_t most_bodies = 512;  // bodies per kernel call

constexpr int most_keys = 144;
constexpr int no_key = -1;

// The key by which bodies are sorted, so that bodies in the same vector have similar numbers of
// steps in a quarter; `no_key` for a body that the kernel cannot compute.
int key_of(const RollingStart& start, double t) {
    const bool is_finite = std::abs(t) <= std::numeric_limits<double>::max();
    if (start.rests || start.view.c2 == 0 || t == 0 || !is_finite) return no_key;
    // For a short move, only a power series is accurate: the kernel would subtract nearly equal
    // times.
    if (may_be_short(start, t)) return no_key;
    const PhaseIntegrand<double> integrand = phase_integrand(phase_start(start));
    const double grade2 = integrand.d0 / (integrand.d1 * integrand.amplitude2 + integrand.d0);
    // The square of kappa g, 0 on the separatrix; the smaller it is, the longer the quarter.
    const double complement2 = square(integrand.kappa) * grade2;
    if (!(complement2 > 1e-20 && integrand.kappa > largest_tail_kappa)) return no_key;
    return 2 * std::min(-std::ilogb(complement2), most_keys / 2 - 1) + integrand.rotates;
}

}  // namespace

const std::vector<Kernel>& kernels() {
    static const std::vector<Kernel> found = [] {
        Kernel one_by_one = compiled;
        one_by_one.name = "one by one";
        one_by_one.sample = nullptr;
        std::vector<Kernel> all{one_by_one};
#ifdef ROLLING_ELLIPSE_HAS_LANES
        all.push_back(compiled);
        if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
            all.push_back(kernel_avx2());
            if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                __builtin_cpu_supports("avx512vl")) {
                all.push_back(kernel_avx512());
            }
        }
#endif
        return all;
    }();
    return found;
}

const Kernel& kernel() { return kernels().back(); }

void sample(const Kernel& kernel, const RollingStart* starts, const double* times, std::size_t n,
            FlowSample* samples) {
    if (!kernel.sample) {
        for (std::size_t i = 0; i < n; ++i) samples[i] = sample_alone(starts[i], times[i]);
        return;
    }
    for (std::size_t begin = 0; begin < n; begin += most_bodies) {
        const int count = static_cast<int>(std::min(most_bodies, n - begin));
        std::array<int, most_bodies> keys;
        std::array<int, most_keys> ends{};
        for (int k = 0; k < count; ++k) {
            const std::size_t i = begin + k;
            keys[k] = key_of(starts[i], times[i]);
            if (keys[k] == no_key) {
                samples[i] = sample_alone(starts[i], times[i]);
            } else {
                ++ends[keys[k]];
            }
        }
        // Counting sort: each entry of `ends` is at first the start of its key's range, and later
        // its end.
        int sorted = 0;
        for (int& end : ends) sorted += std::exchange(end, sorted);
        std::array<std::uint32_t, most_bodies> places;
        for (int k = 0; k < count; ++k) {
            if (keys[k] != no_key) places[ends[keys[k]]++] = static_cast<std::uint32_t>(begin + k);
        }
        std::array<bool, most_bodies> is_open;
        kernel.sample(starts, times, places.data(), sorted, samples, is_open.data());
        for (int k = 0; k < sorted; ++k) {
            const std::uint32_t i = places[k];
            if (is_open[k]) samples[i] = sample_alone(starts[i], times[i]);
        }
    }
}

}  // namespace rolling_ellipse
