"""Methods of Trajectory from modules that import this class or load slowly."""

from __future__ import annotations

from importlib import import_module
from typing import Any

#: Names of the methods by module; each is a function of the same name in that module.
METHODS = {
    "_motion.from_arrays": ("from_arrays",),
    "_motion.growth": ("growth",),
    "_motion.passages": ("when",),
    "_motion.sensitivity": ("sensitivity",),
    "_motion.strobe_svg": ("_repr_html_",),
    "_motion.export.files": ("save", "load"),
    "_motion.export.tables": ("to_dataframe", "to_xarray"),
    "_pictures": (
        "plot", "plot_constraints", "plot_curves", "plot_energy", "plot_error", "plot_forces",
        "plot_paths", "plot_phase", "plot_strobe",
    ),
    "_player": ("animate",),
}  # fmt: skip
_OF_THE_CLASS = ("load", "from_arrays")


class _Later:
    """A placeholder that imports a method on first access and replaces itself with it."""

    def __init__(self, of: type, module: str, name: str) -> None:
        self._of, self._module, self._name = of, module, name

    def __get__(self, instance: object | None, owner: type) -> Any:
        method = getattr(import_module(f"..{self._module}", __package__), self._name)
        if self._name in _OF_THE_CLASS:
            method = classmethod(method)
        setattr(self._of, self._name, method)
        return method.__get__(instance, owner)


def bind_methods(owner: type) -> None:
    for module, names in METHODS.items():
        for name in names:
            setattr(owner, name, _Later(owner, module, name))
