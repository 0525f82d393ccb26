#include "sliding.hpp"

#include <cmath>

namespace rolling_ellipse {

FreeContact free_contact(const Scene& scene, const Geometry& at, double omega) {
    const double k2 = scene.body().gyration2;
    return {1 + at.h * at.h / k2, at.h * at.dh / k2, 1 + at.dh * at.dh / k2,
            scene.gravity * std::cos(scene.slope) + at.ddh * omega * omega};
}

SlidingEquation::SlidingEquation(const Scene& scene, double side) : scene_(scene), side_(side) {}

// B = Gnn - mu s Gnt; of infinite friction its leading term.
double SlidingEquation::normal_response(const FreeContact& contact) const {
    if (std::isinf(scene_.friction)) return -side_ * contact.gtn;
    return contact.gnn - scene_.friction * side_ * contact.gtn;
}

ContactForce SlidingEquation::force(double theta, double omega) const {
    const FreeContact contact = free_contact(scene_, geometry({scene_.a, scene_.b}, theta), omega);
    const double push = scene_.mass * contact.c / normal_response(contact);
    if (std::isinf(scene_.friction)) return {0.0, -side_ * push};
    return {push, -scene_.friction * side_ * push};
}

Vector<4> SlidingEquation::operator()(double, const Vector<4>& y) const {
    const double omega = y[1];
    const Geometry at = geometry({scene_.a, scene_.b}, y[0]);
    const FreeContact contact = free_contact(scene_, at, omega);
    const ContactForce of = force(y[0], omega);
    const double normal = of.normal / scene_.mass;
    const double friction = of.friction / scene_.mass;
    const double omega_dot = -(at.h * friction + at.dh * normal) / scene_.body().gyration2;
    const double slip_dot = contact.gtt * friction + contact.gtn * normal +
                            scene_.gravity * std::sin(scene_.slope) - at.dh * omega * omega;
    return {omega, omega_dot, y[3] + at.h * omega, slip_dot};
}

SlidingEquation::Margins SlidingEquation::margins(const Vector<4>& y) const {
    const FreeContact contact = free_contact(scene_, geometry({scene_.a, scene_.b}, y[0]), y[1]);
    return {side_ * y[3], contact.c, normal_response(contact)};
}

}  // namespace rolling_ellipse
