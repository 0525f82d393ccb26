"""Make the figures of the paper beside this file: python paper/figures.py"""

import json
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import rolling_ellipse as rl
from matplotlib.figure import Figure
from rolling_ellipse import benchmark
from rolling_ellipse._pictures.palette import BLUE, INK, ORANGE, PLUM

HERE = Path(__file__).parent
ENGINES = HERE.parent / "docs" / "data" / "engines.json"
CURVES = {"roll.rock": INK, "hit.bounce": ORANGE, "brink.over": PLUM, "rest.lie": BLUE}
MARKS = {"MuJoCo": ("o", BLUE), "Drake": ("s", ORANGE), "pymunk": ("^", PLUM)}


def motion() -> Figure:
    """Positions of one motion through all modes, and below them its forces."""
    scene = rl.Scene(2.0, 1.0, omega=5.2, friction=1.0, restitution=0.3)
    figure, axes = plt.subplots(2, 1, figsize=(7, 4.6), layout="constrained")
    known = rl.simulate(scene, np.linspace(0, 3, 1501))
    rl.plot_strobe(known, count=12, ax=axes[0])
    rl.plot_forces(known, ax=axes[1])
    return figure


def conditions() -> Figure:
    """Condition numbers of four problems, and errors of three engines on all problems."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(7, 3.4), layout="constrained")
    for name, colour in CURVES.items():
        one = benchmark.problem(name)
        left.semilogy(one.times / one.t_end, one.condition, color=colour, label=name)
    left.axhline(1000, color=INK, lw=0.8, ls=":")
    left.set(xlabel="time over the end time", ylabel="condition number")
    left.legend(frameon=False, fontsize=8)
    for name, found in json.loads(ENGINES.read_text(encoding="utf-8"))["engines"].items():
        marker, colour = MARKS[name]
        rows = [s for s in found["scores"] if s["over_condition"] and s["setting"] == 1e-3]
        for answer, face in (("right", colour), ("wrong", "none")):
            errors = sorted(s["over_condition"] for s in rows if s["answer"] == answer)
            place = np.arange(len(errors)) + (0 if face != "none" else 18 - len(errors))
            label = f"{name}, {answer} ({len(errors)})"
            right.semilogy(place, errors, marker, color=colour, mfc=face, label=label)
    right.axhline(1e-3, color=INK, lw=0.8, ls=":")
    right.set(xlabel="problems by error", ylabel="error over condition number", xticks=[])
    right.legend(frameon=False, fontsize=7)
    return figure


if __name__ == "__main__":
    for made in (motion, conditions):
        made().savefig(HERE / f"{made.__name__}.png", dpi=160)
