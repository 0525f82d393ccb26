"""Ways to pickle and copy objects, objects to try them on, and the comparison of the results."""

import copy
import dataclasses
import pickle
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import rolling_ellipse as rl


def pickled(protocol: int, thing: Any) -> Any:
    return pickle.loads(pickle.dumps(thing, protocol))


COPIES: dict[str, Callable[[Any], Any]] = {
    **{f"protocol {p}": partial(pickled, p) for p in range(6)},
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}


def require_same(one: Any, other: Any, where: str = "it") -> None:
    """Require the same types and bits in all nested parts, and the same writeable flags."""
    assert type(one) is type(other), where
    if isinstance(one, np.ndarray):
        assert one.dtype == other.dtype and one.shape == other.shape, where
        if one.dtype == object:  # the bytes of such an array are addresses
            assert one.tolist() == other.tolist(), where
        else:
            assert one.tobytes() == other.tobytes(), where
        assert one.flags.writeable == other.flags.writeable, where
    elif dataclasses.is_dataclass(one):
        for field in dataclasses.fields(one):
            name = field.name
            require_same(getattr(one, name), getattr(other, name), f"{where}.{name}")
    elif isinstance(one, (tuple, list)):
        assert len(one) == len(other), where
        for i, (a, b) in enumerate(zip(one, other, strict=True)):
            require_same(a, b, f"{where}[{i}]")
    elif isinstance(one, Exception):
        assert str(one) == str(other) and one.args == other.args, where
        require_same(vars(one), vars(other), where)
    elif isinstance(one, dict):
        assert list(one) == list(other), where
        for key in one:
            require_same(one[key], other[key], f"{where}[{key!r}]")
    elif callable(one):
        require_same(one(), other(), where)
    else:
        assert one == other or (one != one and other != other), where


def fitted() -> rl.impacts.FittedImpacts:
    before = [[0.3, 0.5], [1.0, 0.0], [-2.0, -1.0], [0.0, 0.5]]
    after = rl.impacts.collide(*before, a=2.0, b=1.0, restitution=0.5, friction=0.1)
    return rl.impacts.fit(before, after, a=2.0, b=1.0)


def core_objects() -> dict[str, Any]:
    motion = rl.simulate(rl.scenes.bounce, 1.5)
    return {
        "Scene": motion.scene.core,
        "Impulse": rl.Impulse(jx=1.0).core,
        "Settings": motion.settings.core,
        "Solution": motion._solution,
    }
