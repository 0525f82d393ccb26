"""Follow a slide towards Painleve's paradox (B = 0) until its slip vanishes, with 45 digits.

    python reference/impulse_clock.py

The independent variable is the impulse of the normal force, since derivatives with respect to it
stay finite as B vanishes. contact_motion.py, which defines B and uses time, stops at B = 0. The
integrator extrapolates the midpoint rule (W. Gragg). The script prints the numbers in
tests/contact/test_slides.py.
"""

from typing import Any

import mpmath as mp
import rolling_ellipse as rl

mp.mp.dps = 45
TOLERANCE, AT_REST = mp.mpf(10) ** -36, mp.mpf(10) ** -38
POINTS = (2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 24, 28, 32)  # substeps of the midpoint rule
NAMES = ("theta", "omega", "x_dot", "t", "x")
LIGHT: dict[str, Any] = {"inertia": 2e-4, "friction": 0.43, "theta": 1.618, "x_dot": 0.485}
SCENES = (
    rl.Scene(0.25, 1.0, omega=0.2, **LIGHT),
    rl.Scene(0.25, 1.0, omega=0.3, **LIGHT),
    rl.Scene(1.0, 0.42, inertia=3e-4, friction=0.91, theta=-2.7, omega=1.0, x_dot=0.64),
)


def rates(scene: rl.Scene, side: int, y: list[Any]) -> tuple[list[Any], Any]:
    """Return the derivatives of the state y (see NAMES) with respect to the impulse per unit mass,
    and the slip."""
    theta, omega, x_dot, _, _ = y
    a, b, k2 = mp.mpf(scene.a), mp.mpf(scene.b), mp.mpf(scene.inertia) / mp.mpf(scene.mass)
    sine, cosine, c2 = mp.sin(theta), mp.cos(theta), (a - b) * (a + b)
    h = mp.sqrt((a * sine) ** 2 + (b * cosine) ** 2)
    dh = c2 * sine * cosine / h
    ddh = (c2 * (cosine**2 - sine**2) - dh**2) / h
    friction = -side * mp.mpf(scene.friction)
    pressed = mp.mpf(scene.gravity) * mp.cos(mp.mpf(scene.slope)) + ddh * omega**2
    time = (1 + dh**2 / k2 + friction * h * dh / k2) / pressed
    pulled = mp.mpf(scene.gravity) * mp.sin(mp.mpf(scene.slope)) * time
    spin = -(h * friction + dh) / k2
    return [omega * time, spin, friction + pulled, time, x_dot * time], x_dot - h * omega


def stepped(scene: rl.Scene, side: int, y: list[Any], step: Any) -> tuple[list[Any], Any]:
    """Return the state after a step, and an estimate of its error."""
    rows: list[list[list[Any]]] = []
    for i, n in enumerate(POINTS):
        part = step / n
        old, new = y, [p + part * q for p, q in zip(y, rates(scene, side, y)[0], strict=True)]
        for _ in range(n - 1):
            slopes = rates(scene, side, new)[0]
            old, new = new, [p + 2 * part * q for p, q in zip(old, slopes, strict=True)]
        slopes = rates(scene, side, new)[0]
        row = [[(p + q + part * r) / 2 for p, q, r in zip(old, new, slopes, strict=True)]]
        for k in range(i):
            weight = (mp.mpf(n) / POINTS[i - k - 1]) ** 2 - 1
            pairs = zip(row[k], rows[-1][k], strict=True)
            row.append([p + (p - q) / weight for p, q in pairs])
        rows.append(row)
    last, before = rows[-1][-1], rows[-1][-2]
    return last, max(abs(p - q) for p, q in zip(last, before, strict=True))


def end_of_slide(scene: rl.Scene) -> list[Any]:
    """Return the state in which the slip vanishes."""
    y = [mp.mpf(getattr(scene, name, 0.0)) for name in NAMES]
    slip = rates(scene, 1, y)[1]
    side, step = (1 if slip > 0 else -1), mp.mpf("1e-3")
    while True:
        new, error = stepped(scene, side, y, step)
        later = rates(scene, side, new)[1]
        if error > TOLERANCE:
            step *= 0.6
        elif later * side > 0:
            y, slip, step = new, later, step * (1.4 if error < 1e-4 * TOLERANCE else 1)
        elif abs(later) < AT_REST:
            return new
        else:
            step *= slip / (slip - later)


if __name__ == "__main__":
    for start in SCENES:
        print(*(f"{n} = {mp.nstr(v, 25)}" for n, v in zip(NAMES, end_of_slide(start), strict=True)))
