"""Read and compare the records of tests/core/golden.cpp, and compute them through Python."""

import math
import os
import subprocess
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl

from .paths import TESTS

GOLDEN = TESTS / "core" / "golden.txt"

# Bound for another C library, which rounds sin and cos differently. Exact motions and fixed steps
# then change by roundings, and steps of controlled error by at most their tolerance of 1e-10.
OTHER_LIBRARY = 1e-10

_COLUMNS = {
    "rolling": ("theta", "omega", "x"),
    "contact": (
        "theta", "omega", "x", "z", "x_dot", "z_dot", "normal_force", "friction_force",
    ),
    "multipliers": (
        "x", "z", "theta", "psi", "r", "x_dot", "z_dot", "omega", "psi_dot", "r_dot",
    ),
}  # fmt: skip


@dataclass(frozen=True)
class Record:
    """A line of golden.txt: its kind, words and numbers."""

    kind: str
    words: tuple[str, ...]
    numbers: tuple[float, ...]

    def __str__(self) -> str:
        return " ".join((self.kind, *self.words, *(number.hex() for number in self.numbers)))


def is_number(word: str) -> bool:
    return word in ("nan", "inf", "-inf") or word.lstrip("-").startswith("0x")


def record(line: str) -> Record:
    kind, *rest = line.split()
    numbers = [float.fromhex(word) for word in rest if is_number(word)]
    return Record(kind, tuple(word for word in rest if not is_number(word)), tuple(numbers))


def read(text: str) -> tuple[str, list[Record]]:
    """Name of the C library, and the records of a text."""
    library, *lines = text.splitlines()
    assert library.startswith("library ")
    return library, [record(line) for line in lines]


def golden() -> tuple[str, list[Record]]:
    """C library and records of the committed golden.txt."""
    return read(GOLDEN.read_text(encoding="utf-8"))


def printed(program: Path, **environment: str) -> tuple[str, list[Record]]:
    """C library and records that a build's program `golden` prints."""
    done = subprocess.run(
        [str(program)], env=os.environ | environment, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    return read(done.stdout)


def blocks(records: list[Record], first: str) -> dict[str, list[Record]]:
    """Blocks of records by name. Each starts with a record of the kind `first` and ends before the
    next such record."""
    starts = [i for i, each in enumerate(records) if each.kind == first]
    ends = [*starts[1:], len(records)]
    named: dict[str, list[Record]] = {}
    for begin, end in zip(starts, ends, strict=True):
        name = records[begin].words[0] if records[begin].words else str(len(named))
        named[name] = records[begin:end]
    return named


def difference(one: list[Record], other: list[Record]) -> tuple[float, str]:
    """Largest difference between corresponding numbers, relative for numbers above 1, and the two
    records that contain it. All words must agree."""
    assert len(one) == len(other)
    worst, where = 0.0, "the same bits"
    for mine, theirs in zip(one, other, strict=True):
        pair = f"\n{mine}\n{theirs}"
        assert (mine.kind, mine.words) == (theirs.kind, theirs.words), pair
        assert len(mine.numbers) == len(theirs.numbers), pair
        for x, y in zip(mine.numbers, theirs.numbers, strict=True):
            if x == y and math.copysign(1, x) == math.copysign(1, y):
                continue
            if math.isnan(x) and math.isnan(y):
                continue
            off = max(abs(x - y) / max(1.0, abs(x)), math.ulp(0.0))  # positive also for -0 and 0
            if not off <= worst:  # also true for a NaN
                worst, where = off, pair
    return worst, where


def given(value: float) -> float | None:
    return None if math.isnan(value) else value


def or_nan(value: float | None) -> float:
    return math.nan if value is None else float(value)


def scene_of(row: tuple[float, ...]) -> rl.Scene:
    a, b, mass, gravity, inertia, slope, friction, restitution, theta, omega, x = row[:11]
    z, x_dot, z_dot = map(given, row[11:14])
    blow = rl.Impulse(jx=row[14], jz=row[15], dx=row[16], dz=row[17]) if any(row[14:16]) else None
    return rl.Scene(
        a, b, mass=mass, gravity=gravity, inertia=inertia, slope=slope, friction=friction,
        restitution=restitution, theta=theta, omega=omega, x=x, z=z, x_dot=x_dot, z_dot=z_dot,
        impulse=blow,
    )  # fmt: skip


def at(state: Any) -> tuple[float, ...]:
    return (state.theta, state.omega, state.x, state.z, state.x_dot, state.z_dot)


def motion_through_python(motion: list[Record]) -> Iterator[Record]:
    """The records of a motion after its records "motion" and "scene", computed through Python."""
    (_, model, method, stabilization), scene = motion[0].words, scene_of(motion[1].numbers)
    t_end, samples, step, stages = motion[0].numbers
    times = np.array([t_end * i / (samples - 1) for i in range(int(samples))])
    chosen: dict[str, Any] = {"model": model, "method": method, "stabilization": stabilization}
    chosen |= {"step": given(step), "stages": int(stages) or None}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rl.ValidityWarning)
        warnings.simplefilter("ignore", rl.StabilityWarning)
        computed = rl.simulate(scene, times, **chosen)
    solution = next(each for each in motion if each.kind == "solution")
    ending, followed_until, _ = solution.numbers  # Python does not expose these two
    yield Record("solution", (computed.model, computed.method),
                 (ending, followed_until, computed.valid_until))  # fmt: skip
    for event in computed.events:
        yield Record("event", (event.kind.name.lower(),), (event.t, *at(event.state_after)))
    columns = [getattr(computed, name) for name in _COLUMNS[computed.model]]
    shown = [each.numbers[0] for each in motion if each.kind == "sample"]
    for i in np.searchsorted(computed.t, shown):
        yield Record(
            "sample", (), (float(computed.t[i]), *(float(column[i]) for column in columns))
        )
    proof = rl.certify(scene)
    yield Record("certificate", (proof.validity.name.lower(),), (
        or_nan(proof.ends_at), or_nan(proof.smallest_normal_force),
        or_nan(proof.smallest_normal_force_angle), or_nan(proof.largest_friction_needed),
        or_nan(proof.largest_friction_needed_angle), rl.required_friction(scene),
    ))  # fmt: skip
    yield Record("outcome", (str(int(rl.outcome(scene))),), ())


def bodies_through_python(records: list[Record]) -> list[Record]:
    """Records of bodies, each followed by a record of the computed state of the body."""
    bodies = [each for each in records if each.kind == "body"]
    columns = np.array([each.numbers for each in bodies]).T
    t, a, b, theta, omega, gravity, gyration2 = columns
    named = {"a": a, "b": b, "theta": theta, "omega": omega, "gravity": gravity}
    rolled = np.array(rl.flow(t, **named, gyration2=gyration2)).T
    states = [Record("rolled", (), tuple(each)) for each in rolled.tolist()]
    return [each for pair in zip(bodies, states, strict=True) for each in pair]


def outcomes_through_python(records: list[Record]) -> Iterator[Record]:
    theta, omega = np.array([0.2 * i for i in range(16)]), np.array([0.5 * i for i in range(16)])
    for one, other in pairwise(each for each in records if each.kind in ("thresholds", "classify")):
        if one.kind == "classify":
            continue
        a, b, gravity, gyration2, friction = body = other.numbers
        known = rl.thresholds(a, b, gravity=gravity, gyration2=gyration2, friction=friction)
        names = (
            "roll_over_speed", "contact_loss_speed", "contact_loss_angle", "slip_speed",
            "slip_angle", "friction_to_roll_over", "painleve_friction", "painleve_angle",
            "rocking_rate", "tip_rate",
        )  # fmt: skip
        numbers = [or_nan(getattr(known, name)) for name in names]
        gaps = [(one[1], next_[0]) for one, next_ in pairwise(known.slip_windows)]
        numbers[5:5] = gaps[0] if gaps else (math.inf, math.inf)
        yield Record("thresholds", (), (*body, *numbers))
        codes = rl.classify(
            a=a, b=b, theta=theta[:, None], omega=omega, friction=friction, gravity=gravity,
            gyration2=gyration2,
        )  # fmt: skip
        yield Record("classify", ("".join(map(str, np.ravel(codes))),), body)
