// The names of the values of an enum, which count up from 0. Each enum specializes `names`.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace rolling_ellipse {

template <class Enum>
inline constexpr std::array<const char*, 0> names{};

template <class Enum>
std::string name(Enum value) {
    return names<Enum>[static_cast<std::size_t>(value)];
}

}  // namespace rolling_ellipse
