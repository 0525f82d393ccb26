"""The lines of code in the gallery are those that made its pictures."""

import itertools
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
import rolling_ellipse as rl
from numpy.typing import NDArray
from oracles.paths import ROOT, made_by
from PIL import Image

FOLDER = ROOT / "docs" / "gallery"
TIMED = "work_precision.png"  # shows measured times, which differ between runs
# Largest mean difference between a picture and the same picture drawn again, both reduced in size,
# on a scale of 255. Versions of matplotlib move letters by a pixel; the two most similar pictures
# of the page differ by more than twice as much.
ALIKE = 2.0


@pytest.fixture(scope="module")
def maker() -> dict[str, Any]:
    return made_by("gallery")


def small(path: Path) -> NDArray[np.float64]:
    return np.asarray(Image.open(path).convert("L").resize((64, 64), Image.Resampling.BOX), float)


def test_every_code_block_draws_its_picture(maker: Any, tmp_path: Path, monkeypatch: Any) -> None:
    plt.switch_backend("Agg")
    monkeypatch.chdir(tmp_path)
    maker["main"](tmp_path / "made")
    made = {path.name for path in (tmp_path / "made").iterdir()}
    assert made == {path.name for path in FOLDER.iterdir()} and len(made) > 12
    for name in made - {TIMED}:
        assert np.abs(small(tmp_path / "made" / name) - small(FOLDER / name)).mean() < ALIKE, name


def test_any_two_pictures_of_the_gallery_differ() -> None:
    for one, other in itertools.combinations(sorted(FOLDER.iterdir()), 2):
        assert np.abs(small(one) - small(other)).mean() > 2 * ALIKE, (one.name, other.name)


def test_the_gallery_draws_every_public_picture_in_at_most_six_lines(maker: dict[str, Any]) -> None:
    blocks = maker["blocks"]()
    text = "".join(code for code, _ in blocks)
    drawing = {name for name in rl.__all__ if name.startswith("plot_")} | {"plot", "animate"}
    assert not [name for name in drawing if f"rl.{name}(" not in text]
    assert not [name for name in ("ends", "fit_motion", "work_precision") if name not in text]
    for code, _ in blocks:
        assert code.count("\n") <= 6 and max(map(len, code.split("\n"))) <= 94
    assert [name for _, name in blocks if not name] == [""]  # the first block
