"""Motions with a tolerance of 1e-2, as in the report: some violate their constraints, some satisfy
them, and some conserve energy.

A tolerance bounds the error of a step, not of the motion: only quantities conserved by construction
are conserved at any tolerance.
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
def test_constraints_are_satisfied_only_by_construction(scene: str, name: str) -> None:
    """Without stabilization constraints err by half a semi-axis or more: in 100 steps, errors of
    1e-2 grow like t^2. Feedback leaves the errors of a few steps, between a tenth of the tolerance
    and a semi-axis. All other methods stay within 16 ulp of theta, also at samples between
    steps."""
    found = run(scene, name)
    if kind(name) == "none":
        assert found.missed.max() > 0.5
    elif kind(name) == "baumgarte":
        assert RTOL / 10 < found.missed.max() < 1
    else:
        held = np.abs(found.motion.constraint_residuals().position).max(1)
        assert np.all(held <= grain(found.motion))


@each_run
def test_energy_is_conserved_only_by_construction(scene: str, name: str) -> None:
    """The exact motion keeps the energy (4 ulp: a sum of squares of rounded rates), and so does
    projection with the energy (8 ulp); all other methods lose more than 1e-4, or 1e-5 with Radau's
    steps of a thirtieth of a swing."""
    found = run(scene, name)
    if kind(name) in ("exact", "contact", "projection+energy"):
        off = np.abs(found.motion.energy / found.motion.energy[0] - 1)
        # theta of the rotation reaches 100, where an ulp is 64 times that of 1, and |h'| reaches 1
        assert np.max(off) <= 8 * 2.0**-52 * max(1, np.abs(found.motion.theta).max())
    else:
        assert found.energy.max() > (1e-5 if kind(name) == "ggl" else 1e-4)


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize("name", ["dopri5, projection", "dopri5"])
def test_satisfying_the_constraints_does_not_make_a_motion_right(scene: str, name: str) -> None:
    """dopri5 errs by more than twice the tolerance in energy and a tenth of a radian in phase,
    although projection or rolling holds its constraints to the last digit. The errors depend on
    which steps are rejected, and therefore, after a minute, on the last bits."""
    found = run(scene, name)
    assert found.missed.max() < 1e-13 and found.energy.max() > 2 * RTOL and found.phase > 0.1
