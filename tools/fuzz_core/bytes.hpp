// Numbers drawn from the bytes of a fuzzer: ordinary numbers, extremes, and arbitrary bits. After
// the last byte all bytes are zero.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace fuzz_core {

class Bytes {
  public:
    Bytes(const std::uint8_t* data, std::size_t size) : next_(data), end_(data + size) {}

    std::uint8_t byte() { return next_ == end_ ? 0 : *next_++; }

    bool chance(int of_256) { return byte() < of_256; }

    int choice(int count) { return byte() % count; }

    // A number in [0, 1], a multiple of 2^-16.
    double share() {
        const int high = byte();
        return (256 * high + byte()) / 65535.0;
    }

    double between(double low, double high) {
        return wild() ? any() : low + share() * (high - low);
    }

    // A number between 10^low and 10^high.
    double power(double low, double high) {
        return wild() ? any() : std::pow(10.0, low + share() * (high - low));
    }

    double sign() { return chance(128) ? -1.0 : 1.0; }

    // A double of arbitrary bits, half of the time one of a few extremes.
    double any() {
        using limits = std::numeric_limits<double>;
        static constexpr double extremes[] = {
            0.0,    -0.0, 1.0,  -1.0,  5e-324,        limits::min(),      1e-100,
            1e-30,  1e30, 1e50, 1e150, limits::max(), limits::infinity(), limits::quiet_NaN(),
            M_PI_2, M_PI};
        const int kind = byte();
        if (kind < 128) return extremes[kind % 16];
        std::uint64_t bits = 0;
        for (int i = 0; i < 8; ++i) bits = bits << 8 | byte();
        double value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
    }

  private:
    bool wild() { return chance(8); }

    const std::uint8_t* next_;
    const std::uint8_t* end_;
};

}  // namespace fuzz_core
