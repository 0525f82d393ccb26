"""Make the pictures of the README beside this file: roll.gif and methods.png."""

from io import BytesIO
from pathlib import Path

import numpy as np
import rolling_ellipse as rl
from matplotlib.figure import Figure
from PIL import Image

HERE = Path(__file__).parent
METHODS = {
    "rk4, 0.02 s": {"method": "rk4", "step": 0.02},
    "dop853, rtol 1e-10": {"method": "dop853"},
    "gauss, 0.02 s": {"method": "gauss", "step": 0.02},
    "exact": {"method": "exact"},
}


def main() -> None:
    trajectory = rl.simulate(rl.scenes.report, 6.0)
    rl.animate(trajectory, HERE / "roll.gif")
    save(methods(), "methods.png")


def methods() -> Figure:
    """Errors of the energy over 200 s; the fixed steps end at the samples."""
    figure = Figure(figsize=(7, 3.4), layout="constrained")
    t = np.linspace(0.0, 200.0, 501)
    motions = [
        rl.simulate(rl.scenes.rolling, t, model="rolling", **how) for how in METHODS.values()
    ]
    rl.plot_energy(motions, ax=figure.add_subplot(), labels=list(METHODS))
    return figure


def save(figure: Figure, name: str) -> None:
    picture = BytesIO()
    figure.savefig(picture, dpi=120)
    colours = Image.open(picture).convert("RGB").quantize(128)  # a third of the bytes
    colours.save(HERE / name, optimize=True)


if __name__ == "__main__":
    main()
