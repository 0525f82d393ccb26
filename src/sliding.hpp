// Sliding with Coulomb friction in one direction: contact force, equation, and what ends it.
#pragma once

#include "integrator/common.hpp"
#include "rolling.hpp"
#include "scene.hpp"

namespace rolling_ellipse {

// The contact as a free body has it, per mass: what an impulse (along, away from) the ground
// changes of the contact velocity (Delassus), and the acceleration -c of the gap without a force.
struct FreeContact {
    double gtt;
    double gtn;
    double gnn;
    double c;
};

FreeContact free_contact(const Scene& scene, const Geometry& at, double omega);

// y = (theta, omega, x, slip velocity); side is the sign of the slip. With infinite friction the
// limit holds: no normal force, and friction alone keeps the gap closed.
class SlidingEquation {
  public:
    static constexpr int size = 4;

    SlidingEquation(const Scene& scene, double side);

    Vector<4> operator()(double t, const Vector<4>& y) const;

    // What stays positive while it slides on: slip, the free acceleration c into the ground, and B,
    // the normal acceleration that a unit of normal force makes (Painleve).
    struct Margins {
        double slip;
        double c;
        double b;
    };
    Margins margins(const Vector<4>& y) const;

    ContactForce force(double theta, double omega) const;

  private:
    double normal_response(const FreeContact& contact) const;

    Scene scene_;
    double side_;
};

}  // namespace rolling_ellipse
