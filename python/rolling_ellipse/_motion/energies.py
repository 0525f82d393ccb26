"""Energies of the states of a body."""

from __future__ import annotations

from typing import Any


def energies(body: Any, of: Any) -> tuple[Any, Any, Any]:
    """Return the translational, rotational and potential energy [J] of a state or of samples.

    `body` is the list `_core.Scene.body`, or a list of arrays in the same order. Squares are
    written as products because powers of floats and of arrays are rounded differently.
    """
    mass, _, gyration2, gravity, cosine, sine, _ = body
    translational = 0.5 * mass * (of.x_dot * of.x_dot + of.z_dot * of.z_dot)
    rotational = 0.5 * (mass * gyration2) * (of.omega * of.omega)
    return translational, rotational, mass * gravity * (of.z * cosine - of.x * sine)


def energy(body: Any, of: Any) -> Any:
    """Return the energy of a state [J].

    The terms are added one by one, because `sum` rounds differently since Python 3.12.
    """
    translational, rotational, potential = energies(body, of)
    return translational + rotational + potential
