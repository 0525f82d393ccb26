"""The scenes whose motions are looked at sample by sample."""

import rolling_ellipse as rl
from rolling_ellipse import Scene

SCENES = {
    "report": rl.scenes.report,
    "rocking": rl.scenes.rocking,
    "circle": rl.scenes.circle,
    "circle + 1e-8": Scene(1.0 + 1e-8, 1.0, theta=0.3, omega=1.5),
    "thin": rl.scenes.thin,
    "standing": Scene(0.7, 1.9, mass=3.0, gravity=3.7, inertia=2.0, theta=1.2, omega=1.0, x=-5.0),
    "backwards": Scene(2.0, 1.0, mass=0.2, omega=-3.3, friction=2.0),
}
VECTORS = (
    "t", "x", "z", "theta", "psi", "r", "x_dot", "z_dot", "omega", "psi_dot", "r_dot", "x_ddot",
    "z_ddot", "omega_dot", "psi_ddot", "r_ddot", "contact_x", "turns", "normal_force",
    "friction_force", "friction_needed", "energy", "kinetic_energy", "potential_energy",
)  # fmt: skip
MATRICES = {"q": 5, "q_dot": 5, "multipliers": 4}
