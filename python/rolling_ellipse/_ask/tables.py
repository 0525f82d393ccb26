"""Tables of text, as trackers, spreadsheets and simulators write them."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from .check import readable


class Row(NamedTuple):
    """A row of a table: the number of its first line, and why it is unreadable, if it is."""

    line: int
    fields: list[str]
    fault: str = ""

    def wrong(self, columns: int) -> str:
        """Return what is wrong with a row of a table with so many columns, or an empty text."""
        if self.fault:
            return f"line {self.line} must have quotes in pairs and short fields, got {self.fault}"
        if any(self.fields[columns:]):
            need, count = f"line {self.line} must have {columns} fields", len(self.fields)
            return f"{need}, got {count}; a decimal comma needs quotes or another delimiter"
        return ""

    def entries(self, names: list[str]) -> dict[str, str]:
        """Return the fields by column, empty for a short row; the first of equal names counts."""
        fields = [*self.fields, *[""] * len(names)]
        return {name: fields[names.index(name)] for name in names}


def lines_in(name: str, table: Any) -> list[str]:
    """Return the lines of a path or file in UTF-8, or in cp1252, which spreadsheets write."""
    content = table.read() if hasattr(table, "read") else Path(readable(name, table)).read_bytes()
    if isinstance(content, str):
        return content.removeprefix("\ufeff").splitlines()
    for encoding in ("utf-8-sig", "cp1252"):
        with suppress(UnicodeDecodeError):
            if "\0" not in (text := content.decode(encoding)):
                return text.splitlines()
    raise ValueError(f"{name} must be text in UTF-8, got {table} in UTF-16 or another encoding")


def rows_in(lines: list[str], delimiter: str) -> Iterator[Row]:
    """Yield the rows that are not blank; after an unreadable row, resume one line below its first.

    A quoted field may extend over several lines.
    """
    done = 0
    while done < len(lines):
        above = done
        reader = csv.reader(lines[above:], delimiter=delimiter, strict=True, skipinitialspace=True)
        try:
            for fields in reader:
                if len(fields) > 1 or "".join(fields).strip():
                    yield Row(done + 1, [*map(str.strip, fields)])
                done = above + reader.line_num
        except csv.Error as error:
            done += 1
            yield Row(done, [], str(error))


def require_fields(name: str, rows: list[Row], columns: int, table: Any) -> None:
    """Raise ValueError if a row of a table is unreadable, or has more fields than columns."""
    for row in rows:
        if wrong := row.wrong(columns):
            raise ValueError(f"{name} must be a table, but in {table} {wrong}")
