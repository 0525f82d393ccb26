"""The centre in stepped rolling: x is the integral of the height over the angle, at the steps and
between them, judged by Legendre's elliptic integral in 40 digits."""

from typing import Literal

import mpmath as mp
import numpy as np
import pytest
import rolling_ellipse as rl
from oracles.numbers import DIGITS, EPS
from rolling_ellipse import Scene

pytestmark = pytest.mark.filterwarnings("ignore:rolling is valid until")

# bodies flat, upright, round and of the thinnest shape; both directions, several half turns
SCENES = {
    "flat": Scene(2.0, 1.0, theta=0.2, omega=3.2, x=0.3),
    "upright": Scene(0.7, 1.9, theta=1.2, omega=-4.0),
    "rocking": Scene(2.0, 1.0, theta=0.5),
    "circle": Scene(1.0, 1.0, omega=-2.0),
    "nearly a circle": Scene(1.0, 1.0 - 1e-8, omega=2.0),
    "many turns on": Scene(2.0, 1.0, theta=3e5, omega=3.2),  # an angle beyond the stored series
    "many turns back": Scene(0.7, 1.9, theta=-3e5, omega=-4.0),
    "thinnest": Scene(1.0, 1e-3, theta=0.3),
    "thinnest, upright": Scene(1e-3, 1.0, theta=0.1, omega=9.0),
}


def path(scene: Scene, theta: float) -> mp.mpf:
    """Integral of h = b sqrt(1 - m sin^2), m = 1 - a^2/b^2, from 0 to theta."""
    with mp.workdps(DIGITS):
        a, b = mp.mpf(scene.a), mp.mpf(scene.b)
        return b * mp.ellipe(mp.mpf(theta), 1 - (a / b) ** 2)


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("method", ["dop853", "dopri5"])
def test_x_is_the_path_of_the_angle(scene: Scene, method: Literal["dop853", "dopri5"]) -> None:
    """x errs by a few roundings of the path, whose reference points are up to half a radian away,
    and of the angle, which is rounded to half an ulp."""
    motion = rl.simulate(
        scene, np.linspace(0.0, 6.0, 97), model="rolling", method=method, rtol=1e-6
    )
    start = path(scene, scene.theta)
    height = max(scene.a, scene.b)
    for theta, x in zip(motion.theta, motion.x, strict=True):
        exact = scene.x + path(scene, theta) - start
        size = abs(scene.x) + height * (0.5 + abs(theta) + abs(scene.theta))
        assert abs(x - exact) <= 4 * EPS * size
