"""Methods that other modules add to Trajectory behave as if the class defined them.

Tests of their modules check their results; these tests check that users and programs find them.
"""

import ast
import inspect
import pickle
import pydoc
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import rolling_ellipse as rl
from rolling_ellipse import Trajectory
from rolling_ellipse._motion import methods, trajectory
from rolling_ellipse._motion.methods import METHODS

NAMES = [name for names in METHODS.values() for name in names]


def declared() -> Iterator[str]:
    """The names in the part of the class that only type checkers read."""
    source = Path(trajectory.__file__ or "").read_text(encoding="utf-8")
    (body,) = (
        each.body
        for each in ast.parse(source).body
        if isinstance(each, ast.ClassDef) and each.name == "Trajectory"
    )
    for part in body:
        if isinstance(part, ast.If):
            for each in (found for line in part.body for found in ast.walk(line)):
                if isinstance(each, ast.FunctionDef):
                    yield each.name
                elif isinstance(each, ast.Name) and isinstance(each.ctx, ast.Store):
                    yield each.id


def test_type_checkers_know_every_bound_method() -> None:
    assert sorted(declared()) == sorted(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_each_bound_method_has_its_name(name: str) -> None:
    """help, Jupyter and pickles of bound methods find each method by its name."""
    method, motion = getattr(Trajectory, name), rl.simulate(rl.scenes.drop, 1.0)
    assert name in dir(motion) and inspect.isroutine(method) and method.__name__ == name
    assert inspect.getdoc(method) or name.startswith("_")
    parameters = list(inspect.signature(method).parameters)
    bound = list(inspect.signature(getattr(motion, name)).parameters)
    assert bound == (parameters if name in ("load", "from_arrays") else parameters[1:])
    assert pickle.loads(pickle.dumps(getattr(motion, name))).__name__ == name


def test_tab_completion_shows_only_what_is_meant_for_users() -> None:
    shown = {name for name in dir(rl.simulate(rl.scenes.drop, 1.0)) if name[0] != "_"}
    stored = {"computed", "kept_events", "contact", "coordinates", "span", "start", "settings"}
    assert not stored & shown and set(NAMES) - {"_repr_html_"} < shown


def test_help_lists_the_bound_methods() -> None:
    told = pydoc.plain(pydoc.render_doc(Trajectory))
    for name in ("plot", "animate", "when", "to_dataframe", "load"):
        assert f"\n |  {name}(" in told, name


def test_a_subclass_inherits_and_overrides_the_methods(tmp_path: Path) -> None:
    class Named(Trajectory):
        def at(self, t: float) -> rl.Sample:
            return super().at(t / 2)

    motion = rl.simulate(rl.scenes.rocking, 2.0)
    named = Named(**motion.__getstate__())
    assert named.at(2.0) == motion.at(1.0) == Trajectory.at(named, 1.0)
    motion.save(tmp_path / "motion.npz")
    again = Named.load(tmp_path / "motion.npz")
    assert type(again) is Named and type(Trajectory.load(tmp_path / "motion.npz")) is Trajectory
    assert np.array_equal(again.theta, motion.theta)


def test_matplotlib_is_loaded_only_when_a_picture_is_requested() -> None:
    script = (
        "import sys, rolling_ellipse as rl; motion = rl.simulate(rl.scenes.rocking, 1.0);"
        "dir(motion), repr(motion), vars(rl.Trajectory), motion.at(1.0), motion._repr_html_();"
        "assert {'plot', 'animate', '__version__'} <= set(dir(rl));"
        "assert 'matplotlib' not in sys.modules; motion.plot;"
        "assert 'matplotlib' in sys.modules and rl.Trajectory.plot is rl.plot"
    )
    subprocess.run([sys.executable, "-c", script], check=True, timeout=300)


def test_the_cause_of_an_unavailable_value_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    """A broken matplotlib, or an error in a derived array, is not a missing attribute."""
    motion = rl.simulate(rl.scenes.rolling, 1.0)
    monkeypatch.setattr(methods, "import_module", lambda *_: np.no_such_name)  # type: ignore[attr-defined]
    monkeypatch.setattr(Trajectory, "plot", methods._Later(Trajectory, "_pictures", "plot"))
    monkeypatch.setattr(trajectory, "details", lambda _: np.no_such_name)  # type: ignore[attr-defined]
    for name in ("plot", "q", "psi"):
        with pytest.raises(AttributeError, match="'numpy' has no attribute 'no_such_name'"):
            getattr(motion, name)
    with pytest.raises(AttributeError, match="a Trajectory has no attribute 'plott'"):
        _ = motion.plott  # type: ignore[attr-defined]
