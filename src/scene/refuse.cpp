#include "scene/refuse.hpp"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {
namespace {

// Within these no product of four lengths, an energy and gravity leaves the range of doubles.
constexpr double smallest = 1e-30;
constexpr double largest = 1e30;

}  // namespace

std::string text(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    char buffer[40];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    std::string digits(buffer, end);
    if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
    return digits;
}

void refuse(std::string_view name, const std::string& requirement, double value) {
    throw std::invalid_argument(std::string(name) + " must be " + requirement + ", got " +
                                text(value));
}

void require_finite(std::string_view name, std::string_view unit, double value) {
    if (!(std::abs(value) <= largest_number)) {
        refuse(name, "a finite number" + std::string(unit) + " of at most 1e50", value);
    }
}

void require_positive(std::string_view name, std::string_view kind, double value) {
    if (!(value > 0 && std::isfinite(value))) {
        refuse(name, "a positive finite " + std::string(kind), value);
    }
    if (value < smallest || value > largest) {
        refuse(name, "a " + std::string(kind) + " between 1e-30 and 1e30", value);
    }
}

}  // namespace rolling_ellipse
