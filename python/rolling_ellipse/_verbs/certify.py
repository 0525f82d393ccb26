"""Certificates: proofs that rolling is valid for a whole motion, or of where it ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from .. import _core
from .._ask.printing import Listed
from .._ask.reason import in_words
from .._ask.records import FieldsOnly, find_late, trusted
from .._ask.scene import Scene, require_scene
from .._core import Validity

_VALIDITIES = tuple(Validity)  # members, indexed by their codes


@dataclass(frozen=True, repr=False)
class Certificate(FieldsOnly, Listed):
    """Proof that rolling without slip is valid for the whole motion, or of where it ends.

    Attributes
    ----------
    validity : Validity
        VALID, INVALID, EDGE (undecided because of rounding) or NO_PROOF (a start that does not
        roll, or a scene with rolling resistance).
    smallest_normal_force : float or None
        Least normal force [N] over the whole motion, in both directions of time. On a slope it is
        -inf because the body turns ever faster downhill, unless the body is a circle, rests or
        rocks.
    smallest_normal_force_angle : float or None
        Angle theta in [0, pi/2] of this force; by symmetry it occurs at every +-theta + k pi that
        the motion reaches. On a slope it is the unwrapped angle. None if the force is -inf.
    largest_friction_needed : float or None
        Largest ``|F/N|`` over the whole motion (infinite where N <= 0); on a slope it is infinite
        if the least normal force is -inf.
    largest_friction_needed_angle : float or None
        Angle at which this friction is needed, defined like that of the normal force.
    ends_at : float or None
        Unwrapped angle theta at which rolling ends, forwards in time; None if VALID. If EDGE, it is
        undecided whether rolling ends there. For a moving body without friction, whose contact
        slides at once, it is the angle of the start.
    reason : str
        Description of what is proved, with the friction that is assumed and that the blow needs.

    Examples
    --------
    >>> proof = rl.certify(rl.scenes.jump)
    >>> print(f"{proof.validity.name}: rolling ends at {np.degrees(proof.ends_at):.2f} degrees")
    INVALID: rolling ends at 35.38 degrees
    >>> print(proof.reason)
    Proved: rolling is valid up to theta = 35.376 deg, where it would need more than
    friction 1.
    """

    _units: ClassVar[dict[str, str]] = {
        "smallest_normal_force": "N", "smallest_normal_force_angle": "rad",
        "largest_friction_needed_angle": "rad", "ends_at": "rad",
    }  # fmt: skip

    validity: Validity
    smallest_normal_force: float | None
    smallest_normal_force_angle: float | None
    largest_friction_needed: float | None
    largest_friction_needed_angle: float | None
    ends_at: float | None
    reason: str

    def __repr__(self) -> str:
        return f"<Certificate {self.validity.name}: {self.reason}>"


def certify(scene: Scene) -> Certificate:
    """Return a proof that rolling is valid for the whole motion of a scene, or of where it ends.

    No equation is integrated: the proof examines the signs of polynomials.

    Parameters
    ----------
    scene : Scene

    Returns
    -------
    Certificate

    Notes
    -----
    On level ground N and F of rolling are rational functions of the height h of the centre.
    Bernstein coefficients with subdivision prove the signs of a quintic (N > 0) and of a polynomial
    of degree 10 (``|F| <= friction N``) for the heights that the motion reaches; each coefficient
    has a margin for its rounding error. The extremes are evaluated at critical points, not at
    samples.

    On a slope the forces at each angle are linear in the energy of the motion, so that the contact
    law holds for an interval of energies. Power series represent the motion with its N and F to
    within rounding, and Bernstein coefficients locate the first violation of the law. Of many half
    turns only those that imply the result for all others are examined. A violation within rounding
    is EDGE. Rolling that holds for 1e15 half turns is VALID; ``reason`` then says so.

    Examples
    --------
    >>> proof = rl.certify(rl.Scene(2.0, 1.0, omega=3.2, friction=0.5))
    >>> proof.validity.name
    'VALID'
    >>> print(f"N >= {proof.smallest_normal_force:.3f} N")
    N >= 5.956 N
    >>> print(f"friction needed {proof.largest_friction_needed:.4f}")
    friction needed 0.2753
    >>> rl.certify(rl.scenes.jump).validity.name
    'INVALID'
    """
    proof = _core.certify(core := require_scene(scene).core)
    return trusted(Certificate, proof | {"validity": _VALIDITIES[proof["validity"]], "_of": core})


find_late(Certificate, reason=lambda proof: in_words(_core.describe_proof(**vars(proof))))
