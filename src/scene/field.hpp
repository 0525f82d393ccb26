// The numbers of a struct by name and unit. A table of them stands below the struct; code that
// copies, scales or names all of its numbers reads the table.
#pragma once

namespace rolling_ellipse {

// A unit as printed (in UTF-8; C2 B2 is a raised 2), and its exponents of metre, second, kilogram.
struct Unit {
    const char* symbol;
    int length = 0;
    int time = 0;
    int mass = 0;
};

// An integer power.
inline double power(double base, int exponent) {
    double found = 1.0;
    for (int i = 0; i < exponent; ++i) found *= base;
    for (int i = 0; i > exponent; --i) found /= base;
    return found;
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

}  // namespace rolling_ellipse
