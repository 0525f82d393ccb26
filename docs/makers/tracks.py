"""Write the tracks of docs/data in the formats that trackers export.

    python docs/makers/tracks.py

track_tracker.txt   in the format of Tracker: two lines of names, tabs, decimal commas, degrees; the
                    clock started long before the drop, and the origin is not on the ground
track_points.csv    two markers tracked by OpenCV: pixels, frame numbers, y downwards, gaps
"""

from pathlib import Path

import numpy as np
import rolling_ellipse as rl

DATA = Path(__file__).resolve().parent.parent / "data"
DROPPED = rl.Scene(
    0.035, 0.025, z=0.1, theta=0.5, omega=12.0, x_dot=0.2, friction=0.18, restitution=0.52
)
ROCKED = rl.Scene(0.06, 0.04, theta=0.9, omega=0.0, friction=1.0)
PIXEL = 4e-4  # [m]


def tracker() -> str:
    t = np.arange(60) / 120
    seen, random = rl.simulate(DROPPED, t + 0.004), np.random.default_rng(1)
    x, y = (track + random.normal(0, 5e-4, t.size) for track in (seen.x, seen.z + 0.012))
    angle = -np.degrees(seen.theta + random.normal(0, 0.01, t.size))
    rows = ["\t".join(f"{v:.4E}" for v in row) for row in zip(t + 17.2, x, y, angle, strict=True)]
    return "\n".join(["mass A\t\t\t", "t\tx\ty\t\u03b8", *rows, ""]).replace(".", ",")


def points() -> str:
    t = np.arange(90) / 60
    seen, random = rl.simulate(ROCKED, t), np.random.default_rng(2)
    half = 0.04 * np.stack([np.cos(seen.theta), -np.sin(seen.theta)])
    centre = np.stack([seen.x, seen.z])
    lines = ["frame,x1,y1,x2,y2"]
    tracks = np.concatenate([centre - half, centre + half]) / PIXEL
    for frame, row in enumerate(tracks.T * (1, -1, 1, -1) + (400, 500, 400, 500)):
        cells = [f"{value:.1f}" for value in row + random.normal(0, 0.7, 4)]
        lines.append(f"{frame},{','.join(cells if frame not in (30, 31) else [''] * 4)}")
    return "\n".join([*lines, ""])


if __name__ == "__main__":
    (DATA / "track_tracker.txt").write_text(tracker(), encoding="utf-8")
    (DATA / "track_points.csv").write_text(points(), encoding="utf-8")
