"""Methods of Trajectory and Events whose modules import these classes, or are slow to load."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from .._motion.events import Events
from .._motion.trajectory import Trajectory

_PACKAGE = __name__.partition(".")[0]

#: Names of methods by class and module; the functions have the same names.
METHODS: dict[type, dict[str, tuple[str, ...]]] = {
    Trajectory: {
        "_motion.instant": ("at",),
        "_motion.passages": ("when",),
        "_motion.export.files": ("save", "load"),
        "_motion.export.tables": ("to_dataframe", "to_xarray"),
        "_pictures": (
            "plot", "plot_constraints", "plot_energy", "plot_error", "plot_forces", "plot_paths",
            "plot_phase", "plot_strobe",
        ),
        "_player": ("animate",),
        "_show.notebook": ("_repr_html_",),
    },
    Events: {"_motion.export.event_table": ("to_dataframe",)},
}  # fmt: skip
_OF_THE_CLASS = ("load",)


class _Later:
    """A method that is imported when first asked for, and then replaces this object."""

    def __init__(self, owner: type, module: str, name: str) -> None:
        self._owner, self._module, self._name = owner, f"{_PACKAGE}.{module}", name

    def __get__(self, instance: object | None, owner: type) -> Any:
        method = getattr(import_module(self._module), self._name)
        if self._name in _OF_THE_CLASS:
            method = classmethod(method)
        setattr(self._owner, self._name, method)
        return method.__get__(instance, owner)


for _owner, _modules in METHODS.items():
    for _module, _names in _modules.items():
        for _name in _names:
            setattr(_owner, _name, _Later(_owner, _module, _name))
