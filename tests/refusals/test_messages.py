"""Every refusal names its argument and shows the value or its fault.

No refusal is missing from the tables: every `raise` of the package must be in the traceback of some
exception, and every text of the core in some message. Refusals that no call can reach are listed
here with their reasons.
"""

import ast
import importlib
import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

import pytest
import rolling_ellipse
from matplotlib import pyplot
from oracles.paths import ROOT

from refusals import Row

ROOMS = (
    "ask", "core", "functions", "trajectory", "files", "batches", "races", "report", "pictures",
    "command_line", "benchmark",
)  # fmt: skip
TABLE: list[Row] = [
    row for room in ROOMS for row in importlib.import_module(f"refusals.{room}").REFUSALS
]
PACKAGE = Path(rolling_ellipse.__file__).resolve().parent
#: Functions of the package that raise exceptions on behalf of their callers.
REQUIRE = ("require", "_refuse", "_refuse_scenes")
#: Functions and exceptions of the core whose arguments are texts of a message.
THROW = re.compile(r"\b(?:refuse|std::(?:invalid_argument|logic_error|runtime_error))\(")

#: Parts of refusals that no call can reach, with the reasons.
UNREACHABLE: dict[str, str] = {
    "trajectory must have finite samples": "pictures refuse what is too far away before",
    "there is no integrator for the method '": "settings refuse such a method before",
    "t must be empty, for the motion ended before it began: ": "no slide is known that is too quick"
    " for its first piece since angles below 1e-100 are none to endless friction",
    # texts that a race stores as the reason why a run has no answer
    "flow must be given a scene that rolls": "a reason",
    "raise IntegrationError(motion)": "a reason",
    'NotImplementedError("': "a reason",
    "it returned theta, omega, x": "a reason",
}


#: Possible starts of the last part of a message, which shows the value or its fault.
ENDS = ("got ", ", but ", ": ", " be given", " without a blow")


class Provoked(NamedTuple):
    """An exception, the texts of its chain, and the lines of the package in its tracebacks."""

    error: BaseException | None
    message: str
    lines: set[tuple[str, int]]


def chain(error: BaseException | None) -> Iterator[BaseException]:
    """The exception followed by its causes."""
    while error is not None:
        yield error
        error = error.__cause__ or error.__context__


def places(traceback: TracebackType | None) -> Iterator[tuple[str, int]]:
    while traceback is not None:
        path = Path(traceback.tb_frame.f_code.co_filename)
        if path.is_relative_to(PACKAGE):
            yield path.relative_to(PACKAGE).as_posix(), traceback.tb_lineno
        traceback = traceback.tb_next


def provoked(row: Row, folder: Path) -> Provoked:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rolling_ellipse.ValidityWarning)
        try:
            row[1](folder)
        except (Exception, SystemExit) as error:
            every = list(chain(error))
            lines = {place for each in every for place in places(each.__traceback__)}
            return Provoked(error, "\n".join(map(str, every)), lines)
    return Provoked(None, "nothing was refused", set())


@pytest.fixture(scope="module")
def all_provoked(tmp_path_factory: pytest.TempPathFactory) -> list[Provoked]:
    return [provoked(row, tmp_path_factory.mktemp("refused")) for row in TABLE]


def is_refusal(name: str | type[Exception], found: Provoked) -> bool:
    if not isinstance(name, str):
        return isinstance(found.error, name)
    if found.error is None:
        return False
    said = str(found.error)
    whole = not (said + "_")[len(name)].isidentifier()  # not only the start of a longer name
    begins = said.startswith(name) and whole and " must " in said
    ends = any(end in said for end in ENDS) and len(said) < 1000
    return begins and ends and isinstance(found.error, ValueError | TypeError)


def test_the_message_for_each_invalid_call_names_the_argument(all_provoked: list[Provoked]) -> None:
    wrong = [
        f"{name}: {found.error!r}"
        for (name, _), found in zip(TABLE, all_provoked, strict=True)
        if not is_refusal(name, found)
    ]
    assert wrong == [], "\n".join(wrong)


def test_a_rejected_picture_leaves_no_figure(all_provoked: list[Provoked]) -> None:
    assert all_provoked and pyplot.get_fignums() == []


ours: Any = rolling_ellipse  # Any, because a type checker would reject these calls
HIT = {**dict.fromkeys(("theta", "x_dot", "z_dot", "omega", "friction"), 0.3), "restitution": 0}
AT_REST = ours.simulate(ours.Scene(2.0, 1.0), 1.0)


@pytest.mark.parametrize(
    ("said", "call"),
    [
        ("did you mean restitution?", lambda: ours.Scene(2, 1, e=0.3)),
        ("did you mean friction?", lambda: ours.Scene(2, 1, fricton=0.3)),
        ("did you mean mass?", lambda: ours.scenes.report.replace(m=1.0)),
        ("did you mean step or t?", lambda: ours.simulate(ours.scenes.report, 1.0, dt=0.1)),
        ("did you mean friction?", lambda: ours.simulate_many({"a": 2, "b": 1, "mu": 1}, 1.0)),
        ("called as thresholds(a, b, *, grav", lambda: ours.thresholds(ours.scenes.report)),
        ("called as support(theta, *, a, b)", lambda: ours.geometry.support(0.3, 2, 1)),
        ("did you mean x_dot?", lambda: ours.simulate(ours.scenes.report, 1.0).vx),
        ("did you mean impact?", lambda: ours.simulate(ours.scenes.report, 1.0).when(event="hit")),
        ("mean lift_off?", lambda: ours.simulate(ours.scenes.report, 1.0).when(event="Lift-Off")),
        ("did you mean rk4?", lambda: ours.simulate(ours.scenes.report, 1.0, method="RK-4")),
        ("savefig('st.pdf')", lambda: ours.plot_strobe(AT_REST, "st.pdf")),
        ("a property of the Axes: set it with ax.set(title", lambda: AT_REST.plot(title="x")),
        ("set it with ax.set(xlim=...)", lambda: AT_REST.plot_forces(xlim=(0, 1))),
        ("did you mean color?", lambda: AT_REST.plot_phase(colour="r")),
        ("plot_curves(motion, 'omega')", lambda: AT_REST.plot("omega")),
        ("mean stronge?", lambda: ours.impacts.collide(**HIT, a=1, b=1, law="Strong")),
    ],
)
def test_the_message_for_a_plausible_mistake_says_what_to_use_instead(said: str, call: Any) -> None:
    with pytest.raises((TypeError, AttributeError, ValueError)) as caught:
        call()
    assert said in str(caught.value)


def test_an_option_that_no_artist_has_is_rejected_by_name() -> None:
    with pytest.raises(TypeError, match=r"plot_paths\(\) does not take glow, which no artist has"):
        AT_REST.plot_paths(glow=True)


def raising(path: Path) -> Iterator[tuple[int, int, str]]:
    """First line, last line and text of each statement in a file that raises an exception."""
    source = path.read_text(encoding="utf-8")
    for node in ast.walk(ast.parse(source)):
        raises = isinstance(node, ast.Raise) and node.exc is not None
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func).rpartition(".")[2]
            raises = name in REQUIRE
        if raises:
            text = ast.get_source_segment(source, node) or ""
            yield node.lineno, node.end_lineno or node.lineno, text  # type: ignore[attr-defined]


def test_every_raise_not_listed_as_unreachable_is_reached(all_provoked: list[Provoked]) -> None:
    reached = {place for found in all_provoked for place in found.lines}
    missed = []
    total = 0
    for path in sorted((ROOT / "python" / "rolling_ellipse").rglob("*.py")):
        name = path.relative_to(ROOT / "python" / "rolling_ellipse").as_posix()
        for first, last, text in raising(path):
            total += 1
            if any((name, line) in reached for line in range(first, last + 1)):
                continue
            if not any(text.find(known) >= 0 for known in UNREACHABLE):
                missed.append(f"{name}:{first}: {' '.join(text.split())}")
    assert total > 150  # fewer means that `raising` misses some
    assert missed == [], "\n".join([f"{len(missed)} of {total}", *missed])


def thrown_texts(path: Path) -> Iterator[str]:
    """Texts of the exceptions in a C++ file, with adjacent literals joined."""
    source = path.read_text(encoding="utf-8")
    for found in THROW.finditer(source):
        depth, end = 1, found.end()
        while depth:
            if source[end] == '"':
                end = source.index('"', end + 1)
            depth += {"(": 1, ")": -1}.get(source[end], 0)
            end += 1
        statement = re.sub(r'"\s*"', "", source[found.end() : end])
        yield from re.findall(r'"([^"]*)"', statement)


def test_core_messages_not_listed_as_unreachable_are_reached(all_provoked: list[Provoked]) -> None:
    said = "\n".join(found.message for found in all_provoked)
    missed, total = [], 0
    for path in sorted((ROOT / "src").rglob("*.?pp")):
        for text in thrown_texts(path):
            total += 1
            if text not in said and text not in UNREACHABLE:
                missed.append(f"{path.relative_to(ROOT)}: {text}")
    assert total > 50  # fewer means that the pattern misses some
    assert missed == [], "\n".join([f"{len(missed)} of {total}", *missed])


def test_texts_listed_as_unreachable_exist() -> None:
    sources = "".join(
        path.read_text(encoding="utf-8")
        for folder, kind in (("python", "*.py"), ("src", "*.?pp"))
        for path in (ROOT / folder).rglob(kind)
    )
    for text in UNREACHABLE:
        assert text in sources, text
