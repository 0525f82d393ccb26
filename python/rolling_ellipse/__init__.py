"""An ellipse on the ground, set rolling by an impulse: solved exactly, proved valid, drawn.

SI units and radians: ``np.radians(30.0)`` goes in, ``np.degrees(motion.theta)`` comes out. theta is
clockwise positive, x lies along the ground, z points away from it; time is the first axis. The help
of functions, classes and methods ends with examples, which assume the two imports below.

=================  =================================================================================
set up a scene     `Scene` with `Impulse.press`; ready-made ones are in `scenes`
compute a motion   `simulate`: a `Trajectory` with arrays ``motion.t``, ``.theta``, ``.x``, ...
strike it again    ``simulate(scene, 6.0, blows=[(2.0, rl.Impulse.press(20.0, 0.5))])``
at other times     ``motion.sol(times)`` for arrays, ``motion.at(t)`` for one time, neither solves
                   again; ``motion.scene_at(t)`` to continue
when it happens    ``motion.when(theta=...)``, ``.when(event="impact")``, ``motion.events``, and
                   ``motion.events.table`` as arrays
ask, not compute   `outcome`, `classify`, `certify`, `thresholds`, `required_friction`, `blow_to`
draw               `plot`, `plot_curves`, `plot_strobe`, ..., also ``motion.plot()``, return what
                   they drew, with ``.axes`` and ``.savefig("motion.png")``;
                   ``rl.plot_curves(motions, "theta", "omega")`` draws the curves that you name
film, page         `animate`: ``rl.animate(motion, "film.mp4")``, or .gif, .webm, .html; in
                   `explore` a hand strikes
save               ``motion.save("motion.npz")`` and `load`; a scene as text or link:
                   ``scene.to_json()``, ``scene.to_link()``, ``Scene.from_json(text)``
table              ``motion.to_dataframe()``, which has ``.to_csv``; ``motion.to_xarray()``
grid of scenes     `simulate_many`, with ``returns="theta"`` as arrays over the grid; `ends` keeps
                   only last states, `load_many` reads a folder
fit to a film      `read_track`, `fit_motion`; to measured impacts: `impacts`
derivatives        ``motion.sensitivity(wrt="omega")``, `flow_jacobian`; how fast changes grow,
                   and until when doubles know a chaotic motion: ``motion.growth()``
your own solver    `rolling_equation`: the ODE; `flow`: its solution; `work_precision`: a race;
                   ``Trajectory.from_arrays`` takes your arrays, to draw, film or compare them
                   (`plot_error`)
score a simulator  `benchmark`: ``benchmark.run(simulator)``, ``benchmark.score(results)``
teach              `course` has sheets and marks answers, `examples` writes the notebooks
shape and period   `geometry`, `period`
the report         `report` has its equations; `kinematics`, `constraints` its coordinates
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
    """Return the public names in the stub beside this file, each with its module."""
    with open(_os.path.splitext(__file__)[0] + ".pyi", encoding="utf-8") as stub:
        lines = _ast.parse(stub.read()).body
    imports = [line for line in lines if isinstance(line, _ast.ImportFrom)]
    return {name.name: f".{line.module or name.name}" for line in imports for name in line.names}


_PLACES = _listed()
__all__ = sorted([*_PLACES, "__version__"])


def __getattr__(name: str) -> _Any:
    """Import a public name on first access: matplotlib, above all, loads slowly."""
    if name == "__version__":
        from importlib.metadata import version

        value: _Any = version("rolling-ellipse")
    elif name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    else:
        try:
            found = _import_module(_PLACES[name], __name__)
        except AttributeError as error:  # `from rolling_ellipse import` would not show it
            raise ImportError(f"{name} needs a module that does not load: {error}") from error
        value = found if _PLACES[name] == f".{name}" else getattr(found, name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
