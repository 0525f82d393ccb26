"""Exact, provably valid motions of an ellipse that an impulse sets rolling on the ground.

All quantities are in SI units and radians: pass ``np.radians(30.0)``, and read the result with
``np.degrees(motion.theta)``. theta is positive clockwise, x points along the ground, and z points
away from the ground. Time is the first axis of every array. The docstrings end with examples, which
assume the two imports below.

=================  =================================================================================
set up a scene     `Scene` with `Impulse.press`; ready-made ones are in `scenes`
compute a motion   `simulate` returns a `Trajectory`: arrays ``motion.t``, ``.theta``, ``.x``, ...
strike it again    ``simulate(scene, 6.0, blows=[(2.0, rl.Impulse.press(20.0, 0.5))])``
at other times     ``motion.sol(times)`` for arrays and ``motion.at(t)`` for one time, without
                   solving again; ``motion.scene_at(t)`` gives a scene to continue from
times of events    ``motion.when(theta=...)``, ``.when(event="impact")``, ``motion.events``, and
                   ``motion.events.table`` as arrays
predict an outcome `outcome`, `classify`, `certify`, `thresholds`, `required_friction`, `blow_to`
draw               `plot`, `plot_curves`, `plot_strobe`, ..., also ``motion.plot()``; the object
                   returned has ``.axes`` and ``.savefig("motion.png")``;
                   ``rl.plot_curves(motions, "theta", "omega")`` draws the curves that you name
film or web page   `animate`: ``rl.animate(motion, "film.mp4")``, or .gif, .webm, .html;
                   `explore` makes a page on which you strike the body
save               ``motion.save("motion.npz")`` and `load`; a scene as text or link:
                   ``scene.to_json()``, ``scene.to_link()``, ``Scene.from_json(text)``
table              ``motion.to_dataframe()``, which has ``.to_csv``; ``motion.to_xarray()``
grid of scenes     `simulate_many`; ``returns="theta"`` gives arrays over the grid; `ends` returns
                   only the last states, and `load_many` reads a folder
fit to a film      `read_track`, `fit_motion`; to measured impacts: `impacts`
derivatives        ``motion.sensitivity(wrt="omega")``, `flow_jacobian`; ``motion.growth()``: how
                   fast small changes grow, and how long double precision resolves a chaotic motion
your own solver    `rolling_equation`: the ODE; `flow`: its solution; `work_precision`: a race;
                   ``Trajectory.from_arrays`` takes your arrays, to draw, film or compare them
                   (`plot_error`)
score a simulator  `benchmark`: ``benchmark.run(simulator)``, ``benchmark.score(results)``
teach              `course` has problem sheets and marks answers, `examples` writes the notebooks
shape and period   `geometry`, `period`
the report         `report` has its equations; `kinematics`, `constraints` use its coordinates
=================  =================================================================================

Examples
--------
>>> import numpy as np
>>> import rolling_ellipse as rl
>>> scene = rl.Scene(a=2.0, b=1.0, mass=10.0, impulse=rl.Impulse.press(48.0, 1.5))
>>> motion = rl.simulate(scene, 6.0)
>>> print(f"{np.degrees(motion.theta[-1]):.1f} degrees, {motion.x[-1]:.2f} m")
477.8 degrees, 13.05 m
>>> drawn = motion.plot("motion.png")
"""

import ast as _ast
import os as _os
from importlib import import_module as _import_module
from typing import Any as _Any


def _listed() -> dict[str, str]:
    """Return the module of each public name, as listed in the stub file of this package."""
    with open(_os.path.splitext(__file__)[0] + ".pyi", encoding="utf-8") as stub:
        lines = _ast.parse(stub.read()).body
    imports = [line for line in lines if isinstance(line, _ast.ImportFrom)]
    return {name.name: f".{line.module or name.name}" for line in imports for name in line.names}


_PLACES = _listed()
__all__ = sorted([*_PLACES, "__version__"])


def __getattr__(name: str) -> _Any:
    """Import a public name on first access, because matplotlib in particular loads slowly."""
    if name == "__version__":
        from importlib.metadata import version

        value: _Any = version("rolling-ellipse")
    elif name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    else:
        try:
            found = _import_module(_PLACES[name], __name__)
        except AttributeError as error:  # `from … import` would hide its message
            raise ImportError(f"{name} needs a module that does not load: {error}") from error
        value = found if _PLACES[name] == f".{name}" else getattr(found, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
