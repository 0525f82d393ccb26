"""A scene as text: JSON, and links to the live page."""

import math
import os
import warnings
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from typing import Any

from .. import _core
from .check import double_in, evaluate, finite, positive, readable, shown
from .habits import meant
from .impulse import Impulse

_Given = dict[str, Any]
_VERSION = 1
_NAMES, _BLOW = tuple(_core.FIELDS["Scene"]), tuple(_core.FIELDS["Impulse"])
LINKS = ("#", "http:", "https:", "file:")
_BESIDE = ("t", "blows", "lang")  # other keys of a link: duration and blows of the motion, language
_OLDER = {"k": "inertia", "height": "z", "slip": "x_dot"}  # names in old links, and those in Scene


def to_json(scene: Any) -> str:
    """Return the scene as JSON text; `Scene.from_json` restores it bit for bit.

    The text is a JSON object. It contains the arguments of Scene that are not None, by name and in
    SI units, and ``version``, which is 1. An infinite number is written as ``"inf"``, and the blow
    as an object with the arguments of Impulse.

    Examples
    --------
    >>> text = rl.Scene(2.0, 1.0, mass=10.0, omega=3.2).to_json()
    >>> text[:55]
    '{"version": 1, "a": 2.0, "b": 1.0, "mass": 10.0, "gravi'
    >>> rl.Scene.from_json(text)
    Scene(a=2.0, b=1.0, mass=10.0, omega=3.2)
    """
    from json import dumps  # imported here because json loads slowly

    given = _given(scene)
    endless = {name: "inf" for name, value in given.items() if value == math.inf}
    return dumps({"version": _VERSION, **given, **endless})


def to_link(scene: Any, page: str | os.PathLike[str] = "", *, t: float | None = None) -> str:
    """Return a link that opens the scene in the live page; `Scene.from_json` reads it exactly.

    The link contains the arguments of Scene and of its blow by name. The page omits a blow whose
    components are both zero.

    Parameters
    ----------
    page : str or path
        Address of the page, such as that of ``live/index.html`` in the built site; anything from
        ``#`` on is replaced. Without a page, the link starts with ``#``.
    t : float, optional
        Duration of the motion on the page [s]; None: the page's default.

    Raises
    ------
    ValueError
        If t is not positive and finite.
    TypeError
        If `page` is not text or a path.

    Examples
    --------
    >>> link = rl.scenes.report.to_link("https://pages.example/live/", t=6.0)
    >>> link[:50]
    'https://pages.example/live/#a=2.0&b=1.0&mass=10.0&'
    >>> rl.Scene.from_json(link) == rl.scenes.report
    True
    """
    from urllib.parse import urlencode

    given = _given(scene)
    given |= given.pop("impulse", {}) | ({} if t is None else {"t": positive("t", t)})
    if not isinstance(page, str | os.PathLike):
        raise TypeError(f"page must be text or an os.PathLike, got {shown(page)}")
    return f"{str(page).partition('#')[0]}#{urlencode(given)}"


def _given(scene: Any) -> _Given:
    return {name: value for name, value in asdict(scene).items() if value is not None}


def arguments(source: Any) -> _Given:
    """Return the arguments of Scene that a source of `Scene.from_json` contains."""
    if isinstance(source, os.PathLike):
        with open(readable("source", source), encoding="utf-8-sig", errors="replace") as file:
            source = file.read()
    if not isinstance(source, str):
        raise TypeError(f"source must be text or an os.PathLike, got {shown(source)}")
    text = source.strip()
    if text.startswith("{"):
        return _of_json(text)
    if text.startswith(LINKS):
        return _of_link(text)
    raise ValueError(f"source must be JSON in braces, a link or an os.PathLike, got {shown(text)}")


def _of_json(text: str) -> _Given:
    from json import loads

    try:
        pairs = loads(text, object_pairs_hook=tuple)  # a dict would hide repeated keys
    except (ValueError, RecursionError) as error:
        raise ValueError(f"source must be JSON, got {shown(text)}: {error}") from None
    version = dict(pairs).get("version", _VERSION)
    if type(version) is not int or version != _VERSION:  # a newer version may have other keys
        cure = "newer texts need pip install --upgrade rolling-ellipse"
        raise ValueError(f"version must be {_VERSION}, got {shown(version)}: {cure}")
    given = _known("source", pairs, ("version", *_NAMES, "impulse"), ("version", "a", "b"))
    blow = given.pop("impulse", None)
    if not isinstance(blow, tuple | None):
        raise ValueError(f"impulse must be an object or null, got {shown(blow)}")
    numbers = {name: _number(name, given[name]) for name in _NAMES if name in given}
    if blow is not None:
        struck = _known("impulse", blow, _BLOW)
        numbers["impulse"] = Impulse(**{name: _number(name, struck[name]) for name in struck})
    return numbers


def _of_link(link: str) -> _Given:
    from urllib.parse import parse_qsl

    pairs = parse_qsl(link.partition("#")[2], keep_blank_values=True)
    names, required = [*_NAMES, *_BLOW, *_BESIDE], ["a", "b"]
    if is_older := any(name in _OLDER for name, _ in pairs):
        names = [*(name for name in names if name not in _OLDER.values()), *_OLDER]
        required += ["mass", "theta", "omega", *_OLDER]
    given = _known("source", pairs, names, required)
    if blows := given.get("blows"):  # t, jx, jz, dx, dz of each blow
        message = f"a scene has no blows during its motion: pass {blows} to simulate as blows="
        warnings.warn(message, UserWarning, stacklevel=4)
    numbers = {name: _linked(name, given[name]) for name in given if name not in _BESIDE}
    blow = {name: numbers.pop(name) for name in _BLOW if name in numbers}
    force = [blow[name] for name in ("jx", "jz") if name in blow]
    if any(force) if is_older else force:  # an older link always has jx and jz
        numbers["impulse"] = Impulse(**blow)
    return _of_older(numbers) if is_older else numbers


def _of_older(given: _Given) -> _Given:
    """Convert the numbers of an older link to arguments of Scene, like the page's `sceneOf`."""
    k, height, slip = (given.pop(name) for name in _OLDER)
    a, b = given["a"], given["b"]
    ground = evaluate(_core.support, theta=finite("theta", given["theta"]), a=a, b=b)
    given["inertia"] = None if k == 1 else k * given["mass"] * (a * a + b * b) / 4
    if height > 0:
        return given | {"z": ground + height, "x_dot": slip}
    return given | {"z_dot": None, "x_dot": ground * given["omega"] + slip if slip else None}


def _known(what: str, pairs: Any, names: Sequence[str], required: Sequence[str] = ()) -> _Given:
    """Return pairs of keys and values as a dict; each key must be known and occur only once."""
    given: _Given = {}
    for key, value in pairs:
        if key not in names:
            wrong = f"got {shown(key)}{meant(key, names)}"
            raise ValueError(f"{what} must have keys among {', '.join(names)}, {wrong}")
        if key in given:
            raise ValueError(
                f"{key} must be given once, got {shown(given[key])} and {shown(value)}"
            )
        given[key] = value
    for name in required:
        if name not in given:
            raise ValueError(f"{name} must be given, got {', '.join(given) or 'nothing'}")
    return given


def _number(name: str, value: Any) -> Any:
    """Return None or a number other than NaN; Scene checks whether None is valid."""
    if value == "inf":
        return math.inf
    if value is None or (type(value) in (int, float) and value == value):
        return value
    raise ValueError(f'{name} must be a number or "inf", got {shown(value)}')


def _linked(name: str, text: str) -> Any:
    value: Any = text
    with suppress(ValueError):
        value = double_in(text)
    return _number(name, value)
