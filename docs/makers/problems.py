"""Write a page for each problem of `benchmark`, and a table of the problems; a step of `make.py`.

The pages are docs/problems/<id>.md, each with a picture; the table is for benchmark.md. All numbers
are copied to full precision from python/rolling_ellipse/benchmark/problems.
"""

import json
import math
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import rolling_ellipse as rl
from matplotlib.figure import Figure
from pages import table
from rolling_ellipse import benchmark

DOCS = Path(__file__).resolve().parents[1]
FOLDER = DOCS / "problems"
DATA = DOCS.parent / "python" / "rolling_ellipse" / "benchmark" / "problems"
FIELDS = {  # fields of a scene, with their units
    "a": "m", "b": "m", "mass": "kg", "inertia": "kg m²", "gravity": "m/s²", "slope": "rad",
    "friction": "", "restitution": "", "rolling_resistance": "m", "x": "m", "z": "m",
    "theta": "rad", "x_dot": "m/s", "z_dot": "m/s", "omega": "rad/s",
}  # fmt: skip
STATE = ("x", "z", "theta", "x_dot", "z_dot", "omega")
PHASE = ("brink.back", "brink.over", "roll.rock", "roll.thin")
FORCES = ("roll.resist", "slide.resist", "slide.stick")
ALONG = {"hit.ball": 6.0, "hit.bounce": 6.0, "hit.bounce_flat": 12.0}  # only in pictures [m/s]
SHOWN = {  # number of positions in the picture, and time of the last one [s]
    "hit.ball": (7, None), "hit.bounce": (14, 2.6), "hit.bounce_flat": (13, 2.4228),
    "hit.drop_slip": (6, None), "hit.drop_slip_e": (6, None), "hit.drop_stick": (6, 2.0),
    "hit.settle": (13, None), "law.which": (6, None), "rest.lie": (2, None), "jam": (1, None),
    "leave.slip_then_lift": (11, None), "slide.reverse": (8, None), "slide.slope": (9, None),
}  # fmt: skip
ORDER = ("roll", "brink", "slide", "leave", "hit", "law", "rest", "jam")


def main() -> None:
    from pictures import save  # imported here because tests load this file from another folder

    FOLDER.mkdir(exist_ok=True)
    for name, text in pages().items():
        (FOLDER / f"{name}.md").write_text(text, encoding="utf-8")
        save(picture(name), f"problems/{name}.png")


# ------------------------------------------------------------------------------ text


def problems() -> dict[str, Any]:
    """Return the data of all problems, sorted by family; numbers are strings, as in the files."""
    found = {
        path.stem: json.loads(path.read_text(encoding="utf-8"), parse_float=str, parse_int=str)
        for path in sorted(DATA.glob("*.json"))
    }
    return dict(sorted(found.items(), key=lambda one: ORDER.index(one[0].partition(".")[0])))


def pages() -> dict[str, str]:
    return {name: page(data) for name, data in problems().items()}


def listed() -> str:
    """Return the table of the problems."""
    rows = [
        (f"[`{name}`](problems/{name}.md)", data["question"], ", ".join(data["tags"]),
         data["t_end"], worst(data) if data["scored"] else "not scored")
        for name, data in problems().items()
    ]  # fmt: skip
    head = ("problem", "question", "needs", "T [s]", "largest condition")
    return table(head, rows)


def worst(data: Any) -> str:
    return f"{max(map(float, data['condition'])):.3g}"


def page(data: Any) -> str:
    name, scene = data["id"], data["scene"]
    given = [(f"`{field}`", scene[field], unit) for field, unit in FIELDS.items() if field in scene]
    seen = "angular velocity over angle" if name in PHASE else "the body at equally spaced times"
    seen = "its forces over time" if name in FORCES else seen
    parts = [
        f"# `{name}`: {data['title']}\n\n**{data['question']}**\n\n"
        f"![{data['title']}: {seen}]({name}.png)\n",
    ]
    if name in ALONG:
        parts.append(
            f"(In the picture the body also moves along the ground at {ALONG[name]:g} m/s, which\n"
            "changes nothing else, since there is no friction. In the problem x_dot = 0.)\n"
        )
    parts += [
        "[The benchmark](../benchmark.md) defines frame, units and file format. All numbers"
        " are in\n"
        f"`python/rolling_ellipse/benchmark/problems/{name}.json`.\n",
        f"## Data\n\n{table(('given', 'value', 'unit'), given)}",
        f"A simulator needs: {', '.join(data['tags'])}. The motion ends at {data['t_end']} s.\n",
        f"## Answer\n\n{answer(data)}",
    ]
    if data["events"]:
        rows = [
            (k, event["kind"], event["t"], event["condition"])
            for k, event in enumerate(data["events"], 1)
        ]
        parts.append(table(("", "event", "t [s]", "condition"), rows))
    parts.append(last_state(data))
    if data["scored"]:
        parts.append(error(data))
    for row in data.get("gradients", []):
        parts.append(
            f"## Known derivative\n\nWith respect to `{row['wrt']}`, at t = {row['t']} s:\n\n"
            + table(STATE, [row["value"]])
        )
    return "\n".join(parts)


def answer(data: Any) -> str:
    right = data["answer"]
    if "over" in right:
        passes, turned = (
            ("passes", "exceeds") if right["over"] else ("does not pass", "stays below")
        )
        return (
            f"The body {passes} over the tip. A simulator is right if abs(theta) {turned} pi/2.\n"
        )
    if "half_swings" in right:
        return (
            f"The body comes to rest at x = {right['last']['x']} m, "
            f"theta = {right['last']['theta']} rad, after\n"
            f"{right['half_swings']} swings from one side to the other. A simulator is right if it "
            "ends there, to within\n0.01 L and 0.01 rad, after the same number of swings, and has "
            "these events in this order,\neach at its [time](../benchmark.md#the-score):\n"
        )
    if "last" in right:
        return (
            f"At the end x = {right['last']['x']} m. A simulator is right if its last x is this "
            "value to within 0.01 L.\n"
        )
    if "always" in right:
        return (
            "The body stays. A simulator is right if x stays within 0.01 L of 0, and theta within "
            "0.01 rad.\n"
        )
    if "law" in right:
        return (
            f"Any of the laws {', '.join(right['law'])} is right. The score names the law whose\n"
            "states are nearest, and how many times as far away those of the next law are: this\n"
            "factor must be above 3. The states below follow Stronge's law, as in the package.\n"
        )
    if "status" in right:
        return (
            "Neither sliding nor flight can continue, and rolling would need another velocity.\n"
            "The package ends the motion with the status JAMMED. This problem is not scored.\n"
        )
    if "end" in right:
        return (
            f"The bounces end at {right['end']} s. A simulator is right if it has the first "
            f"{len(right['events'])} of these events,\n"
            "which follow flights higher than 0.002 L, and if its last event, IMPACT or STICK, is\n"
            "at the time of the last event below. The number of impacts in between is not judged.\n"
            "[Times](../benchmark.md#the-score) have a tolerance.\n"
        )
    if not right["events"]:
        return "There is no event. A simulator is right if it has none.\n"
    return (
        "A simulator is right if it has these events, in this order, each at its\n"
        "[time](../benchmark.md#the-score):\n"
    )


def compared(data: Any) -> list[tuple[Any, float]]:
    """Return the rows that are compared, each with its condition number."""
    rows = zip(data["states"], map(float, data["condition"]), strict=True)
    end = float(data["horizon"])
    return [row for row in rows if float(row[0][0]) < end or end == float(data["t_end"])]


def last_state(data: Any) -> str:
    """Return the last compared state to full precision."""
    (row, _), count = compared(data)[-1], len(compared(data))
    named = zip((f"`{name}`" for name in data["columns"][1:]), row[1:], strict=True)
    said = f"State at t = {row[0]} s, the last of {count} states that are compared:"
    return f"{said}\n\n{table(('variable', 'value'), list(named))}"


def error(data: Any) -> str:
    """Return the definition of the error of a state, with the scales of this problem."""
    early_worst = max(condition for _, condition in compared(data))
    length = max(float(data["scene"][axis]) for axis in "ab")
    gravity = float(data["scene"]["gravity"])
    near = 0.02 * math.sqrt(length / gravity)
    scales = [
        ("x, z", "L = max(a, b)", f"{length:g} m"), ("theta", "1", "1 rad"),
        ("x_dot, z_dot", "sqrt(g L)", f"{math.sqrt(gravity * length):.6g} m/s"),
        ("omega", "sqrt(g/L)", f"{math.sqrt(gravity / length):.6g} rad/s"),
    ]  # fmt: skip
    early = (
        "to the end" if data["horizon"] == data["t_end"] else
        f"before the horizon, {data['horizon']} s, at which the condition number first exceeds 1000"
    )  # fmt: skip
    return (
        f"## Error\n\nStates are compared {early},\nat times more than {near:.3g} s away from all "
        "events. The error of a state is its largest deviation,\nin units of the scales below. The "
        f"score divides it by the condition number at that time, which\nis {early_worst:.3g} at "
        "most.\n\n" + table(("variables", "scale", "here"), scales)
    )


# ------------------------------------------------------------------------------ pictures


def picture(name: str) -> Figure:
    """Return a chart of the motion: phase plane, forces, or positions over the ground."""
    one = benchmark.problem(name)
    motion = one.trajectory
    chart: Any
    if name in PHASE:
        chart = rl.plot_phase(motion)
    elif name in FORCES:
        chart = rl.plot_forces(motion)
    else:
        if name in ALONG:
            motion = rl.simulate(one.scene.replace(x_dot=ALONG[name]), one.output_times)
        count, t_end = SHOWN.get(name, (13, None))
        chart = rl.plot_strobe(motion, count=count, t_end=t_end)
    plt.close(chart.figure)
    return chart.figure
