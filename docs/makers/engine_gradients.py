"""Write the table of gradients in your_tests.md: python docs/makers/engine_gradients.py

It runs the code of that page for five minutes, with mujoco and mujoco-mjx installed.
"""

import contextlib
import datetime
import io
import re
from importlib.metadata import version
from pathlib import Path

PAGE = Path(__file__).resolve().parents[1] / "your_tests.md"
PACKAGES = ("mujoco", "mujoco-mjx", "jax")


def program(name, page):
    """The code of the page after a mark."""
    return re.findall(rf"<!-- {name} -->\n```python\n(.*?)```", page, re.DOTALL)[0]


def main():
    page = PAGE.read_text(encoding="utf-8")
    names, printed = {}, io.StringIO()
    for name in ("mujoco", "mjx"):  # MJX reports missing packages when it is imported
        exec(program(name, page), names)
    with contextlib.redirect_stdout(printed):
        exec(program("program", page), names)
    stamp = ", ".join(f"{name} {version(name)}" for name in PACKAGES)
    made = f"```text\n{printed.getvalue()}```\n\n{stamp}, {datetime.date.today()}.\n"
    part = re.compile(r"(<!-- gradients: .*?-->\n).*?(<!-- end of gradients -->)", re.DOTALL)
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(part.sub(lambda found: found[1] + made + found[2], page), encoding="utf-8")


if __name__ == "__main__":
    main()
