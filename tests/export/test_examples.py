"""`examples` writes the packaged tables, and the packaged notebooks without their outputs."""

import os
from pathlib import Path

import nbformat
import pytest
import rolling_ellipse as rl
from oracles.paths import ROOT
from rolling_ellipse import _core
from rolling_ellipse.__main__ import main


def test_examples_equal_their_sources(tmp_path: Path) -> None:
    """tests/project/test_notebooks.py runs the notebooks."""
    assert main(["examples", str(tmp_path / "new")]) == 0
    for source, written in {"notebooks": "*.ipynb", "reference": "reference/*.csv"}.items():
        names = {path.name for path in (tmp_path / "new").glob(written)}
        assert names == {path.name for path in (ROOT / source).glob(Path(written).name)} != set()
    for path in (tmp_path / "new" / "reference").iterdir():
        assert path.read_bytes() == (ROOT / "reference" / path.name).read_bytes()
    for path in (tmp_path / "new").glob("*.ipynb"):
        ours, theirs = (nbformat.read(p, 4).cells for p in (path, ROOT / "notebooks" / path.name))
        assert [cell.source for cell in ours] == [cell.source for cell in theirs]
        assert not any(cell.get("outputs") or cell.get("execution_count") for cell in ours)
    assert rl.examples(tmp_path / "new") == []
    assert Path(str(_core.__file__)).with_name("examples.zip").stat().st_size <= 500_000


def test_examples_are_not_written_through_links(tmp_path: Path) -> None:
    """Links to an equal file or to a folder, and a file or a pipe in place of a folder, are
    refused. benchmark/test_result_files.py tests the same function on other links and files."""
    away, empty = tmp_path / "away", tmp_path / "empty"
    rl.examples(away)
    empty.mkdir()
    for name, target in {
        "01_first_roll.ipynb": away / "01_first_roll.ipynb",
        "reference": empty,
    }.items():
        place = tmp_path / f"with {name}"
        place.mkdir()
        (place / name).symlink_to(target)
        with pytest.raises(ValueError, match=rf"folder must contain no other .*{name}"):
            rl.examples(place)
        assert [path.name for path in place.iterdir()] == [name] and not any(empty.iterdir())
    for make in (Path.touch, os.mkfifo):
        make(place / "01_first_roll.ipynb")
        (place / "reference").unlink()
        make(place / "reference")
        with pytest.raises(ValueError, match=r"no other 01_first_roll\.ipynb, reference/\w+\.csv,"):
            rl.examples(place)
        (place / "01_first_roll.ipynb").unlink()
    assert [path.name for path in place.iterdir()] == ["reference"]
