"""Make the pictures of the README: roll.gif and overview.png, beside this file."""

from io import BytesIO
from pathlib import Path

import rolling_ellipse as re
from matplotlib.figure import Figure
from PIL import Image

HERE = Path(__file__).parent


def main() -> None:
    trajectory = re.simulate(re.scenes.report, 6.0)
    re.animate(trajectory, HERE / "roll.gif")
    overview = re.plot(trajectory, figure=Figure(figsize=(10, 8.5), layout="constrained"))
    picture = BytesIO()
    overview.figure.savefig(picture, dpi=120)
    colours = Image.open(picture).convert("RGB").quantize(128)  # a third of the bytes
    colours.save(HERE / "overview.png", optimize=True)


if __name__ == "__main__":
    main()
