// The force of the ground on a rolling body, and the acceleration of its centre.
#pragma once

namespace rolling_ellipse {

// Numbers, or packs of them, along the normal and along the ground.
template <class T>
struct Components {
    T normal;
    T along;
};

// The laws of the centre without differences of accelerations, which would lose digits where a thin
// body is light on its tip. With w = h h'' - h'^2 = (a^2 - b^2) (b^2 cos^2 - a^2 sin^2)/h^2, D the
// inertia about the contact, and gravity into the ground and along it:
//     N/m = ((k^2 h'' + h w) omega^2 + (k^2 + h^2) into + h h' along)/D,      physics (23)
//     F/m = (h' (k^2 - w) omega^2 - h h' into - (k^2 + h'^2) along)/D,        physics (24)
// and for the acceleration -h'^2 into instead of the second term of N/m, h^2 along instead of the
// last one of F/m.
template <class T>
struct CentreOfRolling {
    double gyration2;
    double into;
    double along;
    T h2;
    T dh2;
    T lever;
    T over_inertia;
    Components<T> by_turning;

    [[gnu::always_inline]] CentreOfRolling(double k2, double into, double along, T h, T dh, T ddh,
                                           T w, T omega2)
        : gyration2(k2),
          into(into),
          along(along),
          h2(h * h),
          dh2(dh * dh),
          lever(h * dh),
          over_inertia(1 / (k2 + h2 + dh2)),
          by_turning{omega2 * (k2 * ddh + h * w), omega2 * (dh * (k2 - w))} {}

    [[gnu::always_inline]] Components<T> force_per_mass() const {
        return {(by_turning.normal + (gyration2 + h2) * into + lever * along) * over_inertia,
                (by_turning.along - lever * into - (gyration2 + dh2) * along) * over_inertia};
    }

    [[gnu::always_inline]] Components<T> acceleration() const {
        return {(by_turning.normal - dh2 * into + lever * along) * over_inertia,
                (by_turning.along - lever * into + h2 * along) * over_inertia};
    }
};

}  // namespace rolling_ellipse
