#include "scene/field.hpp"

#include <cmath>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "numerics/numbers.hpp"

namespace rolling_ellipse {

// Uses the fewest digits, at least 15, that distinguish the number from its neighbours; 17 suffice.
std::string text(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    std::string digits;
    for (int count = 15; count <= 17; ++count) {
        std::stringstream stream;
        stream.imbue(std::locale::classic());
        stream.precision(count);
        stream << value;
        digits = stream.str();
        double again = 0.0;
        stream >> again;
        if (again == value) break;
    }
    if (digits.find_first_of(".e") == std::string::npos) digits += ".0";
    return digits;
}

void refuse(std::string_view name, const std::string& requirement, double value) {
    refuse(name, requirement, text(value));
}

void refuse(std::string_view name, const std::string& requirement, const std::string& value) {
    throw std::invalid_argument(std::string(name) + " must be " + requirement + ", got " + value);
}

std::string in_brackets(const Unit& unit) { return std::string(" [") + unit.symbol + "]"; }

void require_finite(const char* name, const Unit& unit, double value) {
    if (!(std::abs(value) <= largest_number)) {
        refuse(name, "a finite number" + in_brackets(unit) + " of at most 1e50", value);
    }
}

void require_positive(std::string_view name, std::string_view kind, double value) {
    if (!(value > 0 && std::isfinite(value))) {
        refuse(name, "a positive finite " + std::string(kind), value);
    }
    // Within these bounds, the product of four lengths, an energy and gravity does not overflow.
    if (value < 1e-30 || value > 1e30) {
        refuse(name, "a " + std::string(kind) + " between 1e-30 and 1e30", value);
    }
}

}  // namespace rolling_ellipse
