"""Plots of fits: measured and fitted motions, measured and predicted impacts, and residuals."""

from __future__ import annotations

from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .axes import Artists, figure_of, name_curves, picture, picture_file, write
from .ground import label_lengths
from .palette import palette_of
from .panels import dress_grid
from .sampling import over_time

if TYPE_CHECKING:
    from .._verbs.fit_motion import Fit
    from ..impacts import FittedImpacts

_LABELS = {"x": "x", "z": "z", "theta": "θ"}
_RATES = {"x_dot": "x_dot [m/s]", "z_dot": "z_dot [m/s]", "omega": "ω [rad/s]"}


@dataclass(frozen=True, repr=False)
class FitChart(Artists):
    """Artists of `Fit.plot` and `FittedImpacts.plot`; keys are the names of measured quantities."""

    measured: dict[str, Line2D]
    fitted: dict[str, Line2D]
    residuals: dict[str, Line2D]


@picture
def draw_fit(fit: Fit, path: Any, figure: Any, figsize: Any) -> FitChart:
    """Draw a fit to a film; see `Fit.plot`."""
    motion, off = fit.trajectory, dict(zip(_LABELS, fit.residuals.T, strict=True))
    seen = [track for track, values in off.items() if np.isfinite(values).any()]
    whole = figure_of(figure, (7, 2.2 + 1.2 * len(seen)), figsize)
    heights = [1.0] * len(seen) + [1.3]
    axes = whole.subplots(len(heights), sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    chart, shades = FitChart(tuple(axes), {}, {}, {}), palette_of(axes[0])
    curve, bottom, sigma = over_time(motion), axes[-1], dict(zip(_LABELS, fit.sigma, strict=True))
    line: dict[str, Any] = {"color": shades.text, "lw": 0.8, "zorder": 3}
    looks = dict(zip(_LABELS, zip("osD", shades.curves[2::-1], strict=True), strict=True))
    scale = fit.values.get("scale", 1.0)
    for ax, track in zip(axes, seen, strict=False):
        dots: dict[str, Any] = {"marker": looks[track][0], "color": looks[track][1], "ms": 3}
        dots |= {"ls": "", "mew": 0, "label": _LABELS[track]}
        (chart.fitted[track],) = ax.plot(curve.t, getattr(curve, track), **line)
        apart = off[track] / (1.0 if track == "theta" else scale)  # in coordinates of the scene
        (chart.measured[track],) = ax.plot(motion.t, getattr(motion, track) + apart, **dots)
        (chart.residuals[track],) = bottom.plot(motion.t, off[track] / sigma[track], **dots)
        if track == "theta":
            ax.set_ylabel("θ [rad]")
        else:
            label_lengths(ax.yaxis, track, motion.scene)
    bottom.axhspan(-2, 2, color=shades.shade(0.07), lw=0, zorder=0)  # 95 % of normal residuals
    bottom.set(xlabel="t [s]", ylabel="residual / σ")
    name_curves(bottom)
    return _finished(chart, whole, fit.message, path)


@picture
def draw_impacts(fit: FittedImpacts, path: Any, figure: Any, figsize: Any) -> FitChart:
    """Draw a fit to impacts; see `FittedImpacts.plot`."""
    whole = figure_of(figure, (8.4, 4.6), figsize)
    axes = whole.subplots(2, 3, sharex="col", height_ratios=(2, 1))
    chart, shades = FitChart(tuple(axes.ravel()), {}, {}, {}), palette_of(axes[0, 0])
    dots: dict[str, Any] = {"marker": "o", "ls": "", "ms": 2.5, "mew": 0, "alpha": 0.5}
    dots["color"], line = shades.blue, {"color": shades.text, "lw": 0.8, "zorder": 3}
    for k, (rate, label) in enumerate(_RATES.items()):
        (top, bottom), seen, predicted = axes[:, k], fit.measured[k], fit.predicted[k]
        ends = [predicted.min(), predicted.max()]
        (chart.fitted[rate],) = top.plot(ends, ends, **line)
        (chart.measured[rate],) = top.plot(seen, predicted, **dots)
        (chart.residuals[rate],) = bottom.plot(seen, seen - predicted, **dots)
        bottom.axhline(0, **line)
        bottom.set_xlabel(label)
    axes[0, 0].set_ylabel("predicted")
    axes[1, 0].set_ylabel("residual")
    whole.supxlabel("measured", fontsize="medium")
    return _finished(chart, whole, repr(fit)[1:-1], path)


def _finished(chart: FitChart, whole: Figure, title: str, path: Any) -> FitChart:
    """Style the axes, set the title, and write the picture if there is a path."""
    for ax in chart.axes:
        dress_grid(ax)
    whole.align_ylabels(chart.axes)
    width = whole.bbox.width / whole.get_figure(root=True).dpi
    whole.suptitle(fill(title, max(20, int(13 * width))), fontsize="medium")
    write(chart, picture_file(path))
    return chart
