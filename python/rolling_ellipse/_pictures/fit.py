"""A fit to a film: each track over the fitted motion, and residuals in units of sigma."""

from __future__ import annotations

from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from .._ask.check import FloatArray, file_name
from .axes import Artists, close, figure_of, picture
from .legends import name_curves, title_beside_legend
from .palette import palette_of
from .panels import dress_grid
from .sampling import over_time

if TYPE_CHECKING:
    from .._verbs.fit_motion import Fit

_LABELS = {"x": "x [m]", "z": "z [m]", "theta": "θ [rad]"}


@dataclass(frozen=True, repr=False)
class FitChart(Artists):
    """Artists of `Fit.plot`; keys are the names of the tracks that were measured."""

    axes: tuple[Axes, ...]
    tracks: dict[str, Line2D]
    curves: dict[str, Line2D]
    residuals: dict[str, Line2D]


@picture
def draw(fit: Fit, path: Any, figure: Any, figsize: Any) -> FitChart:
    """Draw a fit; see `Fit.plot`."""
    name = None if path is None else file_name("path", path)
    off: dict[str, FloatArray] = dict(zip(_LABELS, fit.residuals.T, strict=True))
    seen = [track for track, values in off.items() if np.isfinite(values).any()]
    whole = figure_of(figure, (7, 2.2 + 1.2 * len(seen)), figsize)
    heights = [1.0] * len(seen) + [1.3]
    axes = whole.subplots(len(heights), sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    chart, motion, shades = FitChart(tuple(axes), {}, {}, {}), fit.trajectory, palette_of(axes[0])
    curve, bottom = over_time(motion), axes[-1]
    how: dict[str, Any] = {"ls": "", "ms": 3, "mew": 0}
    looks = zip("osD", (shades.blue, shades.orange, shades.ink), strict=True)
    for ax, track, (marker, color), sigma in zip(axes, seen, looks, fit.sigma, strict=False):
        (chart.curves[track],) = ax.plot(
            curve.t, getattr(curve, track), color=shades.text, lw=0.8, zorder=3
        )
        measured = getattr(motion, track) + off[track]
        how |= {"marker": marker, "color": color}
        (chart.tracks[track],) = ax.plot(motion.t, measured, **how)
        (chart.residuals[track],) = bottom.plot(
            motion.t, off[track] / sigma, label=_LABELS[track][0], **how
        )
        ax.set_ylabel(_LABELS[track])
    bottom.axhspan(-2, 2, color=shades.shade(0.07), lw=0, zorder=0)  # 95 % of normal residuals
    bottom.set(xlabel="t [s]", ylabel="residual / σ")
    for ax in axes:
        dress_grid(ax)
    whole.align_ylabels(axes)
    name_curves(bottom)
    letters = int(12 * axes[0].get_window_extent().width / whole.get_figure(root=True).dpi)
    title_beside_legend(axes[0], fill(fit.message, max(20, letters)))
    if name is not None:
        chart.savefig(name)
        if figure is None:
            close(chart.figure)
    return chart
