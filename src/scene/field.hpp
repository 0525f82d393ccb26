// Names and units of the fields of structs, and the rejection of invalid values. A table after each
// struct lists its fields for code that copies, scales or names them all.
#pragma once

#include <string>
#include <string_view>

namespace rolling_ellipse {

// The symbol of a unit in UTF-8 (C2 B2 is a superscript 2) and its exponents of metre, second and
// kilogram.
struct Unit {
    const char* symbol;
    int length = 0;
    int time = 0;
    int mass = 0;
};

// An integer power.
inline double power(double base, int exponent) {
    if (exponent < 0) return power(1 / base, -exponent);
    double product = 1.0;
    for (int i = 0; i < exponent; ++i) product *= base;
    return product;
}

namespace unit {
inline constexpr Unit none{""};
inline constexpr Unit angle{"rad"};
inline constexpr Unit angular_velocity{"rad/s", 0, -1};
inline constexpr Unit length{"m", 1};
inline constexpr Unit speed{"m/s", 1, -1};
inline constexpr Unit acceleration{"m/s\xC2\xB2", 1, -2};
inline constexpr Unit mass{"kg", 0, 0, 1};
inline constexpr Unit inertia{"kg m\xC2\xB2", 2, 0, 1};
inline constexpr Unit force{"N", 1, -2, 1};
inline constexpr Unit impulse{"N s", 1, -1, 1};
inline constexpr Unit energy{"J", 2, -2, 1};
}  // namespace unit

template <class Struct>
struct Field {
    const char* name;
    double Struct::* number;
    Unit unit;
};

// A double as Python prints it, except that subnormals and numbers from 1e15 to 1e17 may differ.
std::string text(double value);

// Throws std::invalid_argument, which Python shows as ValueError: "name must be requirement, got
// value".
[[noreturn]] void refuse(std::string_view name, const std::string& requirement, double value);
[[noreturn]] void refuse(std::string_view name, const std::string& requirement,
                         const std::string& value);

// A unit as it appears in messages: " [m]".
std::string in_brackets(const Unit& unit);

// Throws unless a position, velocity or impulse is finite and at most 1e50 in magnitude.
void require_finite(const char* name, const Unit& unit, double value);

// Throws unless a quantity of the given kind ("length [m]") is between 1e-30 and 1e30.
void require_positive(std::string_view name, std::string_view kind, double value);

}  // namespace rolling_ellipse
