"""A kernel gives a notebook one output for each film, with or without pyplot's own output."""

import nbclient
import nbformat

CELLS = (
    "%matplotlib inline\nimport rolling_ellipse as rl\nmotion = rl.simulate(rl.scenes.report, 2.0)",
    "rl.animate(motion)",
    "film = rl.animate([motion, motion])\nfilm",
    "rl.explore(rl.scenes.report, t_end=1.0)",
    "import matplotlib.pyplot as plt\nplt.get_fignums()",
)


def test_a_cell_shows_it_once_and_no_figure_is_left() -> None:
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(c) for c in CELLS])
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3").execute()
    for cell in notebook.cells[1:4]:
        (output,) = cell.outputs
        assert output.output_type == "execute_result"
        assert set(output.data) == {"text/html", "text/plain"}
        assert output.data["text/html"].count('class="rolling-ellipse"') == 1
    assert notebook.cells[4].outputs[0].data["text/plain"] == "[]"
