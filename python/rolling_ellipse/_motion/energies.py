"""Energies of a body's states."""

from __future__ import annotations

from typing import Any


def energies(body: Any, of: Any) -> tuple[Any, Any, Any]:
    """Return translational, rotational and potential energy of a state, or of samples [J].

    A body is given by the numbers of `_core.Scene.body`, or by arrays of them. Squares are written
    as products, since powers of floats and of arrays are rounded differently.
    """
    mass, _, gyration2, gravity, cosine, sine, _ = body
    translational = 0.5 * mass * (of.x_dot * of.x_dot + of.z_dot * of.z_dot)
    rotational = 0.5 * (mass * gyration2) * (of.omega * of.omega)
    return translational, rotational, mass * gravity * (of.z * cosine - of.x * sine)


def energy(body: Any, of: Any) -> Any:
    """Return the energy of a state [J]; since Python 3.12 `sum` would round it differently."""
    translational, rotational, potential = energies(body, of)
    return translational + rotational + potential
