"""Pack files for the package into an archive: python notebooks/pack.py examples.zip

examples.zip contains the notebooks, without outputs, and the tables of reference states, for
`examples`; course.zip contains the sheets and their pictures, for `course.sheet`. CMake runs this
script, with a Python that may have no packages. The same sources give identical archives.
"""

import json
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def without_outputs(path: Path) -> str:
    notebook = json.loads(path.read_text(encoding="utf-8"))
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            cell |= {"outputs": [], "execution_count": None}
    return json.dumps(notebook, indent=1, ensure_ascii=False) + "\n"


def examples() -> dict[str, str | bytes]:
    notebooks = {path.name: without_outputs(path) for path in ROOT.glob("notebooks/*.ipynb")}
    modules = [path for path in ROOT.glob("notebooks/*.py") if path.name != Path(__file__).name]
    return notebooks | {
        path.relative_to(ROOT).as_posix().removeprefix("notebooks/"): path.read_text("utf-8")
        for path in (*modules, *ROOT.glob("reference/*.csv"))
    }


def course() -> dict[str, str | bytes]:
    return {path.name: path.read_bytes() for path in ROOT.glob("docs/course/[01][0-9]*")}


def main() -> None:
    place = Path(sys.argv[1])
    files = {"examples": examples, "course": course}[place.stem]()
    with zipfile.ZipFile(place, "w") as archive:
        for name in sorted(files):
            # a ZipInfo has a fixed date, unlike a file
            archive.writestr(zipfile.ZipInfo(name), files[name], zipfile.ZIP_DEFLATED, 9)


if __name__ == "__main__":
    main()
