"""What tells the motions of one picture apart, in words."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from .._ask.check import shown
from .._ask.scene import SCENE_UNITS, Impulse, Scene

if TYPE_CHECKING:
    from .._motion.trajectory import Trajectory

MOST_FACTS = 3  # in one label; more would be longer than a small picture is wide


def labels_of(trajectories: Sequence[Trajectory], labels: Sequence[str] | None) -> list[str]:
    """Return one name for each trajectory: the given ones, or what differs among them.

    Without `labels`, a name holds the method, the model and the fields of the scene, as far as
    they differ: "rk4", or "omega = 3.2 rad/s, friction = 0.8". More than three of them end in an
    ellipsis. Where that does not tell all apart, the names are "1", "2", "3"; a single
    trajectory needs no name and has an empty one.

    Raises
    ------
    ValueError
        If there are not as many labels as trajectories, or one is no string.
    """
    if labels is not None:
        return _given(labels, len(trajectories))
    if len(trajectories) == 1:
        return [""]
    facts = [texts for texts in _facts(trajectories) if len(set(texts)) > 1]
    names = [", ".join(parts) for parts in zip(*facts[:MOST_FACTS], strict=True)]
    if len(set(names)) < len(trajectories):
        return [str(i + 1) for i in range(len(trajectories))]
    return [f"{name}, …" if len(facts) > MOST_FACTS else name for name in names]


def _given(labels: Sequence[str], count: int) -> list[str]:
    listed = isinstance(labels, Sequence) and not isinstance(labels, str)
    if not listed or not all(isinstance(label, str) for label in labels):
        raise ValueError(f"labels must be a sequence of strings, got {shown(labels)}")
    if len(labels) != count:
        raise ValueError(
            f"labels must be {count}, one for each trajectory, got {len(labels)}: {shown(labels)}"
        )
    return list(labels)


def _facts(trajectories: Sequence[Trajectory]) -> list[list[str]]:
    """What may differ, most telling first: for each fact, its text for each trajectory."""
    facts: list[list[str]] = [
        [each.method for each in trajectories],
        [each.model for each in trajectories],
    ]
    for field in fields(Scene):
        facts.append(_texts(field.name, [getattr(each.scene, field.name) for each in trajectories]))
    return facts


def _texts(name: str, values: list[Any]) -> list[str]:
    """Texts of one field of several scenes, with the digits that tell its values apart."""
    texts: list[str] = []
    for digits in (6, 12, 17):
        texts = [_text(name, value, digits) for value in values]
        if _distinct(texts) == _distinct(values):
            break
    return texts


def _distinct(values: Sequence[Hashable]) -> int:
    return len(set(values))


def _text(name: str, value: float | Impulse | None, digits: int) -> str:
    def figure(number: float) -> str:
        return f"{number:.{digits}g}".replace("-", "−").replace("inf", "∞")

    if isinstance(value, Impulse):
        push, place = (value.jx, value.jz), (value.dx, value.dz)
        force, lever = (f"({figure(x)}, {figure(z)})" for x, z in (push, place))
        return f"impulse {force} N s at {lever} m"
    if value is None:
        return "no impulse" if name == "impulse" else f"{name} by default"
    return f"{name} = {figure(value)} {SCENE_UNITS[name]}".rstrip()
