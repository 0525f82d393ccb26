"""Values as text, and tables as text and as HTML without fixed colours."""

from __future__ import annotations

import codecs
import enum
import importlib
import sys
from collections.abc import Iterable, Sequence
from dataclasses import fields
from typing import Any, ClassVar, TypeVar
from unicodedata import digit, normalize

import numpy as np

from .._core import EventKind, Mode, Outcome, Validity

Row = tuple[str, ...]
# For each unit of length: the smallest body for which it is used [m], units per metre, and name
_LENGTHS = (500.0, 1e-3, "km"), (0.05, 1.0, "m"), (5e-5, 1e3, "mm"), (0.0, 1e6, "µm")
_Enum = TypeVar("_Enum", bound=type[enum.Enum])


def _dotted(value: enum.Enum) -> str:
    return f"{type(value).__name__}.{value.name}"


def _formatted(value: enum.Enum, spec: str) -> str:
    """Format an enum by its code for a number format (``f"{mode:d}"``), otherwise by its name."""
    return format(value.value, spec) if spec[-1:] in tuple("bdoxX") else format(str(value), spec)


def equal_to_names(kind: _Enum) -> _Enum:
    """Make the members of an enum compare equal to their names; their hashes do not change."""
    same, differs = kind.__eq__, kind.__ne__

    def equal(member: Any, other: object) -> bool:
        return member._name_ == other if isinstance(other, str) else same(member, other)

    def unequal(member: Any, other: object) -> bool:
        return member._name_ != other if isinstance(other, str) else differs(member, other)

    about = "A member equals its name, a str"
    if issubclass(kind, int):
        about += ", and its code. It hashes like its code: look it up in dicts by code, not by name"
    faces = {"__eq__": equal, "__ne__": unequal, "__doc__": f"{kind.__doc__}\n\n{about}."}
    for name, face in faces.items():
        setattr(kind, name, face)
    return kind


# These enums print as Kind.NAME; by default lists show <Kind.NAME: 1>, and an IntEnum prints as 1
for _kind in (EventKind, Mode, Outcome, Validity):
    equal_to_names(_kind)
    for _name, _face in {"__repr__": _dotted, "__str__": _dotted, "__format__": _formatted}.items():
        setattr(_kind, _name, _face)


_IN_ASCII = {
    "→": "->", "…": "...", "±": "+/-", "×": "x", "µ": "u", "−": "-", "–": "-", "≈": "~", "′": "'",
    "θ": "theta", "ψ": "psi", "λ": "lambda", "π": "pi", "∞": "inf", "\u0301": "", "\u0307": "_dot",
    "\u0308": "_ddot", **{each: f"^{digit(each)}" for each in "¹²³⁴⁵⁶⁷⁸⁹"},
}  # fmt: skip


def _without_code(error: UnicodeError) -> tuple[str, int]:
    """Handle a codec error: return ASCII for the characters that cannot be encoded."""
    assert isinstance(error, UnicodeEncodeError)
    lost = normalize("NFD", error.object[error.start : error.end])
    return "".join(_IN_ASCII.get(each, ascii(each)[1:-1]) for each in lost), error.end


codecs.register_error("rolling_ellipse", _without_code)


def printable(text: str) -> str:
    """Return the text with ASCII in place of characters that standard output cannot encode.

    On an ASCII, Latin-1 or cp1252 console, printing an arrow would raise an error.
    """
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    return text.encode(encoding, "rolling_ellipse").decode(encoding)


def brief(value: Any) -> str:
    """Return a value as text: floats to six digits, enums by name, arrays by size."""
    if isinstance(value, enum.Enum):
        return value.name
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, np.ndarray):
        return f"{value.size} values"
    if isinstance(value, tuple):
        return ", ".join(map(_range, value)) or "none"
    return "none" if value is None else str(value)


def _range(ends: Any) -> str:
    return " to ".join(map(brief, ends)) if isinstance(ends, tuple) else brief(ends)


def with_unit(value: Any, unit: str) -> str:
    """Return `brief` of a value, with its unit unless the value is None or an empty tuple."""
    missing = value is None or (isinstance(value, tuple) and not value)
    return brief(value) if missing else f"{brief(value)} {unit}".rstrip()


def length_unit(size: float) -> tuple[float, str]:
    """Return the unit for lengths of about `size` [m]: units per metre, and its name."""
    return next((per_metre, name) for least, per_metre, name in _LENGTHS if size >= least)


def text_table(rows: Sequence[Row]) -> str:
    """Return rows with the same number of cells as text with aligned columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ("  ".join(map(str.ljust, row, widths)) for row in rows)
    return "\n".join(line.rstrip() for line in lines)


def html_table(caption: str, rows: Iterable[Row], head: Row = ()) -> str:
    """Return an HTML table without fixed colours; the first cell of each row is a heading.

    All text is escaped.
    """
    from html import escape  # imported here because it loads slowly

    parts = ["<table>", f"<caption>{escape(caption)}</caption>"]
    if head:
        parts.append("<thead><tr>" + "".join(f"<th>{escape(cell)}</th>" for cell in head))
        parts.append("</tr></thead>")
    parts.append("<tbody>")
    for name, *cells in rows:
        body = "".join(f'<td style="text-align:left">{escape(cell)}</td>' for cell in cells)
        parts.append(f'<tr><th style="text-align:left">{escape(name)}</th>{body}</tr>')
    return "".join([*parts, "</tbody></table>"])


class Listed:
    """Base class of dataclasses that print as a table of fields: names, values and units."""

    _units: ClassVar[dict[str, str]] = {}

    def _rows(self) -> list[Row]:
        values = ((field.name, getattr(self, field.name)) for field in fields(self))  # type: ignore[arg-type]
        return [(name, with_unit(value, self._units.get(name, ""))) for name, value in values]

    def __str__(self) -> str:
        return printable(f"{type(self).__name__}\n{text_table(self._rows())}")

    def _repr_html_(self) -> str:
        return html_table(type(self).__name__, self._rows())


def required(package: str, method: str, extra: str = "data") -> Any:
    """Import and return an optional package; the ImportError names the extra that installs it."""
    try:
        return importlib.import_module(package)
    except ModuleNotFoundError as error:
        raise ImportError(
            f"{method} needs {package}: pip install 'rolling_ellipse[{extra}]'"
        ) from error
