// The path of the centre of several ellipses side by side, as geometry/ellipse.hpp has it for one.
#pragma once

#include "numerics/lanes.hpp"

namespace rolling_ellipse {
namespace {

struct CarlsonPairs {
    Pack rf;
    Pack rd;
};

// Duplication until every lane is near enough for the series; a lane that is stays as it is. See
// carlson in geometry/ellipse.cpp.
inline CarlsonPairs carlson(Pack x, Pack y, Pack z) {
    constexpr double series_radius = 1e-2;
    constexpr int most_duplications = 40;
    Pack rd_sum{};
    Pack power = pack(1.0);  // 4^-n
    for (int i = 0; i < most_duplications; ++i) {
        const Pack mean = (x + y + 3 * z) * 0.2;
        const Pack spread = max(max(abs(mean - x), abs(mean - y)), abs(mean - z));
        const Mask wide = spread >= series_radius * mean;
        if (!any(wide)) break;
        const Pack rx = sqrt(x);
        const Pack ry = sqrt(y);
        const Pack rz = sqrt(z);
        const Pack lambda = rx * (ry + rz) + ry * rz;
        rd_sum = wide ? rd_sum + power / (rz * (z + lambda)) : rd_sum;
        power = wide ? power * 0.25 : power;
        x = wide ? (x + lambda) * 0.25 : x;
        y = wide ? (y + lambda) * 0.25 : y;
        z = wide ? (z + lambda) * 0.25 : z;
    }

    CarlsonPairs result;
    {
        const Pack mean = (x + y + z) / 3;
        const Pack inverse = 1 / mean;
        const Pack dx = (mean - x) * inverse;
        const Pack dy = (mean - y) * inverse;
        const Pack dz = -(dx + dy);
        const Pack e2 = dx * dy - dz * dz;
        const Pack e3 = dx * dy * dz;
        const Pack series = e3 * (1.0 / 14 - e2 * (3.0 / 44) + e3 * (3.0 / 104)) -
                            e2 * (0.1 - e2 * (1.0 / 24 - e2 * (5.0 / 208) + e3 * (1.0 / 16)));
        const Pack root = sqrt(mean);
        result.rf = (1 + series) / root;
    }
    {
        const Pack mean = (x + y + 3 * z) * 0.2;
        const Pack inverse = 1 / mean;
        const Pack dx = (mean - x) * inverse;
        const Pack dy = (mean - y) * inverse;
        const Pack dz = -(dx + dy) / 3;
        const Pack xy = dx * dy;
        const Pack zz = dz * dz;
        const Pack e2 = xy - 6 * zz;
        const Pack e3 = (3 * xy - 8 * zz) * dz;
        const Pack e4 = 3 * (xy - zz) * zz;
        const Pack e5 = xy * zz * dz;
        const Pack series =
            e2 * (-3.0 / 14 + e2 * (9.0 / 88 - e2 * (1.0 / 16) + e3 * (45.0 / 272))) +
            e3 * (1.0 / 6 - e2 * (9.0 / 52) + e3 * (3.0 / 40)) -
            e4 * (3.0 / 22 - e2 * (3.0 / 20) + e3 * (9.0 / 68)) + e5 * (3.0 / 26 - e2 * (9.0 / 68));
        const Pack root = sqrt(mean);
        result.rd = 3 * rd_sum + power * (1 + series) / (mean * root);
    }
    return result;
}

struct PackAxes {
    Pack long2;
    Pack short2;
    Pack c2;
};

// path_from_flat, or path_from_tip where `from_tip`, of geometry/ellipse.hpp.
inline Pack path(const PackAxes& axes, Mask from_tip, Pack sin, Pack cos) {
    const Pack near2 = from_tip ? axes.long2 : axes.short2;  // h^2 where the offset is 0
    const Pack far2 = axes.short2 * sin * sin;
    const Pack h2 = from_tip ? axes.long2 * cos * cos + far2 : axes.short2 + axes.c2 * sin * sin;
    const auto [rf, rd] = carlson(near2 * cos * cos, from_tip ? near2 : h2, from_tip ? h2 : near2);
    const Pack arc = axes.short2 * sin * (rf + axes.c2 * sin * sin / 3 * rd);
    return from_tip ? arc + axes.c2 * sin * cos / sqrt(h2) : arc;
}

}  // namespace
}  // namespace rolling_ellipse
