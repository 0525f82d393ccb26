"""Draw the pictures of the README and the site; a step of `make.py`.

The chart of speed against accuracy is drawn from `peers_R_10.37.json` and contains its digest.
"""

import hashlib
import json
import warnings
from dataclasses import fields, replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Ellipse
from PIL import Image, PngImagePlugin
from rolling_ellipse._pictures.palette import BLUE, EARTH, GREY, INK, ORANGE, PLUM
from rolling_ellipse.benchmark import Score, Scores

DOCS = Path(__file__).resolve().parents[1]
RACE = DOCS / "data" / "peers_R_10.37.json"
ENGINES = DOCS / "data" / "engines.json"
METHODS = {
    "rk4, 0.02 s": {"method": "rk4", "step": 0.02},
    "dop853, rtol 1e-10": {"method": "dop853"},
    "gauss, 0.02 s": {"method": "gauss", "step": 0.02},
    "exact": {"method": "exact"},
}
DRIFTS = {  # colour and dashes of each stabilization
    "none": (PLUM, "-"),
    "baumgarte": (ORANGE, "--"),
    "projection": (BLUE, "-."),
}
STEP = 2.0**-7


def main() -> None:
    rl.animate(rl.simulate(rl.scenes.report, 6.0), DOCS / "roll.gif", fps=25, blow=True)
    friction()
    save(methods(), "methods.png")
    save(speed(), "speed.png", RACE, dpi=150)
    for name, figure in engines().items():
        save(figure, f"engine_{name}.png", ENGINES)
    save(stability(), "stability.png")
    save(phase_map(), "phase_map.png")
    save(strobe(), "strobe.png")
    save(frame(), "frame.png")


def friction() -> None:
    """Animate three motions: the same blow on ground with three values of friction."""
    motions = [rl.simulate(replace(rl.scenes.report, friction=mu), 4.0) for mu in (1.0, 0.1, 0.0)]
    labels = ["friction 1", "friction 0.1", "no friction"]
    rl.animate(motions, DOCS / "friction.gif", labels=labels, fps=25, width=560)


def methods() -> Figure:
    """Draw the energy errors of the methods over 200 s, sampled at the ends of fixed steps."""
    figure = Figure(figsize=(7, 3.4), layout="constrained")
    t = np.linspace(0.0, 200.0, 501)
    motions = [
        rl.simulate(rl.scenes.rolling, t, model="rolling", **how) for how in METHODS.values()
    ]
    rl.plot_energy(motions, ax=figure.add_subplot(), labels=list(METHODS))
    return figure


def speed() -> Figure:
    """Draw a work-precision chart of the package and its peers that fits a phone screen."""
    race = rl.WorkPrecision.load(RACE)
    figure = Figure(figsize=(4.0, 4.0), layout="constrained")
    fronts = race.plot(ax=figure.add_subplot()).fronts
    peers = {run.name for run in race.runs if "peer" in run.tags}
    labels = ["this package", f"the best of {len(peers)} others"]
    figure.legend([fronts["highlight"], fronts["others"]], labels, loc="outside upper left",
                  ncols=2, frameon=False, fontsize="small", title="least time for each error",
                  alignment="left")  # fmt: skip
    return figure


def engines() -> dict[str, Figure]:
    """Draw the scores of each engine from engines.json."""
    drawn = {}
    for name, found in json.loads(ENGINES.read_text(encoding="utf-8"))["engines"].items():
        figure = Figure(figsize=(7.2, 6.1), layout="constrained")
        restored(found["scores"]).plot(ax=figure.add_subplot())
        drawn[name.lower()] = figure
    return drawn


def restored(rows: list[dict[str, Any]]) -> Scores:
    """Return scores from their records, in which missing numbers are None."""
    scores = []
    for row in rows:
        known = {key: np.nan if value is None else value for key, value in row.items()}
        known |= {"errors": np.array([*row["errors"].values()], dtype=float)}
        names = [each.name for each in fields(Score) if each.name in known]
        scores.append(Score(**{name: known[name] for name in names}))
    return Scores(scores)


def stability() -> Figure:
    """Draw the distance from the ground and the error of theta over 1000 half turns of rolling."""
    figure = Figure(figsize=(7, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    scene = rl.Scene(1.5, 1.0, theta=0.2, omega=4.0)
    turns = np.unique(np.geomspace(1, 1000, 31).round())
    times = turns * rl.period(scene) / 2
    exact = rl.simulate(scene, times)
    for name, (colour, dash) in DRIFTS.items():
        with warnings.catch_warnings(action="ignore", category=rl.StabilityWarning):
            found = rl.simulate(
                scene, times, model="multipliers", method="rk4", step=STEP, stabilization=name
            )
        gap = np.maximum(np.abs(found.constraint_residuals().gap), 1e-17)
        for ax, values in ((left, gap), (right, np.abs(found.theta - exact.theta))):
            ax.plot(turns, values, color=colour, ls=dash)
            name_line(ax, turns, values, name, colour)
    for ax, title in ((left, "distance from the ground [m]"), (right, "error of θ [rad]")):
        ax.set(xscale="log", yscale="log", xlabel="half turns", xlim=(1, 1e4))
        ax.set_title(title, loc="left", fontsize="medium")
        ax.spines[["top", "right"]].set_visible(False)
    return figure


def name_line(ax: Axes, x: np.ndarray, y: np.ndarray, name: str, colour: str) -> None:
    """Label the end of a line with its name and, if it grows, with the exponent of its growth."""
    late = x >= 20
    power = np.polyfit(np.log(x[late]), np.log(y[late]), 1)[0]
    grows = f" $t^{{{power:.2f}}}$" if y[-1] > 1e-9 and power > 0.5 else ""
    ax.annotate(
        name + grows, (x[-1], y[-1]), xytext=(3, 0), textcoords="offset points", color=colour,
        va="center", fontsize="x-small",
    )  # fmt: skip


def phase_map() -> Figure:
    figure = Figure(figsize=(6.4, 4.0), layout="constrained")
    rl.plot_phase_map("aspect", "energy", friction=0.5, ax=figure.add_subplot())
    return figure


def strobe() -> Figure:
    figure = Figure(figsize=(7, 2.4), layout="constrained")
    rl.plot_strobe(rl.simulate(rl.scenes.report, 3.2), ax=figure.add_subplot())
    return figure


def frame() -> Figure:
    """Draw one state of the body: its axes, angle, contact and forces."""
    figure = Figure(figsize=(7, 3.0), layout="constrained")
    ax = figure.add_subplot()
    at = rl.simulate(rl.Scene(2.0, 1.0, theta=0.5, omega=1.0), 0.0)
    x, z, theta, touch = (float(v[0]) for v in (at.x, at.z, at.theta, at.contact_x))
    tip = x + 2 * np.cos(theta), z - 2 * np.sin(theta)
    ax.add_patch(Ellipse((x, z), 4, 2, angle=-np.degrees(theta), fc="#2a6f9722", ec=INK, lw=1.6))
    ax.axhspan(-0.6, 0, color=EARTH, zorder=0)
    ax.axhline(0, color=GREY, lw=1)
    ax.plot([x, x + 2.3], [z, z], color=GREY, lw=1, ls=":")
    ax.plot([x, tip[0]], [z, tip[1]], color=INK, lw=1.2)
    ax.plot([x, touch], [z, 0], color=PLUM, lw=1.2, ls="--")
    ax.add_patch(Arc((x, z), 2.2, 2.2, theta1=-np.degrees(theta), theta2=0, color=BLUE, lw=1.4))
    spokes = {"start": (-4.2, 0.0), "x": (-3.0, 0.0), "z": (-4.2, 1.2)}
    for name, (to_x, to_z) in list(spokes.items())[1:]:
        arrow(ax, spokes["start"], (to_x, to_z), INK)
        ax.text(to_x + 0.12, to_z + 0.08, name, color=INK, style="italic")
    arrow(ax, (touch, 0.0), (touch, 0.75), ORANGE)
    arrow(ax, (touch, 0.0), (touch + 0.7, 0.0), ORANGE)
    for text, place, colour in (
        ("θ", (x + 1.16, z - 0.34), BLUE), ("G", (x - 0.28, z + 0.08), INK),
        ("a", (x + 1.35, z - 1.02), INK), ("r", (x + 0.02, 0.62), PLUM),
        ("N", (touch + 0.08, 0.5), ORANGE), ("F", (touch + 0.78, 0.06), ORANGE),
        ("contact_x", (touch - 0.45, -0.32), INK),
    ):  # fmt: skip
        ax.text(*place, text, color=colour)
    ax.plot([x, touch], [z, 0], ls="", marker="o", ms=4, color=INK)
    ax.set(xlim=(-4.6, 3.6), ylim=(-0.5, 2.75), aspect="equal")
    ax.axis("off")
    return figure


def arrow(ax: Axes, start: tuple[float, float], end: tuple[float, float], colour: str) -> None:
    ax.annotate("", end, start, arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6})


def save(figure: Figure, name: str, source: Path | None = None, dpi: int = 120) -> None:
    """Write a picture, with the digest of its source file."""
    facts = PngImagePlugin.PngInfo()
    if source is not None:
        facts.add_text("Source", hashlib.sha256(source.read_bytes()).hexdigest())
    picture = BytesIO()
    figure.savefig(picture, dpi=dpi)
    colours = Image.open(picture).convert("RGB").quantize(128)  # makes the file three times smaller
    colours.save(DOCS / name, optimize=True, pnginfo=facts)


if __name__ == "__main__":
    main()
