"""`python -m rolling_ellipse` as users type it, in its own process or through `main`."""

import io
import json
import math
import os
import shlex
import subprocess
import sys
import webbrowser
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib
import pytest

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
import rolling_ellipse as rl
from matplotlib.figure import Figure
from PIL import Image
from rolling_ellipse import __main__ as command_line
from rolling_ellipse.__main__ import main
from rolling_ellipse._command_line import SCENE_OPTIONS
from rolling_ellipse._pictures.animation import film

KEYS = {
    "scene", "start", "model", "method", "status", "message", "reason", "valid_until",
    "smallest_normal_force", "largest_friction_needed", "events", "files", "outcome", "period",
    "distance", "turns", "largest_position_residual", "largest_velocity_residual", "largest_gap",
    "largest_slip",
}  # fmt: skip


class Answer(NamedTuple):
    code: int
    out: str
    err: str


def typed(folder: Path, *arguments: str, **environment: str) -> Answer:
    """Run the command in a separate process, in a folder."""
    return ran(folder, sys.executable, "-m", "rolling_ellipse", *arguments, **environment)


def ran(folder: Path, *command: str, **environment: str) -> Answer:
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=120,
        encoding=environment.get("PYTHONIOENCODING"),
        env=os.environ | {"MPLBACKEND": "Agg"} | environment,
    )  # fmt: skip
    return Answer(done.returncode, done.stdout, done.stderr)


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str], monkeypatch: Any, tmp_path: Path) -> Any:
    """The command in this process, in the folder tmp_path."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> Answer:
        try:
            code = main(list(arguments))
        except SystemExit as stopped:  # argparse raises SystemExit
            code = int(stopped.code or 0)
        captured = capsys.readouterr()
        return Answer(code, captured.out, captured.err)

    yield run
    plt.close("all")


def strict_json(text: str) -> dict[str, Any]:
    """Read JSON by the standard: NaN and Infinity are errors."""

    def refuse(constant: str) -> None:
        raise ValueError(f"{constant} is no JSON")

    found: dict[str, Any] = json.loads(text, parse_constant=refuse)
    return found


def named(text: str) -> dict[str, str]:
    """Names and texts of the lines of a summary; texts start in column 18."""
    return {line[:17].rstrip(): line[18:] for line in text.splitlines()}


# -------------------------------------------------------------------------------- summaries


def test_the_command_without_options_runs_the_report_scene(tmp_path: Path) -> None:
    code, out, err = typed(tmp_path)
    assert (code, err) == (0, "")
    lines = named(out)
    assert list(lines) == [
        "scene", "blow", "start", "reason", "status", "full turn", "distance", "smallest N",
        "largest |F|/N", "residuals",
    ]  # fmt: skip
    trajectory, certificate = rl.simulate(rl.scenes.report, 6.0), rl.certify(rl.scenes.report)
    assert lines["scene"] == "a = 2 m, b = 1 m, mass = 10 kg"
    assert lines["blow"] == "(0, -48) N s at (1.5, 0) m from the centre"
    assert lines["start"] == "on the ground, rolling, omega = 3.2 rad/s after the blow"
    assert lines["reason"] == trajectory.reason and lines["status"].startswith("COMPLETED: ")
    assert lines["full turn"] == f"{rl.period(rl.scenes.report):.12g} s"
    assert lines["distance"].startswith(f"{trajectory.x[-1]:.12g} m in 6 s, ")
    assert lines["distance"].endswith(f", {trajectory.turns[-1]:.6g} turns")
    assert lines["smallest N"] == f"{certificate.smallest_normal_force:.6g} N"
    assert list(tmp_path.iterdir()) == []  # the command writes no file unless asked


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252", "utf-8"])
def test_a_console_of_any_encoding_gets_the_output(encoding: str, tmp_path: Path) -> None:
    """The output has many events, a file name that some consoles cannot show, an accent, and an
    error message."""
    told = {"PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}
    falls = ["--theta", "0.4", "--friction", "0.2", "--omega", "4", "--slope", "0.1"]
    code, out, err = typed(tmp_path, *falls, "--time", "9", "--plot", "θ→.png", **told)
    assert (code, err) == (0, "") and "more events" in out and (tmp_path / "θ→.png").is_file()
    assert ("theta->.png" in out) == (encoding != "utf-8")
    assert typed(tmp_path, "benchmark", "list", **told).code == 0
    code, out, err = typed(tmp_path, "--save", "θ→.nothing", **told)
    assert code == 2 and out == "" and "Traceback" not in err


def test_json_is_printed_on_stdout(tmp_path: Path) -> None:
    code, out, err = typed(tmp_path, "--json")
    assert (code, err) == (0, "")
    found = strict_json(out)
    assert set(found) == KEYS
    trajectory = rl.simulate(rl.scenes.report, 6.0)
    assert found["status"] == "COMPLETED" and found["valid_until"] is None
    assert found["distance"] == trajectory.x[-1] and found["turns"] == trajectory.turns[-1]
    assert found["period"] == rl.period(rl.scenes.report)
    assert found["reason"] == trajectory.reason and found["message"] == trajectory.message
    residuals = trajectory.constraint_residuals()
    for key, name in {"position_residual": "position", "velocity_residual": "velocity",
                      "gap": "gap", "slip": "slip"}.items():  # fmt: skip
        assert found[f"largest_{key}"] == np.max(np.abs(getattr(residuals, name)))


def test_options_change_the_scene_of_the_report(command: Any) -> None:
    """A given speed replaces the blow."""
    options: dict[str, Any] = {
        "a": 3.0, "b": 1.5, "mass": 2.0, "theta": 0.3, "omega": 1.25, "friction": 5.0,
        "restitution": 0.5,
    }  # fmt: skip
    text = [part for name, value in options.items() for part in (f"--{name}", str(value))]
    code, out, _ = command(*text, "--slope", "0", "--time", "2.5", "--json")
    assert code == 0
    found = strict_json(out)
    assert found["scene"] == {**options, "impulse": None}
    scene = rl.Scene(**options)
    trajectory = rl.simulate(scene, 2.5)
    assert found["distance"] == trajectory.x[-1]
    assert found["smallest_normal_force"] == rl.certify(scene).smallest_normal_force
    assert " m in 1.5 s, " in command("--time", "1.5").out and command("--time", "0").code == 0


def test_a_body_with_rolling_resistance_comes_to_rest(command: Any) -> None:
    options = ("--rolling-resistance", "0.05", "--friction", "1", "--time", "100")
    facts = strict_json(command(*options, "--json").out)
    assert [kind for _, kind in facts["events"]] == ["rest"]
    assert facts["scene"]["rolling_resistance"] == 0.05
    assert facts["outcome"] is facts["period"] is None
    assert "none: rolling resistance brings it to rest" in command(*options).out


def test_the_blow_of_the_report_is_kept_unless_a_start_is_given(command: Any) -> None:
    """A lighter body gets the same blow; a speed or another blow replaces it."""
    lighter = rl.scenes.report.replace(mass=8.0)
    found = strict_json(command("--mass", "8", "--json").out)
    assert found["scene"]["impulse"] == {"jx": 0.0, "jz": -48.0, "dx": 1.5, "dz": 0.0}
    assert found["start"]["omega"] == lighter.initial_state.omega == pytest.approx(4.0, rel=1e-15)
    assert found["distance"] == rl.simulate(lighter, 6.0).x[-1]
    same = strict_json(command("--mass", "10", "--json").out)
    assert same == strict_json(command("--json").out)
    turning = strict_json(command("--omega", "3.2", "--json").out)
    assert turning["scene"] == {"a": 2.0, "b": 1.0, "mass": 10.0, "omega": 3.2, "impulse": None}
    assert turning["distance"] == pytest.approx(same["distance"], rel=1e-13)
    assert named(command("--omega", "3.2").out)["blow"] == "none"
    pressed = rl.scenes.report.replace(impulse=rl.Impulse.press(20.0, -1.5), omega=0.5)
    both = strict_json(command("--press", "20", "-1.5", "--omega", ".5", "--json").out)
    assert both["start"]["omega"] == pressed.initial_state.omega
    assert both["distance"] == rl.simulate(pressed, 6.0).x[-1]


def test_a_scene_is_read_from_a_file_a_link_or_standard_input(
    command: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Other options change this scene in the same way as the scene of the report."""
    scene = rl.scenes.drop.replace(x=3.0, impulse=rl.Impulse(jx=0.5, jz=-0.5, dx=0.1))
    (tmp_path / "scene.json").write_text(scene.to_json())
    x = rl.simulate(scene, 1.0).x
    link = "https://pages.example/#a=2&b=1&omega=3.2&friction=0.5&jz=-1&dx=1&t=9&lang=de"
    monkeypatch.setattr("sys.stdin", io.StringIO(scene.to_json() + "\n"))
    facts = [strict_json(command("--scene", given, "--time", "1", "--json").out)
             for given in ("scene.json", str(tmp_path / "scene.json"), "-")]  # fmt: skip
    assert facts[0] == facts[1] == facts[2]
    assert facts[0]["distance"] == x[-1] - x[0] != x[-1]
    linked = rl.Scene.from_json(link)
    for options, expected in (
        ([], linked),
        (["--mass", "2", "--theta", "0.25"], linked.replace(mass=2.0, theta=0.25)),
        (["--omega", "1"], linked.replace(omega=1.0, impulse=None)),
        (["--press", "2", "-1"], linked.replace(impulse=rl.Impulse.press(2.0, -1.0))),
    ):
        found = strict_json(command("--scene", link, *options, "--json").out)
        assert found["distance"] == rl.simulate(expected, 6.0).x[-1], options
    code, _, err = command("--scene", f"{link}&blows=2,0,-1,0,0")
    assert code == 0 and err.startswith("python -m rolling_ellipse: a scene has no blows")
    monkeypatch.setattr("sys.stdin", None)
    assert command("--scene", "-").code == 2


def test_a_blow_that_misses_the_body_is_rejected_with_advice(command: Any) -> None:
    for options in (["--a", "1"], ["--theta", "1.5"]):
        code, out, err = command(*options)
        assert (code, out) == (2, "") and len(err.splitlines()) == 1
        assert "impulse must be along a line that meets the body" in err
        assert err.endswith("got 1.5: give --press F D, or --omega for no blow\n")
    assert command("--a", "1", "--omega", "0").code == 0
    assert "--omega for" not in command("--press", "20", "2.5").err


def test_model_and_method_can_be_chosen(command: Any) -> None:
    options = ["--model", "multipliers", "--method", "rk4", "--step", "0.01", "--time", "1"]
    found = strict_json(command(*options, "--json").out)
    assert (found["model"], found["method"]) == ("multipliers", "rk4")
    motion = rl.simulate(rl.scenes.report, 1.0, model="multipliers", method="rk4", step=0.01)
    assert found["distance"] == motion.x[-1]
    assert found["largest_velocity_residual"] > 0
    lossy = command(*options[:4], "--step", "0.05", "--time", "50", "--json")
    assert lossy.code == 0 and "take smaller steps" in lossy.err and strict_json(lossy.out)
    found = strict_json(command("--model", "contact", "--time", "1", "--json").out)
    assert (found["model"], found["period"]) == ("contact", rl.period(rl.scenes.report))


def test_the_summary_states_when_the_motion_repeats(command: Any) -> None:
    speed = rl.thresholds(2.0, 1.0).roll_over_speed
    slides = "none: it slides, leaves the ground or hits it"
    for options, name, said in (
        ("--omega 3.2", "full turn", f"{rl.period(rl.scenes.rolling):.12g} s"),
        ("--theta .5 --omega 0", "full swing", f"{rl.period(rl.scenes.rocking):.12g} s"),
        ("--a 1 --omega 2", "full turn", f"{math.pi:.12g} s"),
        ("--omega 0", "swing or turn", "none: it rests"),
        (f"--omega {speed!r}", "swing or turn", "none: it reaches the tip in infinite time"),
        ("--omega 5.2", "swing or turn", slides),
        ("--omega 3 --slope .1", "swing or turn", slides),
    ):
        lines = named(command(*options.split(), "--time", "1").out)
        assert lines[name] == said
        assert len({"full turn", "full swing", "swing or turn"} & set(lines)) == 1


def test_written_files_are_listed(command: Any, tmp_path: Path) -> None:
    """A figure without a suffix in its path is a PNG."""
    options = ["--plot", "overview", "--save", "roll.gif", "--time", "0.1"]
    lines = command(*options).out.splitlines()
    written = [line[18:] for line in lines if line.startswith("written")]
    there = sorted(file.name for file in tmp_path.iterdir())
    assert written == there == ["overview.png", "roll.gif"]
    found = strict_json(command(*options, "--json").out)
    assert found["files"] == written and found["status"] == "COMPLETED"
    with Image.open(tmp_path / "overview.png") as picture:
        assert picture.format == "PNG" and min(picture.size) > 300
        assert len(picture.convert("L").getcolors() or []) > 10  # something is drawn
    assert command("--plot", "overview.svg", "--time", "2", "--json").code == 0
    assert "<svg" in (tmp_path / "overview.svg").read_text()


# ------------------------------------------------------------------------------------- explore


@pytest.fixture
def pages(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """List that receives the scenes of written pages and the addresses opened."""
    found: list[Any] = []

    def save(explorer: rl.Explorer, path: str) -> None:
        Path(path).write_text("<html>")
        found.append((explorer.scene, explorer.t_end, explorer.words["lang"]))

    monkeypatch.setattr(rl.Explorer, "save", save)

    def opened(address: str) -> bool:
        found.append(address)
        return True

    monkeypatch.setattr(webbrowser, "open", opened)
    return found


def test_explore_writes_a_page_and_opens_it(
    command: Any, pages: list[Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    code, out, err = command("explore", "--b", "1.5", "--save", "a page.html")
    assert (code, out, err) == (0, f"{'written':<17} a page.html\n", "")
    address = (tmp_path / "a page.html").as_uri()
    assert pages == [(rl.scenes.report.replace(b=1.5), 5.4, "en"), address] and "%20" in address
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "new"))
    (tmp_path / "new").mkdir()
    line = "explore --omega 3 --no-open --time 2 --language de"
    code, out, err = command(*line.split())
    assert (code, err) == (0, "") and len(pages) == 3
    assert pages[2] == (rl.scenes.report.replace(omega=3.0, impulse=None), 2.0, "de")
    (page,) = (tmp_path / "new").glob("*/explore.html")
    assert out == f"{'written':<17} {page}\n"
    monkeypatch.setattr(webbrowser, "open", lambda address: False)
    code, out, err = command("explore", "--save", "page.html")
    assert (code, err) == (0, "") and out.splitlines()[1].startswith("no browser was found")


def test_the_summary_says_where_rolling_ends(command: Any) -> None:
    """A motion whose rolling ends continues: the body slips, jumps and lands."""
    code, out, err = command("--omega", "5.2", "--friction", "1")
    assert (code, err) == (0, "")
    assert "COMPLETED" in out and "rolling is valid up to theta" in out
    assert named(out)["reason"].startswith("It rolls, then it slips at t = ")
    found = strict_json(command("--omega", "5.2", "--friction", "1", "--json").out)
    assert found["status"] == "COMPLETED" and found["valid_until"] is None
    assert [kind for _, kind in found["events"]][:3] == ["slip", "lift_off", "impact"]
    assert "lift_off" in out and found["largest_gap"] < 1e-14  # the gap counts only in contact
    assert found["period"] is None and found["smallest_normal_force"] is None


def test_a_motion_on_a_slope_has_a_summary(command: Any) -> None:
    assert "slope = 0.1 rad" in command("--slope", "0.1", "--omega", "3", "--time", "2").out
    rocks = ("--slope", "0.1", "--omega", "0.5", "--time", "2", "--json")
    found = strict_json(command(*rocks).out)
    assert found["period"] > 0 and found["smallest_normal_force"] > 0
    runs = strict_json(command("--slope", "0.1", "--time", "2", "--json").out)
    assert runs["period"] is None and runs["smallest_normal_force"] is None
    assert runs["distance"] > 0


def test_extreme_motions_still_give_standard_json(command: Any) -> None:
    """JSON has no infinity. Unlimited friction, rest, lost contact and the separatrix lead to
    infinite values."""
    speed = rl.thresholds(2.0, 1.0).roll_over_speed
    for options in (
        "--omega 50", f"--theta {math.pi / 2} --omega 0", "--omega 5.2 --friction 0",
        f"--omega {speed!r}", "--a 1 --b 1 --omega 2",
    ):  # fmt: skip
        assert set(strict_json(command(*options.split(), "--json").out)) == KEYS


# ------------------------------------------------------------------------------ bad input


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ("--a -1", "a must"), ("--a 5000", "a/b must"), ("--theta nan", "theta must"),
        ("--omega -inf", "omega must"), ("--theta -nan", "theta must"), ("--slope 30", "degrees?"),
        ("--time -1", "time"), ("--time inf", "time"), ("--time -1e-3", "--time must"),
        ("--a two", "--a"), ("--time", "--time"), ("--bogus", "--bogus"), ("--press 20", "--press"),
        ("--press -20 1", "--press must have F >= 0, got -20.0"), ("--press nan 1", "F must"),
        ("--press 20 1e400", "d must"), ("--press 20 2.5", "impulse must"),
        ("--model falling", "falling"), ("--method euler", "euler"), ("--step -1", "--step must"),
        ("--method rk4", "--step must be given"), ("--slop 0.1", "--slop"),
        ("--save roll.xyz", "roll.xyz"), ("--plot picture.xyz", "xyz"),
        ("--plot no/such/folder/a.png", "no/such/folder/a.png"),
        ("--save no/such/folder/a.gif", "no/such/folder/a.gif"),
        ("--time --json", "--time"), ("--omega -x", "--omega"), ("-1e-3", "-1e-3"),
        ("--json -1", "-1"), ("explore --a -1", "a must"), ("explore --bogus", "--bogus"),
        ("explore --time 300", "--time must be"), ("explore --press 20", "--press"),
        ("--scene no_such.json", "no_such.json"), ("--scene .", "'.'"), ("--scene", "--scene"),
        ("--scene #a=2&b=1&mu=1", "--scene must have keys among"),
        ("--scene #a=2", "b must be given"),
        ("--scene #a=2&b=1&jz=-1 --a -1", "a must"), ("explore --scene #", "a must be given"),
        ("explore --save no/such/page.html", "page.html"), ("explore --save .", "'.'"),
    ],
)  # fmt: skip
def test_bad_input_gives_one_line_and_exit_code_2(
    command: Any, pages: list[Any], tmp_path: Path, arguments: str, named: str
) -> None:
    code, out, err = command(*arguments.split())
    assert (code, out, pages) == (2, "", [])
    assert named in err and "Traceback" not in err
    assert list(tmp_path.iterdir()) == []
    assert len(err.splitlines()) == 1 and err.endswith("\n"), err


def test_explore_names_the_option_for_a_wrong_suffix(tmp_path: Path) -> None:
    answer = typed(tmp_path, "explore", "--save", "page.txt")
    assert answer.code == 2 and "--save must end in .html" in answer.err


def test_the_installed_command_runs_the_same_function(tmp_path: Path) -> None:
    (script,) = entry_points(group="console_scripts", name="rolling-ellipse")
    assert script.load() is command_line.run
    assert typed(tmp_path, "--version") == Answer(0, f"rolling-ellipse {rl.__version__}\n", "")
    assert typed(tmp_path, "--a", "-1") == Answer(
        2, "", "python -m rolling_ellipse: a must be a positive finite length [m], got -1.0\n"
    )


@pytest.mark.parametrize(
    ("command", "options"),
    [
        ("", ["scene", *SCENE_OPTIONS, "time", "model", "method", "step", "save", "plot", "json"]),
        (" explore", ["scene", *SCENE_OPTIONS, "press", "time", "language", "save", "no-open"]),
    ],
)
def test_help_lists_every_option(tmp_path: Path, command: str, options: list[str]) -> None:
    code, out, err = typed(tmp_path, *command.split(), "--help")
    assert (code, err) == (0, "") and out.startswith(f"usage: python -m rolling_ellipse{command}")
    assert "explore" in out and all(f"--{option.replace('_', '-')}" in out for option in options)


# ----------------------------------------------------------------- numbers, names and pipes


@pytest.mark.parametrize("text", ["-1e-3", "-.5e1", "-2", "-1E-3", "+2", "-0", "-.15E1"])
def test_negative_numbers_are_accepted_as_written(command: Any, text: str) -> None:
    code, out, err = command("--omega", text, "--time", "1", "--json")
    assert (code, err) == (0, "")
    scene = rl.Scene(2.0, 1.0, mass=10.0, omega=float(text))
    assert strict_json(out)["distance"] == rl.simulate(scene, 1.0).x[-1]
    code, out, err = command("--press", "20", text, "--a", "6", "--time", "1", "--json")
    assert (code, err) == (0, "") and strict_json(out)["scene"]["impulse"]["dx"] == float(text)


def test_a_motion_that_stops_early_has_a_summary_and_exit_code_1(tmp_path: Path) -> None:
    options = ["--a", "2", "--b", "1", "--omega", "3", "--friction", ".2", "--restitution", "1"]
    options += ["--time", "100000"]
    code, out, err = typed(tmp_path, *options)
    assert (code, err) == (1, "")
    assert "MAX_EVENTS: max_events = 10000 was reached at t = " in out
    scene = rl.Scene(2.0, 1.0, mass=10.0, omega=3.0, friction=0.2, restitution=1.0)
    reached = rl.simulate(scene, 1e5, raise_on_failure=False)
    assert f"{reached.x[-1]:.12g} m in {reached.t[-1]:g} s, " in out
    code, out, err = typed(tmp_path, *options, "--json")
    assert (code, err) == (1, "")
    found = strict_json(out)
    assert set(found) == KEYS and found["status"] == "MAX_EVENTS"


@pytest.mark.parametrize("option", ["--save", "--plot"])
@pytest.mark.parametrize("name", ["", ".", "folder.gif"])
def test_an_unusable_output_path_is_rejected_before_any_work(
    command: Any, tmp_path: Path, monkeypatch: Any, option: str, name: str
) -> None:
    (tmp_path / "folder.gif").mkdir()
    monkeypatch.setattr(command_line, "simulate", None)
    code, out, err = command(option, name, "--time", "1")
    assert (code, out) == (2, "") and len(err.splitlines()) == 1 and (name or option) in err
    assert [file.name for file in tmp_path.iterdir()] == ["folder.gif"]


@pytest.mark.parametrize("option", ["--save=roll.gif", "--plot=overview.png"])
def test_a_failed_write_leaves_the_old_file(
    command: Any, tmp_path: Path, monkeypatch: Any, option: str
) -> None:
    path = tmp_path / option.split("=")[1]
    path.write_bytes(b"old")

    def fails(*args: Any, **options: Any) -> None:
        for each in args:
            if isinstance(each, Path):
                each.write_bytes(b"half")
        raise OSError("no space left")

    if "plot" in option:
        monkeypatch.setattr(Figure, "savefig", fails)
    monkeypatch.setattr(film, "write_gif", fails)
    code, out, err = command(option, "--time", "0.1")
    assert (code, out, err) == (2, "", "python -m rolling_ellipse: no space left\n")
    assert path.read_bytes() == b"old" and list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("program", "said"),
    [("/no/such/ffmpeg", "No such file"), ("/bin/false", "ffmpeg could not write 'roll.mp4'")],
)
def test_a_broken_ffmpeg_gives_a_one_line_error(tmp_path: Path, program: str, said: str) -> None:
    options = ("--save", "roll.mp4", "--time", "0.1")
    code, out, err = typed(tmp_path, *options, IMAGEIO_FFMPEG_EXE=program)
    assert (code, out) == (2, "") and said in err
    assert len(err.splitlines()) == 1 and list(tmp_path.iterdir()) == []


def shell(folder: Path, command: str) -> Answer:
    """Run a line of bash in which `roll` is the command; the exit code is that of `roll`."""
    roll = f"roll() {{ {shlex.quote(sys.executable)} -m rolling_ellipse --time 1 $*; }}"
    return ran(folder, "bash", "-c", f"{roll}; {command}; exit ${{PIPESTATUS[0]}}")


@pytest.mark.parametrize("options", ["--json", "--help"])
@pytest.mark.parametrize("unbuffered", ["PYTHONUNBUFFERED= ", "PYTHONUNBUFFERED=1 "])
def test_a_closed_pipe_or_a_full_disk_ends_the_command_cleanly(
    tmp_path: Path, options: str, unbuffered: str
) -> None:
    late = f"{{ sleep 0.2; {unbuffered}roll {options}; }} | true"
    assert shell(tmp_path, late) == Answer(141, "", "")
    code, out, err = shell(tmp_path, f"{unbuffered}roll {options} > /dev/full")
    assert (code, out) == (2, "")
    assert err.startswith("python -m rolling_ellipse: ") and "No space left" in err
    assert len(err.splitlines()) == 1


def test_the_command_works_with_closed_streams(tmp_path: Path) -> None:
    assert shell(tmp_path, "roll >&-") == Answer(0, "", "")
    assert shell(tmp_path, "roll --a -1 2>&-") == Answer(2, "", "")


def test_an_interrupted_command_prints_nothing(tmp_path: Path) -> None:
    program = (
        "import os, signal, sys\n"
        "from rolling_ellipse import __main__ as command_line\n"
        "simulate = command_line.simulate\n"
        "def interrupted(*args, **options):\n"
        "    os.kill(os.getpid(), signal.SIGINT)\n"
        "    return simulate(*args, **options)\n"
        "command_line.simulate = interrupted\n"
        "sys.exit(command_line.run())\n"
    )
    assert ran(tmp_path, sys.executable, "-c", program) == Answer(130, "", "")
