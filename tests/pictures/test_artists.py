"""What plot functions return says what there is, not where in memory it is."""

import re
from collections.abc import Callable
from typing import Any

import pytest
import rolling_ellipse as rl
from matplotlib.figure import Figure

MOTION = rl.simulate(rl.scenes.jump, 1.0)
DRAWN: dict[str, tuple[Callable[..., Any], str]] = {
    "Overview": (
        lambda: rl.plot(MOTION, figure=Figure()), "figure, strobe, theta, .*, 18 marks"
    ),
    "Strobe": (lambda: rl.plot_strobe(MOTION, ax=axes(), count=7), "ax, 7 bodies, 7 hands, .*"),
    "Phase": (lambda: rl.plot_phase([MOTION, MOTION], ax=axes()), "ax, 2 motions, .*"),
    "Energy": (lambda: rl.plot_energy(MOTION, ax=axes()), "ax, 1 total, 1 kinetic, .*"),
    "Forces": (lambda: rl.plot_forces(MOTION, ax=[axes(), axes()]), "2 axes, 1 normal, .*"),
    "Constraints": (lambda: rl.plot_constraints(MOTION, ax=axes()), "1 axes, 1 lines, .*"),
    "Paths": (lambda: rl.plot_paths(MOTION, ax=axes()), "ax, 1 centres, 1 tips, .*"),
    "PhaseMap": (lambda: rl.plot_phase_map(resolution=3, ax=axes()), "ax, cells, .* marks, .*"),
}  # fmt: skip


def axes() -> Any:
    return Figure().add_subplot()


@pytest.mark.parametrize("name", DRAWN)
def test_the_repr_names_the_artists(name: str) -> None:
    draw, said = DRAWN[name]
    text = repr(draw())
    assert " at 0x" not in text and "\n" not in text
    assert re.fullmatch(rf"<{name}: {said}>", text), text
