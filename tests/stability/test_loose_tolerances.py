"""A tolerance of 1e-2, as the report used: what leaves its constraints, what stays on them, what
keeps its energy.

A tolerance bounds what a step loses, not what is kept: only what is kept by construction is kept
whatever the tolerance.
"""

from functools import cache

import numpy as np
import pytest
from oracles.margins import told
from oracles.stability import grain
from stability_laws import LOOSE, ROCKED, SPUN, Loose, loose

SCENES = {"rotation": SPUN, "rocking": ROCKED}
RTOL = 1e-2
each_run = pytest.mark.parametrize(
    ("scene", "name"), [(scene, name) for scene in SCENES for name in LOOSE]
)


@cache
def run(scene: str, name: str) -> Loose:
    found = loose(SCENES[scene], LOOSE[name])
    told(
        f"constraints {found.missed.max():8.1e}, at the end {found.missed[-1]:8.1e}; energy "
        f"{found.energy.max():8.1e}; phase {found.phase:8.1e}; {'WARNED' if found.texts else ''}"
    )
    return found


def kind(name: str) -> str:
    return name.split(", ")[-1]


@each_run
def test_constraints_are_kept_by_construction_or_not(scene: str, name: str) -> None:
    """Left free they are missed by half a semi-axis or more: 100 steps of errors of 1e-2, and drift
    adds them up like t^2. Feedback leaves what some steps miss, at least the tolerance over ten,
    at most a semi-axis. All else is at 16 ulp of theta, at samples between steps, too."""
    found = run(scene, name)
    if kind(name) == "none":
        assert found.missed.max() > 0.5
    elif kind(name) == "baumgarte":
        assert RTOL / 10 < found.missed.max() < 1
    else:
        held = np.abs(found.motion.constraint_residuals().position).max(1)
        assert np.all(held <= grain(found.motion))


@each_run
def test_energy_is_kept_by_construction_or_not(scene: str, name: str) -> None:
    """By the exact motion (4 ulp: a sum of squares of rounded rates) and by projection with the
    energy (8); all else loses more than a tenth of a thousandth, or 1e-5 where Radau's steps are a
    thirtieth of a swing."""
    found = run(scene, name)
    if kind(name) in ("exact", "contact", "projection+energy"):
        off = np.abs(found.motion.energy / found.motion.energy[0] - 1)
        # a rotation's theta is 100: its last digit is 64 ulp, of which the ground has the slope 1
        assert np.max(off) <= 8 * 2.0**-52 * max(1, np.abs(found.motion.theta).max())
    else:
        assert found.energy.max() > (1e-5 if kind(name) == "ggl" else 1e-4)


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("name", ["dopri5, projection", "dopri5"])
def test_constraints_do_not_make_a_motion_right(scene: str, name: str) -> None:
    """On its constraints to the last digit, by projection or as rolling, dopri5 loses more
    than twice the tolerance of its energy and a tenth of a radian; that is what the tolerance is
    for. How much hangs on which steps are refused, that is after a minute on the last bits."""
    found = run(scene, name)
    assert found.missed.max() < 1e-13 and found.energy.max() > 2 * RTOL and found.phase > 0.1
