"""Many motions as arrays over the axes of their scenes, and as tables of xarray and pandas."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ... import _core
from ..._ask.check import FloatArray, choice, shown
from ..._ask.scene import SCENE_UNITS
from ..._motion.export.tables import attributes, required
from ..._motion.quantities import MODE, QUANTITIES, TIME
from ..._motion.status import STATUSES, IntegrationError
from ..._motion.trajectory import Trajectory
from .answers import AT_AN_END, MODELS, REFUSED, Request, Tables, answers, columns
from .asked import BLOW, NAMES, name_of, scenes_of

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

DIRECT = ("theta", "omega", "x")  # in this order in the tables of all models
_STORED = {"rolling": DIRECT, "contact": _core.COLUMNS["contact"], "multipliers": DIRECT}
_TOUCH = set(_STORED["contact"]) - set(DIRECT)  # cheap for rolling, too
_KNOWN = {each.name: each for each in (*QUANTITIES, MODE)}
_HELD = {code for code, each in STATUSES.items() if each in AT_AN_END}
_LOST = max(STATUSES) + 1  # the ending of a scene whose worker was lost
_ENDINGS = {REFUSED: "REFUSED", **{k: each.name for k, each in STATUSES.items()}, _LOST: "LOST"}
_UNITS = SCENE_UNITS | _core.FIELDS["Impulse"]


class MotionArrays(dict[str, FloatArray]):
    """Quantities of many motions by name: arrays of the shape of the scenes, then of the times.

    They are NaN where a scene has no motion, and after an early end.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times [s].
    axes : tuple of str
        Names of the axes of the scenes: of the argument that alone varies along it (``omega0`` for
        the start omega, and so on), else ``scene``, or ``scene_0``, ``scene_1``.
    status : ndarray of str
        Names of `Status`, or REFUSED, or LOST with its worker, in the shape of the scenes.
    errors : dict
        The exceptions in the list of `simulate_many`, by the index of the scene, a tuple.
    """

    t: FloatArray
    axes: tuple[str, ...]
    status: npt.NDArray[np.str_]
    errors: dict[tuple[int, ...], Exception]
    _scenes: FloatArray

    def __init__(self, values: dict[str, FloatArray], **about: Any) -> None:
        super().__init__(values)
        vars(self).update(about)

    def __repr__(self) -> str:
        sizes = zip((*self.axes, "t"), (*self.status.shape, self.t.size), strict=True)
        over = ", ".join(f"{axis} {size}" for axis, size in sizes)
        counts = ", ".join(f"{n} {name}" for name, n in Counter(self.status.flat).items())
        return f"<MotionArrays {', '.join(self)} over {over}: {counts or 'no scenes'}>"

    def to_xarray(self) -> Dataset:
        """Return an xarray Dataset over the axes of the scenes and t, with ``status``.

        Arguments of the scenes that vary are coordinates, the others are in ``attrs``.

        Raises
        ------
        ImportError
            Without xarray: it comes with ``rolling_ellipse[data]``.
        """
        found: Dataset = required("xarray", "to_xarray").Dataset(
            {"status": (self.axes, self.status)},
            {"t": ("t", self.t, attributes(TIME))},
        )
        for name, values in self.items():
            found[name] = (*self.axes, "t"), values, attributes(_KNOWN[name])
        for argument, column in zip((*NAMES, *BLOW), self._scenes.T, strict=True):
            name, grid = name_of(argument), column.reshape(self.status.shape)
            along = [axis for k, axis in enumerate(self.axes) if axis == name or _varies(grid, k)]
            if along:
                place = tuple(slice(None) if axis in along else 0 for axis in self.axes)
                found.coords[name] = along, grid[place], {"units": _UNITS[argument] or "1"}
            elif column.size and not np.isnan(column[0]):
                found.attrs[name] = float(column[0])
        return found

    def to_dataframe(self) -> DataFrame:
        """Return `to_xarray` as a pandas DataFrame: a row for each scene and time."""
        found = self.to_xarray()
        frame: DataFrame = found.to_dataframe()
        frame.attrs = dict(found.attrs)
        return frame


def _varies(grid: FloatArray, axis: int) -> bool:
    first = grid.take([0], axis) if grid.size else grid
    return not bool(((grid == first) | (np.isnan(grid) & np.isnan(first))).all())


def names_in(returns: Any) -> tuple[str, ...]:
    """Return the names of quantities in an argument ``returns``."""
    if not isinstance(returns, Iterable):
        raise TypeError(f"returns must be names of quantities, got {shown(returns)}")
    names = (returns,) if isinstance(returns, str) else returns
    return tuple(choice("returns", name, tuple(_KNOWN)) for name in names)


def gathered(
    names: tuple[str, ...],
    request: Request,
    parts: Iterable[tuple[FloatArray, Tables | Exception]],
    axes: tuple[str, ...],
    shape: tuple[int, ...] | None,
) -> MotionArrays:
    """Return quantities of tables of scenes, each with its answers or the loss of its worker.

    A shape of None is that of a list.
    """
    rows, endings = [np.empty((0, len(_UNITS)))], [np.empty(0)]
    blocks = [np.empty((len(names), 0, request.times.size))]
    failed: dict[int, Exception] = {}
    begin = 0
    for table, tables in parts:
        n = len(table)
        block = np.full((len(names), n, request.times.size), np.nan)
        if isinstance(tables, Exception):
            failed.update(dict.fromkeys(range(begin, begin + n), tables))
            endings.append(np.full(n, _LOST))
        else:
            filled = _fill(dict(zip(names, block, strict=True)), request, table, tables)
            failed.update((begin + place, error) for place, error in filled)
            endings.append(columns("codes", tables)["ending"])
        rows.append(table)
        blocks.append(block)
        begin += n
    shape = (begin,) if shape is None else shape
    codes = np.searchsorted(list(_ENDINGS), np.concatenate(endings))
    values = np.concatenate(blocks, 1).reshape(len(names), *shape, request.times.size)
    return MotionArrays(
        dict(zip(names, values, strict=True)),
        t=request.times,
        axes=axes,
        status=np.array(list(_ENDINGS.values()))[codes].reshape(shape),
        errors={tuple(map(int, np.unravel_index(i, shape))): each for i, each in failed.items()},
        _scenes=np.concatenate(rows),
    )


def _fill(
    values: dict[str, FloatArray], request: Request, table: FloatArray, tables: Tables
) -> Iterator[tuple[int, Exception]]:
    """Fill in the samples of each scene, and yield the exceptions with their places."""
    code = columns("codes", tables)
    reached = np.arange(request.times.size) < code["samples"][:, None]
    q, q_dot = tables["q"], tables["q_dot"]
    stored: dict[str, Any] = {**tables, "multipliers": (q[:, 2], q_dot[:, 2], q[:, 0])}
    for model, names in _STORED.items():
        here = reached & (code["model"] == MODELS.index(model))[:, None]
        for name, row in zip(names, stored[model], strict=True):
            if name in values:
                values[name][here] = row
    others = values.keys() - set(DIRECT)
    if others & _TOUCH and MODELS.index("multipliers") not in code["model"]:
        _fill_rolling({name: values[name] for name in others & _TOUCH}, table, tables)
        others -= _TOUCH
    failed = request.raise_on_failure and not set(code["ending"]) <= _HELD
    if others or failed or REFUSED in code["ending"]:
        for place, found in enumerate(answers(request, scenes_of(table), tables)):
            motion = found.trajectory if isinstance(found, IntegrationError) else found
            if isinstance(motion, Trajectory):
                for name in others:
                    values[name][place, : motion.t.size] = getattr(motion, name)
            if isinstance(found, Exception):
                yield place, found


def _fill_rolling(values: dict[str, FloatArray], table: FloatArray, tables: Tables) -> None:
    """Fill in what `Trajectory` finds at the contact of bodies that only roll."""
    code, (theta, omega, _) = columns("codes", tables), tables["rolling"]
    samples = np.where(code["model"] == MODELS.index("rolling"), code["samples"], 0)
    places, begin = np.flatnonzero(samples), 0
    for place, scene in zip(places, scenes_of(table[places]), strict=True):
        part = slice(begin, begin := begin + samples[place])
        found = _core.rolling_contact(scene.core, theta[part], omega[part])
        for name, filled in values.items():
            filled[place, : samples[place]] = found[name]
