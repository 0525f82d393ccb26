"""Refusals of the Python bindings of the core: sizes of arrays, and times outside a solution."""

from typing import Any

import numpy as np
from rolling_ellipse import _core, scenes, simulate

from refusals import INF, NAN, Row

SCENE = scenes.rolling.core
TWO, THREE, FIVES = np.ones(2), np.ones(3), np.ones((2, 5))
TIMES = simulate(scenes.rolling, 1.0)._solution
SLIDES = simulate(scenes.slip, 1.0)._solution
COORDINATES = simulate(scenes.rolling, 0.1, model="multipliers")
SETTINGS = COORDINATES.settings.core
SEVEN = [np.array([value]) for value in (1.0, 2.0, 1.0, 0.2, 1.0, 9.81, 1.25)]


def numbered(count: int, wrong: int) -> list[Any]:
    """Arrays of two numbers, except the one at index `wrong`, which has three."""
    return [THREE if i == wrong else TWO for i in range(count)]


CONTACT = dict(zip(_core.COLUMNS["contact"], numbered(8, 6), strict=True))


REFUSALS: list[Row] = [
    ("omega", lambda _: _core.rolling_detail(SCENE, THREE, TWO, THREE)),
    ("x", lambda _: _core.rolling_detail(SCENE, TWO, TWO, THREE)),
    ("omega", lambda _: _core.rolling_contact(SCENE, THREE, TWO)),
    ("omega", lambda _: _core.rolling_equation(SCENE, THREE, TWO)),
    ("normal_force", lambda _: _core.contact_detail(SCENE, CONTACT)),
    ("q_dot", lambda _: _core.multiplier_detail(SCENE, SETTINGS, FIVES, FIVES[:1])),
    ("q", lambda _: _core.multiplier_detail(SCENE, SETTINGS, FIVES[:, :4], FIVES[:, :4])),
    ("q", lambda _: _core.simulate(SCENE, SETTINGS, TWO, (FIVES, FIVES))),
    ("t", lambda _: _core.simulate(SCENE, SETTINGS, FIVES, None)),
    ("t", lambda _: _core.simulate(SCENE, SETTINGS, TWO[:0], None)),
    ("q_dot", lambda _: _core.project(SCENE, FIVES[0], FIVES)),
    ("q_dot", lambda _: _core.constraints(FIVES, TWO, 2.0, 1.0)),
    ("q", lambda _: _core.constraint_system(FIVES[0], FIVES, 2.0, 1.0)),
    ("omega", lambda _: _core.kinematics(2, TWO, THREE, 2.0, 1.0)),
    ("theta", lambda _: _core.support(3, [TWO, np.ones(1), np.ones(1)])),
    ("omega", lambda _: _core.flow_array(2, numbered(7, 4), 1)),
    ("t", lambda _: _core.flow_times(FIVES, 2.0, 1.0, 0.1, 1.0, 9.81, None, 1)),
    ("gyration2", lambda _: _core.classify_array(2, numbered(7, 6), 1)),
    ("restitution", lambda _: _core.collide_arrays(2, numbered(9, 8), _core.Restitution.STRONGE)),
    ("t", lambda _: TIMES.samples(FIVES)),
    *(("t", lambda _, sample=sample, t=t: sample(np.array([0.0, t])))
      for sample in (TIMES.samples, SLIDES.samples,
                     COORDINATES._solution.samples)
      for t in (-1e-9, 1.0 + 1e-9, NAN, INF)),
    ("scenes", lambda _: _core.first_refused(np.ones((2, 2)), False)),
    ("level", lambda _: _core.flow_array(1, SEVEN, 1, "x")),
]  # fmt: skip
