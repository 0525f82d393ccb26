// Numbers out of the bytes of a fuzzer: tame ones, in the ranges in which bodies live, extremes,
// and any bits at all. After the last byte all are zero.
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

    // In [0, 1], 2^16 places.
    double share() {
        const int high = byte();
        return (256 * high + byte()) / 65535.0;
    }

    double between(double low, double high) {
        return wild() ? any() : low + share() * (high - low);
    }

    // Of a size between 10^low and 10^high.
    double power(double low, double high) {
        return wild() ? any() : std::pow(10.0, low + share() * (high - low));
    }

    double sign() { return chance(128) ? -1.0 : 1.0; }

    // Any bits; a few of them are tried more often.
    double any() {
        static constexpr double extremes[] = {
            0.0,
            -0.0,
            1.0,
            -1.0,
            5e-324,
            2.2250738585072014e-308,
            1e-100,
            1e-30,
            1e30,
            1e50,
            1e150,
            std::numeric_limits<double>::max(),
            std::numeric_limits<double>::infinity(),
            std::numeric_limits<double>::quiet_NaN(),
            1.5707963267948966,
            3.141592653589793,
        };
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
