"""Names that users type out of habit, and the names that this package uses instead."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import wraps
from inspect import Parameter, Signature, signature
from typing import ParamSpec, TypeVar

MEANT = {
    "mu": "friction", "friction_coefficient": "friction", "m": "mass", "g": "gravity",
    "e": "restitution", "cor": "restitution", "I": "inertia", "J": "inertia", "k2": "gyration2",
    "alpha": "slope", "incline": "slope", "angle": "theta", "phi": "theta", "w": "omega",
    "theta_dot": "omega", "y": "z", "vx": "x_dot", "vy": "z_dot", "vz": "z_dot", "v": "x_dot",
    "y_dot": "z_dot", "dt": "step t", "h": "step", "t_eval": "t", "t_span": "t", "t_end": "t",
    "time": "t", "times": "t", "tol": "rtol", "solver": "method", "integrator": "method",
    "n_jobs": "workers", "threads": "workers", "N": "normal_force", "F": "friction_force",
    "ke": "kinetic_energy", "pe": "potential_energy", "E": "energy",
    "rotations": "turns", "hit": "impact", "bounce": "impact", "collision": "impact",
    "landing": "impact", "slide": "slip", "slipping": "slip", "sliding": "slip",
    "takeoff": "lift_off",
}  # fmt: skip

_Given = ParamSpec("_Given")
_Found = TypeVar("_Found")


def meant(word: str, names: Iterable[str]) -> str:
    """Return the end of a message about an unknown name: the names that were probably intended.

    These are the package's names for a habitual word. If there are none, the valid name with the
    most similar spelling is suggested; failing that, all names that share a dotted part with the
    word.
    """
    from difflib import get_close_matches  # takes a millisecond; needed only after a mistake

    known = {name.casefold(): name for name in names}
    near = [name for name in MEANT.get(word, "").split() if name in known]
    near = near or get_close_matches(typed := word.casefold(), known, 1, 0.7)
    near = near or [name for name in known if {*typed.split(".")} & {*name.split(".")}]
    return f"; did you mean {' or '.join(known[name] for name in near)}?" if near else ""


def understood(function: Callable[_Given, _Found]) -> Callable[_Given, _Found]:
    """Wrap a function so that the TypeError of a wrong call suggests names or the signature."""

    @wraps(function)
    def call(*given: _Given.args, **named: _Given.kwargs) -> _Found:
        try:
            return function(*given, **named)
        except TypeError as error:
            takes = signature(call).parameters.values()
            names = [each.name for each in takes]
            unknown = [meant(name, names) for name in named if name not in names]
            if not unknown and (error.__traceback__ is None or error.__traceback__.tb_next):
                raise  # the error comes from inside the function
            plain = Signature([each.replace(annotation=Parameter.empty) for each in takes])
            hint = "".join(unknown) or f"; it is called as {function.__name__}{plain}"
            wrong = str(error).rpartition("() ")[2]  # without the name of an inner function
            raise TypeError(f"{function.__name__}() {wrong}{hint}") from None

    return call
