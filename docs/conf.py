"""Settings of the site: python -m sphinx docs OUT, after pip install '.[docs]'; no network."""

import re
from importlib.metadata import version as installed
from pathlib import Path
from shutil import copytree, rmtree

from sphinx.application import Sphinx

HERE = Path(__file__).parent
LIVE = HERE / "live"  # a page of its own, copied as it is; the page `explore` shows it
rmtree(HERE / "notebooks", ignore_errors=True)
copytree(HERE.parent / "notebooks", HERE / "notebooks")  # git ignores it

project, author, language = "rolling_ellipse", "The rolling_ellipse developers", "en"
copyright = author
release = version = installed("rolling-ellipse")
extensions = ["myst_nb", "numpydoc", "sphinx.ext.autodoc", "sphinx-mathjax-offline"]
exclude_patterns, nb_execution_mode = ["live", "_build"], "off"
myst_enable_extensions, myst_heading_anchors = ["dollarmath"], 3
autodoc_member_order, default_role = "bysource", "py:obj"  # names in backticks are links
autodoc_typehints = "none"  # the docstrings have the types, with shapes and units
autodoc_default_options = {"members": True}
numpydoc_show_class_members = False
python_maximum_signature_line_length = 90
html_theme, html_title, pygments_dark_style = "furo", "rolling_ellipse", "github-dark"
templates_path, html_static_path = ["_templates"], ["_static"]
html_css_files, html_js_files = ["site.css"], ["site.js"]
html_show_search_summary = False  # it reads pages, which a browser forbids from files


def lead_to_copies(app: Sphinx, page: str, text: list[str]) -> None:
    text[0] = re.sub(r"(\]\((?:\.\./)*)\.\./notebooks/", r"\1notebooks/", text[0])


def setup(app: Sphinx) -> None:
    app.connect("source-read", lead_to_copies)
    if LIVE.is_dir():
        app.tags.add("live")
        copytree(LIVE, Path(app.outdir) / "live", dirs_exist_ok=True)
