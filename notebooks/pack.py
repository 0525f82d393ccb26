"""Pack the notebooks, without outputs, and the tables of reference states into one archive.

CMake runs `pack.py FILE.zip` with a plain Python, for the package's `examples`; the same sources
give the same bits.
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


def main() -> None:
    notebooks = {path.name: without_outputs(path) for path in ROOT.glob("notebooks/*.ipynb")}
    modules = [path for path in ROOT.glob("notebooks/*.py") if path.name != Path(__file__).name]
    files = notebooks | {
        path.relative_to(ROOT).as_posix().removeprefix("notebooks/"): path.read_text("utf-8")
        for path in (*modules, *ROOT.glob("reference/*.csv"))
    }
    with zipfile.ZipFile(sys.argv[1], "w") as archive:
        for name in sorted(files):
            # a ZipInfo has a fixed date
            archive.writestr(zipfile.ZipInfo(name), files[name], zipfile.ZIP_DEFLATED, 9)


if __name__ == "__main__":
    main()
