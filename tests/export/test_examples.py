"""`examples` writes what the package carries: notebooks without outputs, and tables."""

from pathlib import Path
from typing import Any

import nbformat
import pytest
import rolling_ellipse as rl
from nbclient import NotebookClient
from oracles.paths import ROOT
from rolling_ellipse import _core
from rolling_ellipse.__main__ import main

NOTEBOOKS = {path.name: path for path in (ROOT / "notebooks").glob("*.ipynb")}
TABLES = {path.name: path for path in (ROOT / "reference").glob("*.csv")}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("new") / "examples"
    assert len(rl.examples(folder)) == len([*folder.rglob("*.*")])
    return folder


def test_they_are_those_of_the_sources(written: Path) -> None:
    assert {path.name for path in written.glob("*.ipynb")} == NOTEBOOKS.keys()
    for name, source in NOTEBOOKS.items():
        ours, theirs = nbformat.read(written / name, 4), nbformat.read(source, 4)
        assert [cell.source for cell in ours.cells] == [cell.source for cell in theirs.cells]
        assert not any(cell.get("outputs") or cell.get("execution_count") for cell in ours.cells)
    assert {path.name for path in (written / "reference").iterdir()} == TABLES.keys()
    for name, source in TABLES.items():
        assert (written / "reference" / name).read_bytes() == source.read_bytes()
    assert Path(str(_core.__file__)).with_name("examples.zip").stat().st_size <= 450_000


def test_a_notebook_runs_where_nothing_else_is(written: Path) -> None:
    notebook = nbformat.read(written / "01_first_roll.ipynb", 4)
    NotebookClient(notebook, timeout=600, resources={"metadata": {"path": str(written)}}).execute()
    assert any(cell.get("outputs") for cell in notebook.cells)


def test_nothing_is_overwritten(tmp_path: Path, capsys: Any) -> None:
    assert main(["examples", str(tmp_path)]) == 0 and rl.examples(tmp_path) == []
    run, gone = tmp_path / "01_first_roll.ipynb", tmp_path / "reference" / "well_reference.csv"
    run.write_text("mine")
    gone.unlink()
    assert main(["examples", str(tmp_path)]) == 2 and run.read_text() == "mine"
    assert "folder must not have another 01_first_roll.ipynb, got " in capsys.readouterr().err
    assert not gone.exists()
    run.unlink()
    assert sorted(rl.examples(tmp_path)) == sorted([run, gone])
