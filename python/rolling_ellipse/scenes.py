"""Named scenes: a = 2 m, b = 1 m, 1 kg, infinite friction, level ground unless stated otherwise.

==============  ====================================================================================
``report``      10 kg, pressed with 48 N s at 1.5 m from the centre as in the report's Figure 9: it
                rolls over
``rocking``     released from 0.5 rad: it rocks
``rolling``     3.2 rad/s lying flat: it rolls over and over
``separatrix``  2.952967565 rad/s lying flat, (1 + 1e-6) times the speed that just reaches the tip
``circle``      a = b = 1 m, 2 rad/s: uniform rolling
``thin``        b = 0.02 m, released from 0.3 rad
``slope``       3 rad/s down a slope of 0.1 rad, friction 0.8
``slip``        starts at 3 m/s without rotation, friction 0.2: it slides first
``jump``        5.2 rad/s lying flat, friction 1: too fast to stay on the ground
``drop``        dropped from 1 m above contact at 0.5 rad, friction 1
``bounce``      like ``drop``, but elastic and without friction
==============  ====================================================================================

These scenes are for pictures; the problems of `benchmark` are for comparing simulators. ``slip``
and ``jump`` are in both sets. The other problems have finite friction and drop heights with few
digits, or start farther from thresholds, so that any simulator can represent them and rounding does
not decide the outcome (docs/benchmark.md compares the two sets).

Examples
--------
>>> motion = rl.simulate(rl.scenes.jump, 2.0)
>>> [event.kind.name for event in motion.events]
['SLIP', 'LIFT_OFF', 'IMPACT']
"""

from __future__ import annotations

from . import _core
from ._ask.scene import Impulse, Scene

_lying = Scene(2.0, 1.0, theta=0.5)
report = Scene(2.0, 1.0, mass=10.0, impulse=Impulse.press(48.0, 1.5))
rocking = Scene(2.0, 1.0, theta=0.5)
rolling = Scene(2.0, 1.0, omega=3.2)
separatrix = Scene(2.0, 1.0, omega=_core.roll_over_speed(_lying.core) * (1 + 1e-6))
circle = Scene(1.0, 1.0, omega=2.0)
thin = Scene(2.0, 0.02, theta=0.3)
slope = Scene(2.0, 1.0, slope=0.1, omega=3.0, friction=0.8)
slip = Scene(2.0, 1.0, x_dot=3.0, omega=0.0, friction=0.2)
jump = Scene(2.0, 1.0, omega=5.2, friction=1.0)
drop = Scene(2.0, 1.0, theta=0.5, z=_lying.initial_state.z + 1.0, friction=1.0)
bounce = Scene(2.0, 1.0, theta=0.5, z=drop.z, friction=0.0, restitution=1.0)

__all__ = [
    "bounce", "circle", "drop", "jump", "report", "rocking", "rolling", "separatrix", "slip",
    "slope", "thin",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__
