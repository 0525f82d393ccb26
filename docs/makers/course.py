"""Draw the pictures and write the tasks of the sheets in docs/course: python docs/makers/course.py

    pictures   01.png to 10.png, and 07b.png
    tasks      the marked parts of the sheets, from the questions and data of `course`

Arguments select steps; without arguments both steps run. `answers SEED` prints the right answers
for a seed instead.
"""

import math
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Ellipse
from rolling_ellipse import course
from rolling_ellipse._pictures.palette import BLUE, EARTH, GREY, INK, ORANGE, PLUM, SKY

SHEETS = sorted((Path(__file__).resolve().parents[1] / "course").glob("[01][0-9]_*.md"))
A, B, G = 0.3, 0.2, 9.81
BODY: dict[str, float] = {"a": A, "b": B}
K2 = (A * A + B * B) / 4

# ------------------------------------------------------------------------------ pictures


def two(height: float = 3.0, ratios: tuple[float, float] = (1, 1)) -> tuple[Figure, Axes, Axes]:
    figure = Figure(figsize=(7.4, height), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=ratios)
    for ax in (left, right):
        ax.spines[["top", "right"]].set_visible(False)
    return figure, left, right


def ground(ax: Axes, low: float, high: float, top: float, depth: float = 0.05) -> None:
    ax.axhspan(-depth, 0, color=EARTH, zorder=0)
    ax.axhline(0, color=GREY, lw=1)
    ax.set(xlim=(low, high), ylim=(-depth, top), aspect="equal")
    ax.axis("off")


def body(
    ax: Axes, x: float, z: float, theta: float, a: float = A, b: float = B, **how: Any
) -> None:
    look = {"fc": "#2a6f9722", "ec": INK, "lw": 1.4} | how
    ax.add_patch(Ellipse((x, z), 2 * a, 2 * b, angle=-math.degrees(theta), **look))


def arrow(ax: Axes, tip: tuple[float, float], tail: tuple[float, float], colour: str) -> None:
    how = {"arrowstyle": "-|>", "color": colour, "lw": 1.8, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", tip, tail, arrowprops=how)


def curve() -> Figure:
    figure = Figure(figsize=(7.4, 2.5), layout="constrained")
    one, ax = figure.subplots(1, 2, width_ratios=(1, 2.6))
    angle = 0.6
    up, lead = rl.geometry.support(angle, **BODY), rl.geometry.support_slope(angle, **BODY)
    ground(one, -0.36, 0.36, 0.62, 0.12)
    body(one, 0, up, angle)
    end = A * math.cos(angle), up - A * math.sin(angle)
    one.plot([0, end[0]], [up, end[1]], color=INK, lw=1)
    one.plot([0, 0.3], [up, up], color=GREY, lw=1, ls=":")
    one.plot([0, 0], [0, up], color=BLUE, lw=1.8)
    one.plot([0, lead], [0, 0], color=PLUM, lw=3)
    one.plot(0, up, "o", ms=4, color=INK)
    one.plot(lead, 0, "o", ms=5, color=PLUM, clip_on=False, zorder=4)
    one.add_patch(Arc((0, up), 0.28, 0.28, theta1=-math.degrees(angle), theta2=0, color=INK))
    for x, z, text, colour in ((-0.045, up + 0.02, "G", INK), (lead + 0.02, -0.06, "C", PLUM),
                               (0.16, up - 0.055, "θ", INK), (-0.045, up / 2, "h", BLUE),
                               (lead / 2, -0.06, "h′", PLUM),
                               (0.1, up - 0.13, "a", INK)):  # fmt: skip
        one.text(x, z, text, color=colour, ha="center", va="center")
    theta = np.linspace(0, 2 * math.pi, 400)
    x, h = rl.geometry.centre_path(theta, **BODY), rl.geometry.support(theta, **BODY)
    rim = x + A * np.cos(theta), h - A * np.sin(theta)
    ground(ax, -0.4, 2.0, 0.62, 0.12)
    for angle in (0.0, 0.6, 2.2, 3.8, 5.2):
        at, up = rl.geometry.centre_path(angle, **BODY), rl.geometry.support(angle, **BODY)
        body(ax, at, up, angle, lw=1.1)
        touch = at + rl.geometry.support_slope(angle, **BODY)
        ax.plot([at, touch], [up, 0], color=GREY, lw=1, ls=":")
        ax.plot(touch, 0, "o", ms=5, color=PLUM, clip_on=False, zorder=4)
        ax.plot(at, up, "o", ms=3, color=INK)
        end = at + A * math.cos(angle), up - A * math.sin(angle)
        ax.plot(*end, "o", ms=5, color=ORANGE, zorder=4)
    ax.plot(x, h, color=BLUE, lw=1.8)
    ax.plot(*rim, color=ORANGE, lw=1.8)
    ax.text(1.6, 0.14, "centre", color=BLUE)
    ax.text(1.55, 0.52, "point P of the rim", color=ORANGE)
    ax.text(0.47, -0.06, "contacts", color=PLUM, va="center")
    return figure


def energy() -> Figure:
    figure, left, right = two()
    theta = np.linspace(-0.6 * math.pi, 1.1 * math.pi, 400)
    left.plot(theta, rl.geometry.support(theta, **BODY), color=INK)
    for level, name, colour in ((0.26, "rocks", BLUE), (0.34, "rolls over", ORANGE)):
        inside = theta[rl.geometry.support(theta, **BODY) <= level]
        inside = inside[np.abs(inside) < 1.4] if level < A else inside
        left.plot([inside[0], inside[-1]], [level, level], color=colour)
        left.text(0 if level < A else 1.9, level + 0.004, name, color=colour, ha="center")
    left.axhline(A, color=GREY, lw=1, ls="--")
    left.text(-1.85, A + 0.003, "a", color=GREY)
    left.set(xlabel="θ [rad]", ylim=(0.19, 0.36), xticks=[-math.pi / 2, 0, math.pi / 2, math.pi],
             xticklabels=["−π/2", "0", "π/2", "π"])  # fmt: skip
    left.set_title("E/(m g) and h [m]", loc="left", fontsize="medium")
    limit = rl.thresholds(A, B).roll_over_speed
    for low, high, name in ((0.05, 0.99999, "a swing"), (1.00001, 1.8, "a full turn")):
        share = 1 + (np.array([-1, 1])[int(low > 1)]) * np.geomspace(
            1e-5, abs(1 - (low, high)[low > 1]), 150
        )
        times = [rl.period(rl.Scene(A, B, omega=limit * s)) for s in share]
        colour = BLUE if low < 1 else ORANGE
        right.plot(share, times, color=colour)
        right.text(*((0.35, 1.6) if low < 1 else (1.25, 1.85)), name, color=colour)
    right.axvline(1, color=GREY, lw=1, ls="--")
    right.set(xlabel="speed at the flat position / least to roll over", ylim=(0, 5), xlim=(0, 1.8))
    right.set_title("time [s]", loc="left", fontsize="medium")
    return figure


def forces() -> Figure:
    figure, left, right = two(ratios=(1, 1.1))
    scene = rl.Scene(A, B, mass=1.5, omega=3.0, theta=0.7)
    at = rl.simulate(scene, 0.0)
    x, touch, up = float(at.x[0]), float(at.contact_x[0]), float(at.z[0])
    ground(left, -0.36, 0.55, 0.62, 0.07)
    body(left, x, up, 0.7)
    N, F = float(at.normal_force[0]) / 50, float(at.friction_force[0]) / 50
    arrow(left, (touch, N), (touch, 0), ORANGE)
    arrow(left, (touch + F, 0), (touch, 0), PLUM)
    arrow(left, (x, up - 1.5 * G / 50), (x, up), GREY)
    left.plot(x, up, "o", ms=4, color=INK)
    left.text(touch + 0.02, N - 0.03, "N", color=ORANGE)
    left.text(touch + F / 2, -0.045, "F", color=PLUM, ha="center", va="center")
    left.text(x - 0.015, up - 0.12, "m g", color=GREY, ha="right")
    left.text(x - 0.015, up + 0.02, "G", color=INK, ha="right")
    left.text(touch + 0.025, -0.04, "C", color=INK, va="center")
    turn = rl.simulate(rl.Scene(A, B, omega=7.0), np.linspace(0, 1.35, 600))
    weight = G * turn.scene.mass
    right.plot(turn.theta, turn.normal_force / weight, color=ORANGE)
    right.plot(turn.theta, turn.friction_force / weight, color=PLUM)
    right.axhline(0, color=GREY, lw=1)
    right.text(2.7, 1.75, "N/(m g)", color=ORANGE, ha="right")
    right.text(0.9, -0.4, "F/(m g)", color=PLUM)
    right.set(xlabel="θ [rad]", xlim=(0, 2 * math.pi), ylim=(-0.5, 2.4),
              xticks=[0, math.pi / 2, math.pi, 1.5 * math.pi, 2 * math.pi],
              xticklabels=["0", "π/2", "π", "3π/2", "2π"])  # fmt: skip
    right.set_title("a turn, 7 rad/s when flat", loc="left", fontsize="medium")
    return figure


def over() -> Figure:
    figure, left, right = two()
    theta, omega = np.meshgrid(
        np.linspace(-math.pi / 2, 1.5 * math.pi, 400), np.linspace(-7, 7, 300)
    )
    h, lead = rl.geometry.support(theta, **BODY), rl.geometry.support_slope(theta, **BODY)
    lift = (K2 + h**2 + lead**2) * omega**2 / (2 * G) + h
    for levels, colour, width in (((0.215, 0.24, 0.27), BLUE, 1.0), ((A,), INK, 2.0),
                                  ((0.33, 0.37), ORANGE, 1.0)):  # fmt: skip
        left.contour(theta, omega, lift, levels, colors=[colour], linewidths=width)
    left.text(0, 0, "rocks", color=BLUE, ha="center", va="center")
    left.text(math.pi / 2, 5.5, "rolls over", color=ORANGE, ha="center")
    left.set(xlabel="θ [rad]", xticks=[0, math.pi / 2, math.pi], xticklabels=["0", "π/2", "π"])
    left.set_title("ω [rad/s]", loc="left", fontsize="medium")
    ratio = np.linspace(1.02, 6, 120)
    for name, k2, colour in (("uniform", 0.25, INK), ("k² twice\nas large", 0.5, GREY)):
        needs = [
            rl.thresholds(r, 1.0, gyration2=k2 * (r * r + 1)).friction_to_roll_over for r in ratio
        ]
        right.plot(ratio, needs, color=colour)
        right.text(6.05, needs[-1], name, color=colour, va="center")
    right.plot(1.5, rl.thresholds(A, B).friction_to_roll_over, "o", color=ORANGE)
    right.set(xlabel="a/b", xlim=(1, 7.5), ylim=(0.01, 8), xscale="log", yscale="log",
              xticks=[1, 1.5, 2, 3, 4, 6], yticks=[0.01, 0.1, 1],
              xticklabels=["1", "1.5", "2", "3", "4", "6"],
              yticklabels=["0.01", "0.1", "1"])  # fmt: skip
    right.minorticks_off()
    right.set_title("friction coefficient needed to roll over", loc="left", fontsize="medium")
    return figure


def blow() -> Figure:
    figure, left, right = two(ratios=(1.15, 1))
    ground(left, -0.42, 0.52, 0.46, 0.09)
    body(left, 0, B, 0)
    left.plot(0, B, "o", ms=4, color=INK)
    edge = B + B * math.sqrt(1 - (0.25 / A) ** 2)
    arrow(left, (0.25, edge), (0.25, edge + 0.13), ORANGE)
    arrow(left, (0, 0.13), (0, 0), PLUM)
    arrow(left, (0.13 * 0.6207 / 0.9, 0), (0, 0), PLUM)  # all three arrows to scale, as in task 5.2
    left.annotate("", (0.25, B), (0, B), arrowprops={"arrowstyle": "<->", "color": GREY})
    left.text(0.125, B + 0.012, "$d_x$", color=GREY, ha="center")
    left.text(0.265, edge + 0.07, "$J_z$", color=ORANGE)
    left.text(-0.015, 0.1, r"$\Lambda_z$", color=PLUM, ha="right")
    left.text(0.1, -0.045, r"$\Lambda_x$", color=PLUM, va="center")
    d = np.linspace(0, A, 50)
    uniform, twice = d / (K2 + B * B), d / (2 * K2 + B * B)
    for values, name, colour, dash in ((d / K2, "without friction", PLUM, "--"),
                                       (uniform, "the ground holds", INK, "-"),
                                       (twice, "k² twice as large", GREY, "-")):  # fmt: skip
        right.plot(d, 0.6 * values, color=colour, ls=dash, label=name)
    right.legend(frameon=False, loc="upper left")
    right.set(xlabel="distance $d_x$ [m]", xlim=(0, A), ylim=(0, 6.4))
    right.set_title("ω after 0.9 N s on 1.5 kg [rad/s]", loc="left", fontsize="medium")
    return figure


def slip() -> Figure:
    figure, left, right = two()
    motion = rl.simulate(
        rl.Scene(0.2, 0.2, friction=0.15, x_dot=3.0, omega=0.0), np.linspace(0, 1.2, 300)
    )
    left.plot(motion.t, motion.x_dot, color=INK)
    left.plot(motion.t, 0.2 * motion.omega, color=BLUE)
    end = motion.events[0].t
    left.axvline(end, color=GREY, lw=1, ls="--")
    left.text(0.05, 2.5, "centre", color=INK)
    left.text(0.1, 0.9, "a ω", color=BLUE)
    left.text(end + 0.02, 0.2, "rolls", color=GREY)
    left.set(xlabel="t [s]", xlim=(0, 1.2), ylim=(0, 3.1))
    left.set_title("speeds of a disc [m/s]", loc="left", fontsize="medium")
    first_events(right)
    return figure


def first_events(ax: Axes) -> None:
    """Draw the proved outcomes over friction and speed, and the bounds of the slip windows."""
    mu, speed = np.linspace(0.1, 0.8, 281), np.linspace(0.02, 12.4, 310)
    outcomes = rl.classify(**BODY, omega=speed[:, None], friction=mu)
    kinds = [rl.Outcome.ROCKS, rl.Outcome.ROLLS_OVER, rl.Outcome.SLIPS]
    shades = ListedColormap(["#ffffff", SKY, "#f7dfc0"])
    ax.pcolormesh(mu, speed, np.argmax([outcomes == kind for kind in kinds], axis=0), cmap=shades,
                  vmin=0, vmax=2, shading="nearest", rasterized=True)  # fmt: skip
    windows = [rl.thresholds(A, B, friction=m).slip_windows for m in mu]
    ax.plot(mu, [w[-1][0] for w in windows], color=INK)
    m, low, high = np.transpose([(m, *w[0]) for m, w in zip(mu, windows, strict=True) if w[1:]])
    ax.plot([*m, *m[::-1]], [*low, *high[::-1]], color=INK)
    lift = rl.thresholds(A, B).contact_loss_speed
    ax.axhline(lift, color=PLUM, lw=1, ls="--")
    ax.text(0.79, lift + 0.06, "rolling needs N < 0", color=PLUM, ha="right", va="bottom")
    ax.text(0.5, 7.5, "rolls for ever", color=INK, ha="center")
    ax.text(0.55, 2.4, "rocks", color=INK, ha="center")
    ax.text(0.12, 4.2, "slips", color=ORANGE)
    ax.text(0.12, 10.6, "slips", color=ORANGE)
    ax.set(xlabel="μ", xlim=(0.1, 0.8), ylim=(0, 12.4))
    ax.set_title("speed when flat [rad/s]", loc="left", fontsize="medium")


def flight() -> Figure:
    figure = Figure(figsize=(7.4, 3.2), layout="constrained")
    ax = figure.add_subplot()
    scene = rl.Scene(A, B, z=0.8, theta=0.5, omega=-2.0, x_dot=1.2, friction=0.15, restitution=0.8)
    end = 1.25
    motion = rl.simulate(scene, np.linspace(0, end, 400))
    ground(ax, -0.55, 2.1, 1.05, 0.08)
    for t in np.linspace(0, end, 8):
        at = motion.at(t)
        body(ax, at.x, at.z, at.theta, lw=1)
    ax.plot(motion.x, motion.z, color=BLUE, lw=1.6)
    for event in motion.events:
        hit = event.state_before
        body(ax, hit.x, hit.z, hit.theta, fc="none", ec=ORANGE, lw=1.8)
        touch = hit.x + rl.geometry.support_slope(hit.theta, **BODY)
        ax.plot(touch, 0, "o", ms=6, color=ORANGE, clip_on=False, zorder=4)
        ax.text(touch, -0.045, f"{event.t:.2f} s", color=ORANGE, ha="center", va="center")
    h = float(rl.geometry.support(0.5, **BODY))
    ax.plot(0, 0.8, "o", ms=4, color=INK)
    ax.text(0.03, 0.83, "G", color=INK)
    for x, low, high, name in ((-0.48, 0.0, 0.8, "z"), (-0.4, 0.8 - h, 0.8, "h"),
                               (-0.4, 0.0, 0.8 - h, "γ")):  # fmt: skip
        how = {"arrowstyle": "<->", "color": GREY, "shrinkA": 0, "shrinkB": 0}
        ax.annotate("", (x, low), (x, high), arrowprops=how)
        ax.text(x - 0.015, (low + high) / 2, name, color=INK, ha="right", va="center")
    for level in (0.8 - h, 0.8):
        ax.plot([-0.48, 0.1], [level, level], color=GREY, lw=0.8, ls=":")
    return figure


#: The example of sheet 7b: slopes of u and v over the normal impulse [1/kg], and the
#: impulses between which they are constant [N s].
SLOPES, ENDS = ((0.66134, -0.21913), (0.69610, 0.0), (0.69610, 0.0)), (0.0, 1.8254, 2.9643, 4.7260)


def impact() -> Figure:
    figure = Figure(figsize=(7.4, 3.0), layout="constrained")
    ax = figure.add_subplot()
    ax.spines[["top", "right", "bottom"]].set_visible(False)
    u, v = [-2.0], [0.4]
    for (du, dv), low, high in zip(SLOPES, ENDS, ENDS[1:], strict=False):
        u.append(u[-1] + du * (high - low))
        v.append(v[-1] + dv * (high - low))
    ax.fill_between(ENDS[:3], u[:3], 0, color=SKY, alpha=0.6, lw=0)
    ax.fill_between(ENDS[2:], u[2:], 0, color="#f7dfc0", lw=0)
    ax.plot(ENDS, u, color=INK, lw=2)
    ax.plot(ENDS, v, color=PLUM, lw=2)
    ax.axhline(0, color=GREY, lw=1)
    for end in ENDS[1:]:
        ax.axvline(end, color=GREY, lw=1, ls=":")
    for x, text in ((0.9, "slips"), (2.4, "sticks"), (3.85, "sticks")):
        ax.text(x, 1.35, text, color=GREY, ha="center")
    ax.text(0.45, -1.55, "u", color=INK)
    ax.text(0.1, 0.45, "v", color=PLUM)
    ax.text(1.0, -0.6, "A", color=INK, ha="center")
    ax.text(4.2, 0.3, "$e^2 A$", color=INK, ha="center")
    ax.set(xlabel=r"$\Lambda_z$ [N s]", xlim=(0, 5), ylim=(-2.1, 1.6), xticks=[0, 1, 2, 3, 4])
    ax.set_ylabel("u and v [m/s]")
    return figure


def laws() -> Figure:
    figure, left, right = two(3.2)
    (theta, *before), after = course.measured_impacts()
    axes = {"a": 0.035, "b": 0.025}
    h, lead = rl.geometry.support(theta, **axes), rl.geometry.support_slope(theta, **axes)
    x, z, turn = after - before
    moment, plate = -(h * x + lead * z), (0.035**2 + 0.025**2) / 4
    own, other = moment @ turn / (turn @ turn), moment @ moment / (moment @ turn)
    left.plot(turn, 1e3 * moment, "o", ms=4.5, color=INK, mfc="none")
    reach = np.array([turn.min(), turn.max()]) * 1.1
    for k2, name, colour, dash in ((own, "least squares of Y", ORANGE, "-"),
                                   (other, "of Δω", BLUE, "--"),
                                   (plate, "plate", GREY, "-.")):  # fmt: skip
        left.plot(reach, 1e3 * k2 * reach, color=colour, ls=dash, lw=1.4, label=name)
    left.legend(frameon=False)
    left.set(xlabel="Δω [rad/s]")
    left.set_title("Y [10⁻³ m²/s]", loc="left", fontsize="medium")
    mu = np.linspace(0, 0.4, 81)
    for k2, colour, place in ((plate, GREY, (0.005, 0.2)), (own, ORANGE, (0.045, 0.7))):
        for law, dash in zip(rl.impacts.LAWS, ("-", "--", ":"), strict=True):
            rms = []
            for m in mu:
                speeds = rl.impacts.collide(theta, *before, **axes, gyration2=k2, friction=m,
                                            restitution=0.518, law=law)  # fmt: skip
                off = rl.impacts.kinetic_speed(*(np.stack(speeds) - after), gyration2=k2)
                rms.append(np.sqrt(np.mean(off**2)))
            label = law.capitalize() if k2 == own else None
            right.plot(mu, rms, color=colour, ls=dash, label=label)
        right.text(*place, "k² of a plate" if k2 == plate else "k² of the data", color=colour)
    right.legend(frameon=False, loc="upper right")
    right.set(xlabel="μ", xlim=(0, 0.4), ylim=(0, None))
    right.set_title("error ε [m/s], root mean square, e = 0.518", loc="left", fontsize="medium")
    return figure


def integrators() -> Figure:
    figure, left, right = two()
    scene = rl.Scene(A, B, theta=0.5, omega=2.0)
    rhs, step = rl.rolling_equation(scene), 0.01
    y = [np.array([0.5, 2.0])]
    for _ in range(300):
        y.append(y[-1] + step * rhs(0.0, y[-1]))
    theta, omega = np.array(y).T
    h, lead = rl.geometry.support(theta, **BODY), rl.geometry.support_slope(theta, **BODY)
    total = (K2 + h**2 + lead**2) * omega**2 / 2 + G * h
    left.plot(step * np.arange(301), total / total[0] - 1, color=PLUM)
    left.text(0.1, 0.072, "explicit Euler, 0.01 s", color=PLUM)
    t = step * np.arange(0, 301, 12)
    rough = rl.simulate(scene, t, model="rolling", method="rk4", step=0.12, raise_on_failure=False)
    left.plot(t, rough.energy / rough.energy[0] - 1, color=ORANGE)
    left.text(1.9, -0.012, "Runge–Kutta, 0.12 s", color=ORANGE, ha="right")
    left.axhline(0, color=INK, lw=1)
    left.set(xlabel="t [s]", xlim=(0, 3), ylim=(-0.02, 0.1))
    left.set_title("relative change of energy", loc="left", fontsize="medium")
    steps = 0.4 / 2.0 ** np.arange(2, 13)
    exact = rl.simulate(scene, [0.4], model="rolling", method="exact").theta[0]
    for method, colour in (("rk4", ORANGE), ("gauss", BLUE)):
        found = [
            rl.simulate(scene, [0.4], model="rolling", method=method, step=s).theta[0]
            for s in steps
        ]
        off = np.maximum(np.abs(np.array(found) - exact), 1e-17)
        right.loglog(steps, off, "o-", ms=4, color=colour)
    right.text(0.006, 2e-7, "Runge–Kutta", color=ORANGE, ha="right")
    right.text(0.05, 1e-14, "Gauss", color=BLUE)
    right.set(xlabel="step [s]")
    right.set_title("error of θ after 0.4 s [rad]", loc="left", fontsize="medium")
    return figure


def film() -> Figure:
    figure, left, right = two(3.2, (1.25, 1))
    t, x, z, theta = course.film().values()
    ground(left, -0.045, 0.13, 0.145, 0.012)
    for at, up, angle in zip(x, z, theta, strict=True):
        body(left, at, up, angle, 0.035, 0.025, lw=0.8, fc="none", ec=SKY)
        left.plot(at, up, "o", ms=3.5, color=INK)
        mark = at + 0.035 * math.cos(angle), up - 0.035 * math.sin(angle)
        left.plot(*mark, "o", ms=3, color=ORANGE)
    right.plot(t, z, "o", ms=4.5, color=INK, mfc="none")
    right.plot(t, x, "o", ms=4, color=BLUE)
    right.text(0.2, 0.045, "z", color=INK, ha="right")
    right.text(0.2, 0.083, "x", color=BLUE, ha="right")
    right.set(xlabel="t [s]", ylim=(0, None), xlim=(0, None))
    right.set_title("centre [m]", loc="left", fontsize="medium")
    return figure


PICTURES: dict[str, Callable[[], Figure]] = {
    "01": curve, "02": energy, "03": forces, "04": over, "05": blow, "06": slip, "07": flight,
    "07b": impact, "08": laws, "09": integrators, "10": film,
}  # fmt: skip


def pictures() -> None:
    from pictures import save  # imported here because tests load this file from another folder

    for name, draw in PICTURES.items():
        save(draw(), f"course/{name}.png")


def tasks() -> None:
    for path in SHEETS:
        text = path.read_text(encoding="utf-8")
        path.write_text(course._sheets.filled(text, None), encoding="utf-8")


def answers(seed: int) -> None:
    for task in course.tasks(seed):
        print(f"{task.number:5} {course._answers.answer(task):12.6g} {task.unit}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["answers"]:
        sys.exit(answers(int(sys.argv[2])))
    for step in sys.argv[1:] or ["pictures", "tasks"]:
        {"pictures": pictures, "tasks": tasks}[step]()
