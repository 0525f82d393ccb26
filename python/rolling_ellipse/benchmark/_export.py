"""Problems as files for programs in any language."""

from __future__ import annotations

import shutil
from contextlib import suppress
from pathlib import Path
from typing import Any

from .._ask.check import file_name
from ._problem import COLUMNS, FOLDER, problems

_README = """\
<id>.json has a problem and its known answer; <id>.csv waits for your states at its times.
<id>.xml (MJCF) and <id>.sdf have its body and ground. MJCF has no coefficient of restitution:
problems with one between 0 and 1 have no <id>.xml. SDF has no velocities: set them at the start.
Fill the rows of <id>.csv; where you know events, write <id>.events.csv with the columns kind,t.
SI units, radians; x along the ground (downhill), z away from it, theta clockwise.
Then: python -m rolling_ellipse benchmark score <this folder>
"""


def export(folder: Any) -> list[Path]:
    """Write the scored problems, their scenes and empty tables of results into a folder.

    Parameters
    ----------
    folder : path
        Made if it does not exist. A table of results that is there already stays as it is.

    Returns
    -------
    list of Path
        The files written.

    Raises
    ------
    OSError
        If a file cannot be written.
    """
    place = Path(file_name("folder", folder))
    place.mkdir(parents=True, exist_ok=True)
    written = [place / "README.txt"]
    written[0].write_text(_README, encoding="utf-8")
    for one in problems():
        written.append(Path(shutil.copy(FOLDER / f"{one.id}.json", place)))
        for suffix, write in ((".sdf", one.scene.to_sdf), (".xml", one.scene.to_mjcf)):
            with suppress(ValueError):  # coefficients of restitution that MJCF has not
                (place / (one.id + suffix)).write_text(write(), encoding="utf-8")
                written.append(place / (one.id + suffix))
        table = place / f"{one.id}.csv"
        if not table.exists():
            empty = "," * (len(COLUMNS) - 1)
            rows = [",".join(COLUMNS), *(f"{t!r}{empty}" for t in one.output_times.tolist())]
            table.write_text("\n".join(rows) + "\n", encoding="utf-8")
            written.append(table)
    return written
