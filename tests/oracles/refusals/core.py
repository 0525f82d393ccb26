"""Refusals of what is physically there, of the core and of the functions that are asked of it."""

import math
from decimal import Decimal
from typing import Any

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import Impulse, Scene, _core, geometry, impacts, scenes

from oracles.quantities import Pint
from oracles.refusals import Refusal

ROLLING = Scene(2.0, 1.0, omega=1.0)
AIR = Scene(2.0, 1.0, z=3.0)
MOTION = rl.simulate(ROLLING, 0.5)
FAR = rl.simulate(rl.Scene(2.0, 1.0, theta=1e16, omega=1.0), 0.5, model="rolling")
TWO_IMPACTS: Any = np.zeros((3, 2))
Q, Q_DOT = rl.kinematics(0.3, 1.0, a=2.0, b=1.0)
AXES: dict[str, Any] = {"a": 2.0, "b": 1.0}
FLOW: dict[str, Any] = {"t": 1.0, **AXES, "theta": 0.2, "omega": 1.0}
HIT: dict[str, Any] = {
    "x_dot": 0.0, "z_dot": -1.0, "omega": 0.0, "friction": 0.3, "restitution": 0.5, **AXES,
}  # fmt: skip
MASKED: Any = np.ma.array([1.0, 2.0], mask=[True, False])
SEVEN = [np.array([value]) for value in (1.0, 2.0, 1.0, 0.2, 1.0, 9.81, 1.25)]  # of the core
TEXT: Any = "x"
DEEP: list[Any] = []
DEEP.append(DEEP)


def axes(theta: Any) -> Any:
    return geometry.support(theta, **AXES)


SCENES: list[Refusal] = [
    (r"^a must be a number, got 'x'", lambda _: Scene(TEXT, 1.0)),
    (r"^a must be a positive finite length \[m\], got 0\.0", lambda _: Scene(0.0, 1.0)),
    (r"^a must be a length \[m\] between 1e-30 and 1e30", lambda _: Scene(1e40, 1e40)),
    (r"^a/b must be between 1e-3 and 1e3, got 10000", lambda _: Scene(1e4, 1.0)),
    (r"^mass must be a positive finite mass \[kg\]", lambda _: Scene(2.0, 1.0, mass=-1.0)),
    (
        r"^gravity must be a positive finite acceleration \[m/s\^2\]",
        lambda _: Scene(2.0, 1.0, gravity=0.0),
    ),
    (
        r"^inertia must be a positive finite moment of inertia \[kg m\^2\]",
        lambda _: Scene(2.0, 1.0, inertia=0.0),
    ),
    (r"^inertia must be between 1e-6 and 1e6 times", lambda _: Scene(2.0, 1.0, inertia=1e40)),
    (r"^slope must be an angle .* -1\.5 to 1\.5, got 1000", lambda _: Scene(2.0, 1.0, slope=1e3)),
    (r"^slope must be .* \(degrees\? times pi/180\)", lambda _: Scene(2.0, 1.0, slope=30.0)),
    (
        r"^friction must be a coefficient from 0 to 1e6, or inf, got -1",
        lambda _: Scene(2.0, 1.0, friction=-1.0),
    ),
    (r"^restitution must be between 0 and 1", lambda _: Scene(2.0, 1.0, restitution=2.0)),
    (
        r"^theta must be a finite number \[rad\] of at most 1e50, got nan",
        lambda _: Scene(2.0, 1.0, theta=math.nan),
    ),
    (r"^omega must be a finite number \[rad/s\]", lambda _: Scene(2.0, 1.0, omega=1e51)),
    (r"^omega must be at most .* \[rad/s\] in size for", lambda _: Scene(2.0, 1.0, omega=1e8)),
    (r"^x must be a finite number \[m\]", lambda _: Scene(2.0, 1.0, x=math.inf)),
    (r"^x_dot must be a finite number \[m/s\]", lambda _: Scene(2.0, 1.0, x_dot=math.inf)),
    (r"^x_dot must be at most .* \[m/s\] in size for", lambda _: Scene(2.0, 1.0, x_dot=1e8)),
    (r"^z must be at most .* \[m\] in size for", lambda _: Scene(2.0, 1.0, z=1e13)),
    (
        r"^impulse must be weak enough to leave the body, .* 1e12 times mass gravity max",
        lambda _: Scene(2.0, 1.0, impulse=Impulse(1e9)),
    ),
    (
        r"^z must be at least h\(theta\) = 1\.0 \[m\], the height at which the ellipse touches",
        lambda _: Scene(2.0, 1.0, z=0.5),
    ),
    (
        r"^z_dot must be at least h'\(theta\)\*omega = .* while touching the ground \(less moves",
        lambda _: Scene(2.0, 1.0, z_dot=-1.0),
    ),
    (
        r"^impulse must be along a line that meets the body, at most .* at this angle and dir",
        lambda _: Scene(2.0, 1.0, impulse=Impulse(0.0, -1.0, dx=3.0)),
    ),
    (r"^impulse must be an Impulse or None, got 1", lambda _: Scene(2.0, 1.0, impulse=1)),  # type: ignore[arg-type]
    (
        r"^impulse must be one blow, got an Impulse of shape \(2,\)",
        lambda _: Scene(2.0, 1.0, impulse=Impulse([1.0, 2.0])),
    ),
    (r"^changes must be of a, b, .*, got color", lambda _: ROLLING.replace(color=1)),
    (r"^jx must be a finite number \[N s\] of", lambda _: Impulse(1e51)),
    (r"^F must be a finite number \[N s\] .*, got nan", lambda _: Impulse.press(math.nan, 1.0)),
    (r"^jx must be .* at most 1e50, got 1e\+60 at index 1", lambda _: Impulse([1.0, 1e60])),
]  # fmt: skip

NUMBERS: list[Refusal] = [
    (r"^count must be a whole number, got 'x'", lambda _: rl.plot_strobe(MOTION, count=TEXT)),
    (r"^fps must be positive and finite", lambda _: rl.animate(MOTION, fps=-1.0)),
    (r"^b must be positive and finite", lambda _: rl.plot_phase_map(b=-1.0)),
    (r"^count must be at least 1", lambda _: rl.plot_strobe(MOTION, count=0)),
    (r"^count must be at most 10000", lambda _: rl.plot_strobe(MOTION, count=10**6)),
    (r"^workers must be an int from 1 to 1024, or -1", lambda _: rl.flow(**FLOW, workers=0)),
    (r"^workers must be a whole number, or an executor", lambda _: rl.flow(**FLOW, workers="x")),
    (r"^fold must be True or False, got 1", lambda _: rl.plot_phase(MOTION, fold=1)),  # type: ignore[arg-type]
    (r"^trajectories must have angles of which a double", lambda _: rl.plot_phase(FAR)),
    (r"^t must be a number or an array of numbers", lambda _: rl.flow(**{**FLOW, "t": "x"})),
    (r"^t must have no masked entries", lambda _: rl.flow(**{**FLOW, "t": MASKED})),
    (r"^t must be plain numbers in SI units", lambda _: rl.flow(**{**FLOW, "t": Pint(1.0)})),
    (r"^theta must have at most 32 axes, got 33", lambda _: axes(np.zeros((1,) * 33))),
    (r"^theta must have at most 32 axes, got \[\[", lambda _: axes([DEEP])),
    (r"^t must be within the range of doubles", lambda _: rl.flow(**{**FLOW, "t": 10**400})),
    (
        r"^t must be within the range of doubles",
        lambda _: rl.flow(**{**FLOW, "t": np.array([np.longdouble("1e400")])}),
    ),
    (r"^a must be a number, got .*sNaN", lambda _: Scene(Decimal("sNaN"), 1.0)),  # type: ignore[arg-type]
    (r"^q must have 5 entries .* along its last", lambda _: rl.constraints([1.0], Q_DOT, **AXES)),
    (r"^theta must be finite, got inf", lambda _: rl.kinematics(math.inf, 1.0, **AXES)),
    (r"^omega must be finite, got inf", lambda _: rl.kinematics(0.3, math.inf, **AXES)),
    (r"^theta must be finite, got nan", lambda _: geometry.support(math.nan, **AXES)),
    (r"^q must be finite, got nan", lambda _: rl.constraints([math.nan] * 5, Q_DOT, **AXES)),
    (
        r"^arguments must broadcast together, got shapes t \(2,\)",
        lambda _: rl.flow(**{**FLOW, "t": [1.0, 2.0], "a": [2.0, 2.0, 2.0]}),
    ),
    (r"^a\[1\] must be a positive", lambda _: rl.flow(**{**FLOW, "a": [2.0, -1.0]})),
    (r"^path must be a path, a string or a PathLike", lambda _: rl.load(1)),  # type: ignore[arg-type]
    (r"^path must name a file, got ''", lambda _: rl.load("")),
]  # fmt: skip

QUESTIONS: list[Refusal] = [
    (r"^scene must be a Scene, got 1", lambda _: rl.certify(1)),  # type: ignore[arg-type]
    (r"^t must be finite \[s\], got inf", lambda _: rl.flow(**{**FLOW, "t": math.inf})),
    (r"^t must be at most 1e15 half turns or swings", lambda _: rl.flow(**{**FLOW, "t": 1e30})),
    (r"^gyration2 must be between 1e-6 and 1e6", lambda _: rl.flow(**FLOW, gyration2=1e40)),
    (r"^gyration2 must be a positive finite area", lambda _: rl.flow(**FLOW, gyration2=-1.0)),
    (r"^scene must start rolling, but", lambda _: rl.period(AIR)),
    (
        r"^scene must repeat itself, but on a slope of .* rad the body runs downhill for ever",
        lambda _: rl.period(scenes.slope),
    ),
    (r"^impulse must be an Impulse or None, got 1", lambda _: rl.outcome(ROLLING, 1)),  # type: ignore[arg-type]
    (
        r"^impulse must be along a line .*, by blow 1",
        lambda _: rl.outcome(ROLLING, Impulse.press(1.0, [0.0, 5.0])),
    ),
    (r"^scenes must have shape \(n, ", lambda _: _core.first_refused(np.ones((2, 2)), False)),
    (r"^level must be one of 'best'.*, got 'x'", lambda _: _core.flow_array(1, SEVEN, 1, "x")),
    (r"^scene must touch the ground: no contact holds", lambda _: rl.blow_to(AIR, 1.0)),
    (r"^distance must be over the body, at most", lambda _: rl.blow_to(ROLLING, 3.0)),
    (
        r"^omega must be one that the ground can keep, got",
        lambda _: rl.blow_to(Scene(2.0, 1.0, friction=0.1), 1.5, omega=1.0),
    ),
    (r"^omega must differ from what", lambda _: rl.blow_to(Scene(2.0, 1.0), 1.0, omega=0.0)),
    (
        r"^distance must be on the other side of the contact.* it would have to be a pull",
        lambda _: rl.blow_to(Scene(2.0, 1.0), -1.0, omega=1.0),
    ),
    (
        r"^distance must not be right over the contact, where",
        lambda _: rl.blow_to(Scene(2.0, 1.0), 0.0, omega=1.0),
    ),
    (r"^omega must be given on a slope", lambda _: rl.blow_to(Scene(2.0, 1.0, slope=0.1), 1.0)),
    (r"^scene must not roll over without", lambda _: rl.blow_to(Scene(2.0, 1.0, omega=3.2), 1.0)),
    (r"^omega must be given for a circle and on", lambda _: rl.blow_to(Scene(1.0, 1.0), 0.5)),
    (
        r"^distance must be one at which a press rolls the body over",
        lambda _: rl.blow_to(Scene(2.0, 1.0, friction=0.05), 1.5),
    ),
]  # fmt: skip

MOTIONS: list[Refusal] = [
    (
        r"^t must be an end time, 6, or an array of times, np\.linspace\(0, 6, n\) or,",
        lambda _: rl.simulate(ROLLING, (0, 6)),
    ),
    (r"^t must be finite \[s\], got nan", lambda _: rl.simulate(ROLLING, math.nan)),
    (r"^t must not be negative \[s\]", lambda _: rl.simulate(ROLLING, -1.0)),
    (r"^t must be an end time or a 1-D array", lambda _: rl.simulate(ROLLING, [[1.0]])),
    (r"^t must be strictly increasing, got", lambda _: rl.simulate(ROLLING, [1.0, 1.0])),
    (r"^t must be at most 1e15 half turns", lambda _: rl.simulate(ROLLING, 1e30)),
    (r"^model must be one of 'auto'", lambda _: rl.simulate(ROLLING, 1.0, model=TEXT)),
    (r"^model 'rolling' must start rolling, but", lambda _: rl.simulate(AIR, 1.0, model="rolling")),
    (r"^rtol must be a finite number of at", lambda _: rl.simulate(ROLLING, 1.0, rtol=-1.0)),
    (r"^rtol and atol must not both be 0", lambda _: rl.simulate(ROLLING, 1.0, rtol=0.0, atol=0.0)),
    (r"^max_steps must be at least 1, got 0", lambda _: rl.simulate(ROLLING, 1.0, max_steps=0)),
    (
        r"^max_steps must be less than 2\*\*31 in size",
        lambda _: rl.simulate(ROLLING, 1.0, max_steps=2**31),
    ),
    (r"^baumgarte must be two numbers", lambda _: rl.simulate(ROLLING, 1.0, baumgarte=1.0)),  # type: ignore[arg-type]
    (
        r"^baumgarte must be two finite gains of at least 0 and at most 1e50",
        lambda _: rl.simulate(ROLLING, 1.0, model="multipliers", baumgarte=(-1.0, 1.0)),
    ),
    (
        r"^step must be given \[s\] for method 'rk4', got None",
        lambda _: rl.simulate(ROLLING, 1.0, method="rk4"),
    ),
    (
        r"^step must be None for method 'auto', which takes no fixed steps",
        lambda _: rl.simulate(ROLLING, 1.0, step=0.1),
    ),
    (
        r"^step must be a positive finite time \[s\]",
        lambda _: rl.simulate(ROLLING, 1.0, method="rk4", step=0.0),
    ),
    (
        r"^step must be at most the time simulated, 1\.0 \[s\]",
        lambda _: rl.simulate(ROLLING, 1.0, method="rk4", step=2.0),
    ),
    (
        r"^step must be at least .* \[s\], which the last time still knows",
        lambda _: rl.simulate(ROLLING, 1.0, method="rk4", step=1e-18),
    ),
    (
        r"^method must be 'auto' for model 'contact', got 'rk4'",
        lambda _: rl.simulate(ROLLING, 1.0, model="contact", method="rk4"),
    ),
    (
        r"^method must be one of 'dop853', 'dopri5', 'rk4', 'radau' for model 'multipliers', got",
        lambda _: rl.simulate(ROLLING, 1.0, model="multipliers", method="exact"),
    ),
    (
        r"^stabilization must be left alone for model 'rolling', which has no constraints to drift",
        lambda _: rl.simulate(ROLLING, 1.0, model="rolling", stabilization="none"),
    ),
    (
        r"^stabilization must be 'ggl' for method 'radau', got",
        lambda _: rl.simulate(ROLLING, 1.0, model="multipliers", method="radau", step=0.1),
    ),
    (
        r"^stabilization must not be 'ggl', which only method 'radau' can solve, for method 'rk4'",
        lambda _: rl.simulate(
            ROLLING, 1.0, model="multipliers", method="rk4", step=0.1, stabilization="ggl"
        ),
    ),
    (
        r"^stages must be None for method 'rk4' \('gauss' has 2, 3 or 4\), got 3",
        lambda _: rl.simulate(ROLLING, 1.0, method="rk4", step=0.1, stages=3),
    ),
    (
        r"^stages must be 2, 3 or 4, got 5",
        lambda _: rl.simulate(ROLLING, 1.0, method="gauss", step=0.1, stages=5),
    ),
    (
        r"^rest_speed must be a positive finite speed \[m/s\]",
        lambda _: rl.simulate(ROLLING, 1.0, rest_speed=-1.0),
    ),
    (
        r"^rest_speed must be at most .* \[m/s\], a hundredth of sqrt\(g min\(a, b\)\)",
        lambda _: rl.simulate(scenes.drop, 1.0, rest_speed=1.0),
    ),
    (r"max_events", lambda _: rl.simulate(scenes.jump, 5.0, max_events=1)),
]  # fmt: skip

IMPACTS: list[Refusal] = [
    (r"^x_dot must be finite", lambda _: impacts.kinetic_speed(math.nan, 1.0, 0.0, gyration2=1.0)),
    (r"^theta must be a finite number", lambda _: impacts.collide(math.nan, **HIT)),
    (
        r"^gyration2 must be a positive finite area",
        lambda _: impacts.kinetic_speed(0.0, 1.0, 0.0, gyration2=-1.0),
    ),
    (
        r"^after must have as many impacts as before, 1, got 2",
        lambda _: impacts.fit([[0.0], [0.0], [-1.0], [0.0]], TWO_IMPACTS, **AXES),
    ),
    (
        r"^before must be 4 columns of one number for each impact",
        lambda _: impacts.fit([1.0], TWO_IMPACTS, **AXES),
    ),
    (
        r"^before must be moving into the ground \(a negative gap rate",
        lambda _: impacts.fit([[0.0], [0.0], [1.0], [0.0]], [[0.0]] * 3, **AXES),
    ),
]

REFUSALS: list[Refusal] = [*SCENES, *NUMBERS, *QUESTIONS, *MOTIONS, *IMPACTS]
