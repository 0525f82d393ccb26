"""Scenes to draw, and what a drawn ellipse is, from matplotlib's own transform of it."""

import numpy as np
import rolling_ellipse as rl
from matplotlib.patches import Ellipse
from numpy.typing import NDArray

ORDINARY_SCENES = {
    "report": rl.scenes.report,
    "rocking": rl.scenes.rocking,
    "circle": rl.scenes.circle,
    "thin": rl.scenes.thin,
    "standing": rl.Scene(0.7, 1.9, omega=1.0),
    "backwards": rl.Scene(2.0, 1.0, omega=-3.2),
}


def support(body: Ellipse) -> tuple[float, float]:
    """Lowest point (x, z) of a patch: the image of the unit circle under p -> c + M p.

    The circle's point lowest in direction e_z is p = -row_z / |row_z| of M.
    """
    matrix = body.get_patch_transform().get_matrix()
    (row_x, row_z), centre = matrix[:2, :2], matrix[:2, 2]
    lowest = -row_z / np.hypot(*row_z)
    return float(centre[0] + row_x @ lowest), float(centre[1] + row_z @ lowest)


def outline(body: Ellipse, count: int = 200) -> NDArray[np.float64]:
    """Points of the outline, (count, 2)."""
    angle = np.linspace(0, 2 * np.pi, count)
    return np.asarray(
        body.get_patch_transform().transform(np.column_stack([np.cos(angle), np.sin(angle)]))
    )
