"""The notebooks are small, are committed with their output, and run again without errors."""

import json
from pathlib import Path

import nbformat
import pytest
import rolling_ellipse as rl
from oracles.paths import ROOT

NOTEBOOKS = sorted((ROOT / "notebooks").glob("**/*.ipynb"))
LIMIT = 1_500_000  # bytes; a larger file is slow to open on the web
FOLDED = {"tags": ["hide-input"]}  # on the site the code is shown after a click
WIDTH = 105  # characters of a JupyterLab cell in a window of 1280 pixels


def code_cells(path: Path) -> list[nbformat.NotebookNode]:
    return [cell for cell in nbformat.read(path, 4).cells if cell.cell_type == "code"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_committed_as_it_ran(path: Path) -> None:
    cells = code_cells(path)
    assert [cell.execution_count for cell in cells] == list(range(1, len(cells) + 1))
    outputs = [output for cell in cells for output in cell.outputs]
    assert outputs
    assert not [output for output in outputs if output.output_type == "error"]
    assert not [output for output in outputs if output.get("name") == "stderr"]
    assert path.stat().st_size <= LIMIT


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_has_no_traces_of_a_particular_machine(path: Path) -> None:
    notebook = json.loads(path.read_text(encoding="utf-8"))
    nbformat.validate(notebook)
    assert notebook["metadata"]["kernelspec"]["name"] == "python3"
    assert all(cell["metadata"] in ({}, FOLDED) for cell in notebook["cells"])
    lines = [line for cell in code_cells(path) for line in cell.source.splitlines()]
    assert max(map(len, lines)) <= WIDTH


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_ends_in_an_assertion_that_the_site_folds(path: Path) -> None:
    last = code_cells(path)[-1]
    assert "assert " in last.source and last.metadata == FOLDED


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_has_at_least_four_words_of_text_per_shown_line_of_code(path: Path) -> None:
    cells = nbformat.read(path, 4).cells
    words = sum(len(cell.source.split()) for cell in cells if cell.cell_type == "markdown")
    shown = [cell.source for cell in code_cells(path) if cell.metadata != FOLDED]
    assert sum(len(text.splitlines()) for text in shown) <= words / 4


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_without_an_error(path: Path, tmp_path: Path) -> None:
    """The folder has the files that come with the package, and nothing else."""
    rl.examples(tmp_path)
    notebook = nbformat.read(tmp_path / path.name, 4)
    resources = {"metadata": {"path": str(tmp_path)}}
    # execute raises CellExecutionError with the cell and its traceback
    client = pytest.importorskip("nbclient").NotebookClient
    client(notebook, timeout=600, kernel_name="python3", resources=resources).execute()
    for cell in notebook.cells:  # a film is shown once, without pyplot's own picture of it
        shown = [output.data for output in cell.get("outputs", ()) if "data" in output]
        assert len(shown) == 1 or not any('"rolling-ellipse"' in str(data) for data in shown)
