"""Parts of pages between two marks, and tables in Markdown."""

import re
from collections.abc import Iterable, Sequence
from typing import Any


def with_part(page: str, name: str, made: str, maker: str) -> str:
    """Return a page with the text between the marks of a part replaced."""
    mark = f"<!-- {name}: made by docs/makers/{maker} -->\n"
    part = re.compile(f"({mark}).*?(<!-- end of {name} -->\n)", re.DOTALL)
    page, count = part.subn(lambda found: found[1] + made + found[2], page)
    if count != 1:
        raise ValueError(f"the page must have one {mark!r} with its end, got {count}")
    return page


def table(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(map(str, line))} |\n" for line in lines)
