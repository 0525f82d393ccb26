"""An ellipse on the ground, set rolling by an impulse: solved exactly, proved valid, drawn.

>>> import rolling_ellipse
>>> trajectory = rolling_ellipse.simulate(rolling_ellipse.scenes.report, 6.0)
>>> trajectory.plot(); trajectory.animate("roll.gif")
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
    return {name.name: f".{line.module or ''}" for line in imports for name in line.names}


_PLACES = _listed()
__all__ = sorted([*_PLACES, "__version__"])


def __getattr__(name: str) -> _Any:
    """Import a public name on first access: matplotlib, above all, loads slowly."""
    if name == "__version__":
        from importlib.metadata import version

        value: _Any = version("rolling-ellipse")
    elif name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    elif _PLACES[name] == ".":
        value = _import_module(f".{name}", __name__)
    else:
        value = getattr(_import_module(_PLACES[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
