"""Axes for pictures, modified motions, and the data of drawn lines."""

import dataclasses

import matplotlib
import numpy as np

matplotlib.use("Agg")

import rolling_ellipse as rl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

Array = NDArray[np.float64]
PICTURES = {
    "phase": rl.plot_phase,
    "curves": rl.plot_curves,
    "forces": rl.plot_forces,
    "energy": rl.plot_energy,
    "constraints": rl.plot_constraints,
    "paths": rl.plot_paths,
    "error": rl.plot_error,
}
TWO_PANELS = (rl.plot_forces, rl.plot_constraints)


def seen(motion: rl.Trajectory, line: Line2D) -> rl.Trajectory:
    """Samples of a motion at the times of a curve, which must cover the span of the motion."""
    times = data(line)[0]
    assert times[0] == motion.t[0] and times[-1] == motion.t[-1] and np.all(np.diff(times) >= 0)
    return motion.sol(times)


def rough(motion: rl.Trajectory, friction: float) -> rl.Trajectory:
    return dataclasses.replace(motion, scene=dataclasses.replace(motion.scene, friction=friction))


def new_axes(width: float = 6.0, height: float = 4.0) -> Axes:
    return Figure(figsize=(width, height), layout="constrained").add_subplot()


def two_axes(width: float = 6.0, height: float = 5.0) -> list[Axes]:
    return list(Figure(figsize=(width, height), layout="constrained").subplots(2, sharex=True))


def legend_of(ax: Axes) -> list[str]:
    legend = ax.get_legend()
    if legend is None:
        return []
    return [text.get_text().removesuffix(" = 0") for text in legend.get_texts()]


def data(line: Line2D) -> tuple[Array, Array]:
    x, y = line.get_data()
    return np.asarray(x), np.asarray(y)
