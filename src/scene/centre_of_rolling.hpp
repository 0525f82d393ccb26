// The force of the ground on a rolling body, and the acceleration of its centre.
#pragma once

namespace rolling_ellipse {

// The components of a vector along the normal and along the ground; T is a double or a Pack.
template <class T>
struct Components {
    T normal;
    T along;
};

template <class T>
struct CentreOfRolling {
    Components<T> force_per_mass;
    Components<T> acceleration;
};

// Computes the force and the acceleration without subtracting accelerations. Near the tip of a thin
// body the normal force is small, and such a difference would be inaccurate. With w = h h'' - h'^2
// = (a^2 - b^2) (b^2 cos^2 - a^2 sin^2)/h^2, D the inertia per mass about the contact, and
// gravity's components `into` the ground and `along` it:
//     N/m = ((k^2 h'' + h w) omega^2 + (k^2 + h^2) into + h h' along)/D,      physics (23)
//     F/m = (h' (k^2 - w) omega^2 - h h' into - (k^2 + h'^2) along)/D,        physics (24)
// For the acceleration, the factor of `into` is -h'^2 instead of k^2 + h^2, and the factor of
// `along` is h^2 instead of -(k^2 + h'^2).
template <class T>
[[gnu::always_inline]] inline CentreOfRolling<T> centre_of_rolling(double k2, double into,
                                                                   double along, T h, T dh, T ddh,
                                                                   T w, T omega2) {
    const T h2 = h * h;
    const T dh2 = dh * dh;
    const T lever = h * dh;
    const T over_inertia = 1 / (k2 + h2 + dh2);
    const T lifting = omega2 * (k2 * ddh + h * w);
    const T pushing = omega2 * (dh * (k2 - w));
    return {{(lifting + (k2 + h2) * into + lever * along) * over_inertia,
             (pushing - lever * into - (k2 + dh2) * along) * over_inertia},
            {(lifting - dh2 * into + lever * along) * over_inertia,
             (pushing - lever * into + h2 * along) * over_inertia}};
}

}  // namespace rolling_ellipse
