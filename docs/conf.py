"""Settings of the site. To build it: pip install '.[docs]', then python -m sphinx docs OUT."""

import re
from enum import EnumType
from importlib.metadata import metadata
from pathlib import Path
from runpy import run_path
from shutil import copytree, rmtree
from typing import Any

from sphinx.application import Sphinx

HERE = Path(__file__).parent
rmtree(HERE / "notebooks", ignore_errors=True)  # a copy that git ignores
copytree(HERE.parent / "notebooks", HERE / "notebooks")
run_path(str(HERE / "makers" / "chapters.py"))["split"](HERE / "notebooks" / "02_physics.ipynb")

project, language = "rolling_ellipse", "en"
author = copyright = "The rolling_ellipse developers"
release = version = metadata("rolling-ellipse")["Version"]
extensions = [
    "myst_nb", "numpydoc", "sphinx.ext.autodoc", "sphinx-mathjax-offline", "sphinx_copybutton",
    "matplotlib.sphinxext.plot_directive",
]  # fmt: skip
exclude_patterns, nb_execution_mode = ["live", "_build"], "off"
if "teacher" not in tags:  # noqa: F821 - Sphinx defines it: python -m sphinx -t teacher docs OUT
    exclude_patterns.append("course/teacher.md")
nb_code_prompt_show, nb_code_prompt_hide = "Show the code", "Hide the code"
myst_enable_extensions, myst_heading_anchors = ["dollarmath"], 3
myst_dmath_double_inline = True  # formulas within a paragraph, as Jupyter shows them
myst_html_meta = {"description": metadata("rolling-ellipse")["Summary"]}
copybutton_selector = (
    ".highlight-python pre, .highlight-bash pre, .highlight-pycon pre, .highlight-default pre, "
    ".cell_input pre"
)
copybutton_prompt_text, copybutton_prompt_is_regexp = r">>> |\.\.\. ", True  # not copied
default_role, autodoc_typehints = "py:obj", "none"  # backticks link; docstrings state the types
autodoc_default_options = {  # xp is a module, documented separately
    "members": True, "member-order": "bysource", "exclude-members": "xp"
}  # fmt: skip
numpydoc_show_class_members = False
numpydoc_use_plots = True  # runs examples that use pyplot, and shows their pictures
plot_pre_code = "import numpy as np\nimport rolling_ellipse as rl"
plot_include_source, plot_html_show_formats, plot_html_show_source_link = True, False, False
plot_formats = [("png", 100)]
python_maximum_signature_line_length = 90
html_theme, html_title, pygments_dark_style = "furo", project, "github-dark"
html_logo = html_favicon = "_static/logo.svg"
templates_path, html_static_path = ["_templates"], ["_static"]
html_css_files, html_js_files = ["site.css"], ["site.js"]
html_search_scorer = str(HERE / "scorer.js")
html_show_search_summary = False  # browsers block its requests on pages opened from files


def lead_to_copies(app: Sphinx, page: str, text: list[str]) -> None:
    text[0] = re.sub(r"(\]\((?:\.\./)*)\.\./notebooks/", r"\1notebooks/", text[0])


def keep_pictures_in_the_site(app: Sphinx) -> None:
    """Write the pictures of notebooks to Sphinx's doctree folder, not to one beside the site."""
    folder = str(app.doctreedir / "pictures")
    app.env.mystnb_config = app.env.mystnb_config.copy(output_folder=folder)


def name_modules(app: Sphinx, *of: Any) -> tuple[str, str] | None:
    """Show a module that is a default value by its name, without the path of its file."""
    signature, returned = of[-2:]
    if "<module" not in (signature or ""):
        return None
    return re.sub(r"<module '(\w+)' from [^>]*>", r"\1", signature), returned


def list_sentences(
    app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]
) -> None:
    """Append the members of an enumeration whose values are sentences."""
    if isinstance(thing, EnumType) and all(isinstance(each.value, str) for each in thing):
        for each in thing:
            lines += ["", f"``{each.name}``", f"    {each.value[0].upper()}{each.value[1:]}."]


def setup(app: Sphinx) -> None:
    app.connect("autodoc-process-docstring", list_sentences)
    app.connect("autodoc-process-signature", name_modules, priority=400)  # before numpydoc
    app.connect("source-read", lead_to_copies)
    app.connect("builder-inited", keep_pictures_in_the_site)
    files = Path(app.doctreedir) / "examples"  # files that examples write
    files.mkdir(parents=True, exist_ok=True)
    app.config.plot_working_directory = str(files)
    live = Path(app.outdir) / "live"  # a separate page, which the page `explore` shows in a frame
    live.mkdir(parents=True, exist_ok=True)
    run_path(str(HERE / "makers" / "live.py"))["write"](live / "index.html")
