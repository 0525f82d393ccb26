"""The outcome of a blow, the friction that rolling requires, and the blow for a given speed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import partial
from typing import Any, Literal, overload

import numpy as np
import numpy.typing as npt

from .. import _core
from .._ask.check import FloatArray, broadcast, choice, number, shaped, shown
from .._ask.impulse import Impulse
from .._ask.scene import Scene, require_scene
from .._core import Mode, Outcome
from ..geometry import support, support_slope
from .batches.asked import BLOW, SceneGrid
from .certify import certify
from .workers import Columns, shared

_SPEEDS = 2048  # number of speeds tried beyond the one that just reaches the tip
_FASTEST = 1e3  # largest relative excess of these speeds over the one that just reaches the tip


@overload
def outcome(scene: Scene, impulse: None = None) -> Outcome: ...
@overload
def outcome(scene: Scene, impulse: Impulse) -> Any: ...
def outcome(scene: Scene, impulse: Impulse | None = None) -> Outcome | npt.NDArray[np.int8]:
    """Return the first outcome of the motion after a blow, without integration.

    The Notes define the outcomes.

    Parameters
    ----------
    scene : Scene
    impulse : Impulse, optional
        Blow that replaces that of the scene; its arrays give many blows.

    Returns
    -------
    Outcome or ndarray of int8
        For an impulse of arrays, the codes of `Outcome` in their common shape.

    Raises
    ------
    ValueError
        If a blow misses the body or is stronger than a Scene accepts, or the scene has rolling
        resistance (use the events of `simulate` instead).

    Notes
    -----
    ==================  ==========================================================================
    ``SLIPS``           the contact slides just after the blow (without friction this happens
                        whenever the body moves), or the body rolls until it slips, as in `classify`
    ``LOSES_CONTACT``   the blow lifts the body off the ground, or the body is in the air; or it
                        is too fast to stay on the ground, as in `classify`; or, on a slope, it
                        rolls until it flies
    ``JAMS``            the contact slides, and no rigid-body motion continues, or two do (Painlevé)
    ``RESTS``           it stays in equilibrium
    ``ROCKS``           it rolls until it turns back
    ``ROLLS_OVER``      it rolls until it passes the tip; a circle, which has none, keeps rolling
    ``EDGE``            undecided because of rounding
    ==================  ==========================================================================

    The blow obeys the collision law of `Scene.initial_state`. The outcome of the rolling motion
    after it follows from the proofs of `classify`. On a slope the power series of `certify` follow
    the rolling motion to the first of these events. ``ROCKS`` is the first instant without
    rotation. ``ROLLS_OVER`` is the first passage of a position with the long axis perpendicular to
    the ground (for a circle, half a turn). ``SLIPS`` and ``LOSES_CONTACT`` are ends of rolling; the
    end is a flight if the body then turns too fast for its weight (c < 0 < N).

    Examples
    --------
    >>> rl.outcome(rl.scenes.report).name
    'ROLLS_OVER'
    >>> blows = rl.Impulse.press([10.0, 48.0, 60.0], 1.5)
    >>> codes = rl.outcome(rl.scenes.report.replace(friction=0.7), blows)
    >>> [rl.Outcome(code).name for code in codes]
    ['ROCKS', 'ROLLS_OVER', 'ROLLS_OVER']
    """
    scene = require_scene(scene)
    if impulse is None:
        return _core.outcome(scene.core)
    if not isinstance(impulse, Impulse):
        raise TypeError(f"impulse must be an Impulse or None, got {shown(impulse)}")
    if impulse.shape == ():
        return _core.outcome(scene.replace(impulse=impulse).core)
    shape, columns = broadcast(**{name: getattr(impulse, name) for name in BLOW})
    if scene.slope == 0:
        return _core.outcome_array(scene.core, math.prod(shape), columns).reshape(shape)
    rows = zip(*np.broadcast_arrays(*columns), strict=True)
    blows = (Impulse(**dict(zip(BLOW, row, strict=True))) for row in rows)
    codes = [_core.outcome(scene.replace(impulse=blow).core) for blow in blows]
    return np.array(codes, dtype=np.int8).reshape(shape)


@overload
def required_friction(
    scene: Scene, *, to: Literal["roll", "rest"] = "roll", workers: Any = 1
) -> float: ...
@overload
def required_friction(
    scene: Mapping[str, Any], *, to: Literal["roll", "rest"] = "roll", workers: Any = 1
) -> float | FloatArray: ...
def required_friction(
    scene: Scene | Mapping[str, Any], *, to: Literal["roll", "rest"] = "roll", workers: Any = 1
) -> float | FloatArray:
    """Return the least coefficient of friction with which the body can roll forever.

    This is the larger of two coefficients. One is required by the blow: ``|Λx|/Λz`` of the sticking
    contact, or ``|Gnt|/Gtt`` if that is larger, so that the slip stops before the compression ends
    and does not start again (the collision law of `Scene.initial_state`). The other is required by
    the rolling that follows: the largest ``|F|/N`` of the whole motion. On level ground this ratio
    comes from `certify`. On a slope it is finite for a circle, a body in equilibrium, and a body
    that rocks between two turning points; it is the maximum over the angle, from a scan and golden
    section search. The friction of the scene has no effect.

    Parameters
    ----------
    scene : Scene or mapping
        A mapping has the names of Scene's arguments, with numbers or arrays that broadcast, as for
        `simulate_many`.
    to : {"roll", "rest"}
        "rest" gives the friction with which the body can lie still on its slope at some angle.
        It is tan(slope), or infinite if that exceeds ``|a^2 - b^2|/(2 a b)``, the largest ratio
        ``|h'|/h`` of the horizontal and vertical distances between the contact and the centre.
    workers : int or executor
        As for `flow`, for the scenes of a mapping.

    Returns
    -------
    float or ndarray
        For a mapping with arrays, an array in their common shape, bit for bit as for single scenes.
        The value is infinite if no finite coefficient is sufficient: the blow lifts the body, or
        the body is in the air; its velocities make it slide; N vanishes; or a body other than a
        circle runs down a slope forever. Infinite friction may be sufficient in some of these
        cases; see `certify`. The value is 0 if any positive coefficient is sufficient; without
        friction a moving contact slides.

    Raises
    ------
    ValueError, TypeError
        If an argument is wrong; the message gives the index of a number in an array.

    Examples
    --------
    >>> print(f"{rl.required_friction(rl.scenes.report):.4f}")
    0.6667
    >>> rl.required_friction({"a": 2.0, "b": 1.0, "omega": [1.0, 2.0]}).round(3)
    array([0.328, 0.43 ])
    >>> print(f"{rl.required_friction(rl.scenes.slope, to='rest'):.4f}")
    0.1003
    """
    rests = choice("to", to, ("roll", "rest")) == "rest"
    if not isinstance(scene, Mapping):
        core = require_scene(scene).core
        return _core.friction_to_rest(core) if rests else _core.required_friction(core)
    grid = SceneGrid(scene)
    needed = shared(workers, partial(_frictions, rests))(grid.total, [grid.table()])
    return shaped(needed, grid.shape)


def _frictions(to_rest: bool, _: int, columns: Columns, threads: int) -> FloatArray:
    return _core.friction_table(columns[0], to_rest, threads)


def blow_to(scene: Scene, distance: float, *, omega: float | None = None) -> Impulse:
    """Return the press at a distance from the centre after which the body rolls as requested.

    Parameters
    ----------
    scene : Scene
        Its impulse is ignored.
    distance : float
        Horizontal distance of the press from the centre [m], as in `Impulse.press`.
    omega : float, optional
        Angular velocity just after the blow [rad/s], to within rounding. By default the least press
        after which the body rolls over on level ground is returned: the smallest F > 0 for which
        `outcome` is ``ROLLS_OVER``, to within rounding. This is the smallest double if any press
        will do. The body may roll over in either direction, since a press that just stops a slip
        may be enough. The search tries 2049 speeds in each direction, up to 1001 times the one that
        just reaches the tip, because a harder press may need less friction (on a nearly round
        body), and the presses at which a slide starts to stick. It ends with a bisection.

    Returns
    -------
    Impulse
        A press: straight down, F > 0.

    Raises
    ------
    ValueError
        If no press at that distance has the requested effect. The message gives the reason: the
        press misses the body, has no lever arm, would have to pull, or slips; the ground cannot
        hold the body at that speed; the body is in the air or rolls over without a blow; or omega
        is missing on a slope or for a circle.

    Examples
    --------
    >>> scene = rl.Scene(2.0, 1.0, mass=10.0)
    >>> blow = rl.blow_to(scene, 1.5)
    >>> print(f"{-blow.jz:.3f} N s rolls it over")
    44.294 N s rolls it over
    >>> print(f"{-rl.blow_to(scene, 1.5, omega=1.0).jz:.3f} N s starts it with 1 rad/s")
    15.000 N s starts it with 1 rad/s
    """
    bare = require_scene(scene).replace(impulse=None)
    _core.require_no_resistance(bare.core, "blow_to", "simulate shows what a blow does")
    distance = number("distance", distance)
    if bare.initial_state.mode is Mode.FLIGHT:
        raise ValueError("scene must touch the ground: no contact holds a body in the air")
    reach = float(support(bare.theta + math.pi / 2, a=bare.a, b=bare.b))
    if not abs(distance) <= reach:
        raise ValueError(
            f"distance must be above the body, at most {reach!r} [m] from its centre, got "
            f"{distance!r}"
        )
    if omega is None:
        return _least_to_roll_over(bare, distance)
    wanted = number("omega", omega)
    blow = _press_to(bare, distance, wanted)
    after = bare.replace(impulse=blow)
    start = after.initial_state
    if start.mode not in (Mode.ROLLING, Mode.REST):
        raise ValueError(
            f"omega must be one that the ground can sustain, got {wanted!r}: {start.reason}"
            f"{_needed_friction(after)}"
        )
    return blow


def _needed_friction(scene: Scene) -> str:
    needed = _core.sticking_friction(scene.core)
    if not scene.friction < needed:
        return ""
    return f" (it requires {needed:.6g})" if needed < math.inf else " (no finite one suffices)"


def _press_to(scene: Scene, distance: float, omega: float) -> Impulse:
    """Return the press at `distance` that gives the velocity `omega` if the contact sticks."""
    F = _core.press_to(scene.core, distance, omega)
    _require_lever(F, distance)
    if F == 0:
        raise ValueError(f"omega must differ from that before the blow, got {omega!r}")
    if F < 0:
        raise ValueError(
            f"distance must be on the other side of the contact, got {distance!r}: for omega = "
            f"{omega!r} the blow would have to pull"
        )
    return Impulse.press(F, distance)


def _require_lever(F: float, distance: float) -> None:
    if math.isinf(F):
        raise ValueError(
            "distance must not be directly above the contact, where a press has no lever, got "
            f"{distance!r}"
        )


def _least_to_roll_over(scene: Scene, distance: float) -> Impulse:
    """Return the least press after which the body rolls over, from a scan and bisection."""
    if scene.slope != 0:
        raise ValueError(f"omega must be given on a slope, got None with slope {scene.slope!r}")
    if outcome(scene) is Outcome.ROLLS_OVER:
        raise ValueError("scene must not roll over without a blow")
    least = _core.speed_to_the_tip(scene.core, scene.theta)
    if least == 0:
        raise ValueError("omega must be given for a circle or on the tip: no press is the least")
    speeds = least * (1 + np.concatenate([[0.0], np.geomspace(1e-13, _FASTEST, _SPEEDS)]))
    # A press may also make the body roll over against its moment: if it is weaker than the one
    # that turns the body back, but strong enough to stop its slip or to slow it down.
    press_to = partial(_core.press_to, scene.core, distance)
    forces = np.array([press_to(omega) for omega in [*-speeds, *speeds]])
    backwards, forwards = forces[0], forces[speeds.size]
    _require_lever(forwards, distance)
    forces = np.unique(np.append(forces, _limits_of_sticking(scene, distance)))
    forces = forces[(forces > 0) & np.isfinite(forces)]
    codes = outcome(scene, Impulse.press(forces, distance))
    over = np.flatnonzero(np.asarray(codes) == Outcome.ROLLS_OVER)
    if over.size == 0:
        raise _never_over(scene, distance, least if forwards > backwards else -least)
    first = int(over[0])
    high, low = float(forces[first]), float(forces[first - 1]) if first else 0.0
    while low < (middle := low + 0.5 * (high - low)) < high:
        if outcome(scene, Impulse.press(middle, distance)) is Outcome.ROLLS_OVER:
            high = middle
        else:
            low = middle
    return Impulse.press(high, distance)


def _limits_of_sticking(scene: Scene, distance: float) -> FloatArray:
    """Return the presses just below and just above those at which the contact starts to stick.

    The impulses of the ground on a contact that sticks, `along` and `up`, are linear in the press.
    It sticks if abs(along) <= friction * up.
    """
    if scene.x_dot is None:
        return np.empty(0)
    h, lead = (float(of(scene.theta, a=scene.a, b=scene.b)) for of in (support, support_slope))
    inertia = scene.gyration2 + h * h + lead * lead
    moment = (scene.gyration2 + lead * lead) * scene.omega + h * scene.x_dot
    omega = np.array([moment, (distance - lead) / scene.mass]) / inertia  # at F = 0, and per F
    along = scene.mass * (h * omega - [scene.x_dot, 0.0])
    up = scene.mass * lead * (omega - [scene.omega, 0.0]) + [0.0, 1.0]
    margins = min(scene.friction, 1e12) * up + np.outer([1.0, -1.0], along)
    at = -margins[:, 0] / np.where(margins[:, 1] == 0, np.inf, margins[:, 1])
    return np.concatenate([at * (1 - 1e-9), at * (1 + 1e-9)])


def _never_over(scene: Scene, distance: float, least: float) -> ValueError:
    """Return an error that explains why a press to the tip does not make the body roll over."""
    after = scene.replace(impulse=_press_to(scene, distance, least * (1 + 1e-6)))
    start = after.initial_state
    why = f"{start.reason}{_needed_friction(after)}"
    if start.mode is Mode.ROLLING:
        why = certify(after).reason
    return ValueError(
        f"distance must be one at which a press rolls the body over, got {distance!r}: {why}"
    )
