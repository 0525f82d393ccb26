"""Start new motions from states of random motions, and compare them with the random motions.

    python reference/judge_restarts.py --study ends --scenes 20000 --seed 1 --file restarts.jsonl

A run takes a few minutes and continues an existing file. Without `--file` the results are not
stored. `--scenes 0` only prints the results in the file. The studies:

ends    new motions of length t2 start from states at t1: do they end in the same state as one
        motion of length t1 + t2 (an exact sum)?
events  new motions start from states at events, as returned in the event, by `at` and by
        `scene_at`: do they have the later events?
cut     motions stopped by `max_events` continue from their end, and from one ulp before the next
        event: do the new motions have this event and the later ones?

The random scenes have aspect ratios up to 800, any size, slope and friction, and angles up to 1e9.
The verdict on a new start is one of these:

same            the same events and, in `ends`, a state within 8 units
over 8 units    the same events, but a state that differs by more
silent          in `cut`, the next change of mode happens without an event, as documented
one more ...    one more impact after a start between bounces that are summed, as documented
jams ...        a start at the limit of Painleve's paradox: rounding errors decide whether it jams,
                as documented
beside a tie    other events, but a relative change of 1e-12 in an input also changes the events of
                the first motion
wrong           other events for no known reason
refused         `Scene` rejects the state

The unit of a number is the sum of the effects of one rounding of each input of the motion and of
the new start, computed from differences, plus two ulp of the number. On the ground the unit
includes the effect of one ulp of theta on h, h' omega and, without slip, h omega, because both
states compute these values from a theta rounded by half an ulp. A state that does not depend
linearly on the inputs counts as beside a tie.
"""

import argparse
import math
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import _core
from rolling_ellipse._ask.settings import DEFAULTS
from runs import add_record, read_records

Values = dict[str, Any]
Finding = tuple[str, str, float, str]  # label, verdict, distance, and code to reproduce the case
INPUTS = ("a", "b", "mass", "gravity", "inertia", "slope", "friction", "restitution")
STATE = ("theta", "omega", "x", "z", "x_dot", "z_dot")
ULP = 2.0**-52
CHANGE = 1e-12  # change of an input that shows whether a motion is beside a tie
LIMIT = 8.0  # largest accepted error, in units
BLOCK = 50  # number of scenes that are drawn together
MOST = 30  # maximum number of events of a motion
SAME_TIME = 1e-5  # largest relative difference of the times of an event in two motions
SUMMED = "one more among summed bounces"
JAMS = "jams by roundings"
EXCUSED = ("same", "silent", SUMMED, JAMS, "beside a tie")


# ---------------------------------------------------------------- the scenes


def powers(rng: Any, n: int, low: float, high: float) -> Any:
    return 10 ** rng.uniform(low, high, n)


def either(rng: Any, n: int, *arrays: Any) -> Any:
    """Return an array whose numbers are each drawn from one of the given arrays."""
    return np.choose(rng.integers(len(arrays), size=n), arrays)


def body(rng: Any, n: int) -> Values:
    size, sign = either(rng, n, 1.0, powers(rng, n, -6, 6)), rng.choice([-1, 1], n)
    beside_round = 1 + sign * powers(rng, n, -15, -1)
    common, any_aspect = powers(rng, n, -0.7, 0.7), powers(rng, n, -2.9, 2.9)
    aspect = either(rng, n, 1.0, beside_round, 2.0, any_aspect, common, common)
    a, b = size * np.minimum(aspect, 1), size / np.maximum(aspect, 1)
    mass, disc = powers(rng, n, -3, 3), (a * a + b * b) / 4
    other = np.maximum(a, b) ** 2 * powers(rng, n, -4, 1)
    steep, gentle = sign * rng.uniform(0, 1.2, n), sign * powers(rng, n, -12, -1)
    usual = rng.uniform(0.02, 1, n)
    friction = either(rng, n, 0.0, np.inf, powers(rng, n, -3, 1), usual, usual)
    return {
        "a": a, "b": b, "mass": mass, "gravity": either(rng, n, 9.81, powers(rng, n, -6, 6)),
        "inertia": mass * either(rng, n, disc, disc, other), "friction": friction,
        "slope": either(rng, n, 0.0, 0.0, steep, gentle),
        "restitution": either(rng, n, 0.0, 1.0, rng.random(n), rng.random(n)),
    }  # fmt: skip


def clocks(v: Values) -> Any:
    """Return the natural times sqrt(length / g) [s]."""
    return np.sqrt(np.maximum(v["a"], v["b"]) / v["gravity"])


def draw(rng: Any, n: int) -> Values:
    """Draw scenes that roll, slide, fly or leave the ground; omitted arguments are NaN."""
    v, sign = body(rng, n), rng.choice([-1, 1], n)
    quarter = np.round(rng.uniform(-4, 4, n)) * math.pi / 2
    far, near = sign * powers(rng, n, 0, 9), quarter + sign * powers(rng, n, -12, -1)
    v["theta"] = theta = either(
        rng, n, quarter, near, far, sign * powers(rng, n, 0, 3), quarter / 5
    )
    spin = either(rng, n, 0.0, rng.uniform(0, 4, n), rng.uniform(0, 4, n), powers(rng, n, -4, 1))
    v["omega"] = omega = rng.choice([-1, 1], n) * spin / clocks(v)
    a, b, long = v["a"], v["b"], np.maximum(v["a"], v["b"])
    h = np.hypot(a * np.sin(theta), b * np.cos(theta))
    speed, slope = long / clocks(v), (a - b) * (a + b) * np.sin(theta) * np.cos(theta) / h
    v["x"] = either(rng, n, 0.0, rng.normal(0, 10, n) * long)
    kind = rng.choice(["rolls", "rolls", "slides", "flies", "leaves"], n)
    up = slope * omega + speed * powers(rng, n, -4, 0.3)
    above = h + long * powers(rng, n, -3, 0.5)
    v["x_dot"] = np.where(kind == "rolls", np.nan, rng.normal(0, 1.5, n) * speed)
    v["z"] = np.where(kind == "flies", above, np.nan)
    flies, leaves = kind == "flies", kind == "leaves"
    v["z_dot"] = np.select([flies, leaves], [rng.normal(0, 1, n) * speed, up], np.nan)
    keep = [scene_of(v, i) is not None for i in range(n)]
    return {name: column[keep] for name, column in v.items()}


def scene_of(v: Values, i: int) -> rl.Scene | None:
    """Return scene i, or None if its values are rejected."""
    try:
        given: Values = {n: float(c[i]) for n, c in v.items() if not math.isnan(c[i])}
        return rl.Scene(**given)
    except ValueError:
        return None


# ---------------------------------------------------------------- ends


def ends(v: Values, t: Any) -> tuple[Any, Any]:
    """Return the states and codes of `rl.ends`; NaN and -1 for refused starts.

    The codes are the mode, the number of events, the first event and the ending.
    """
    columns = [  # other values have the defaults of Scene; NumPy turns None into NaN
        v[name] if name in v else np.full(len(t), getattr(rl.Scene, name), float)
        for name in _core.FIELDS["Scene"]
    ]
    table = np.column_stack(columns + [np.full(len(t), np.nan)] * 4)  # no impulse
    found = _core.ends_table(table, DEFAULTS.core, t, 1)
    return found["states"][: len(STATE)], found["codes"]


def spread(v: Values, t: Any, change: float) -> tuple[Any, Any]:
    """Return the sum of the effects of one rounding of each input on the end states, and where the
    events change.

    They are computed from relative changes of the inputs by `change`.
    """
    states, codes = ends(v, t)
    total, tie = np.zeros_like(states), np.zeros(len(t), bool)
    for name, column in v.items():
        size = np.where(np.isfinite(column), np.abs(column), 0)
        size = np.maximum(size, 1) if name == "theta" else size
        for off in (change * size, -change * size):
            changed = column + off
            changed = np.minimum(changed, 1) if name == "restitution" else changed
            others, codes_of_others = ends(v | {name: changed}, t)
            done = codes_of_others[3] >= 0
            tie |= done & (codes_of_others[:2] != codes[:2]).any(axis=0)
            total += np.where(done, np.abs(others - states), 0) * (ULP / change) / 2
    return total, tie


def units(v: Values, t: Any) -> tuple[Any, Any]:
    """Return the effect of roundings on the ends, and which ends are beside a tie."""
    total, tie = spread(v, t, CHANGE)
    finer, tie_of_finer = spread(v, t, CHANGE / 10)
    bent = finer > 3 * total + 64 * ULP * np.abs(ends(v, t)[0])
    return total, tie | tie_of_finer | bent.any(axis=0)


def by_rounded_angle(v: Values, state: Any, mode: Any) -> Any:
    """Return the effect of an ulp of theta on the values that theta determines on the ground."""
    theta, omega = state[:2]
    slope = rl.geometry.support_slope(theta, a=v["a"], b=v["b"])
    bend = rl.geometry.support_curvature(theta, a=v["a"], b=v["b"])
    none, rolls = np.zeros_like(omega), mode == rl.Mode.ROLLING
    effects = np.array([none, none, none, slope, rolls * slope * omega, bend * omega])
    return np.abs(effects) * np.spacing(np.abs(theta)) * (mode != rl.Mode.FLIGHT)


def freed(v: Values, mode: Any) -> Values:
    """Return starts without the values that their mode determines.

    Other inputs can then be changed consistently.
    """
    ground, rolls = mode != rl.Mode.FLIGHT, ~np.isin(mode, [rl.Mode.FLIGHT, rl.Mode.SLIDING])
    left_out = {"z": ground, "z_dot": ground, "x_dot": rolls}
    return v | {name: np.where(out, np.nan, v[name]) for name, out in left_out.items()}


def study_ends(rng: Any, n: int) -> Iterator[Finding]:
    v = draw(rng, n)
    t = clocks(v) * 10 ** rng.uniform(-2, 0.8, (2, len(v["a"])))
    grid = np.ldexp(1.0, np.frexp(t.max(axis=0))[1] - 30)
    first, second = np.maximum(np.round(t / grid), 1) * grid  # their sum is exact
    (middle, codes), (whole, expected) = ends(v, first), ends(v, first + second)
    go = (codes[3] == 0) & (expected[3] == 0)
    v = {name: column[go] for name, column in v.items()}
    first, second, middle, whole = first[go], second[go], middle[:, go], whole[:, go]
    codes, expected = codes[:, go], expected[:, go]
    new = v | dict(zip(STATE, middle, strict=True))
    later, got = ends(new, second)
    unit, tie = units(v, first + second)
    more, tie_of_new = units(freed(new, codes[0]), second)
    long, clock = np.maximum(v["a"], v["b"]), clocks(v)
    least = ULP * np.array([clock / clock, 1 / clock, long, long, long / clock, long / clock])
    rounded = 2 * ULP * np.abs(whole) + by_rounded_angle(v, whole, expected[0])
    off = np.abs(later - whole) / (unit + more + rounded + least / 1000)
    for i in range(len(first)):
        differs = codes[1, i] + got[1, i] - expected[1, i], got[0, i] - expected[0, i], got[3, i]
        scene, worst = scene_of(new, i), float(off[:, i].max())
        if scene is None:
            verdict = "refused"
        elif not any(differs) and worst <= LIMIT:
            verdict = "same"
        elif tie[i] or tie_of_new[i]:
            verdict = "beside a tie"
        elif differs == (1, 0, 0) and codes[0, i] == rl.Mode.FLIGHT and touches(scene):
            verdict = SUMMED
        else:
            verdict = "wrong" if any(differs) else "over 8 units"
        case = f"rl.{scene_of(v, i)!r}  # {first[i]!s} + {second[i]!s} s, {worst:.3g} units"
        yield rl.Mode(codes[0, i]).name, verdict, worst if verdict == "same" else 0.0, case


# ---------------------------------------------------------------- events


def follow(scene: rl.Scene, t: float, most: int = MOST) -> rl.Trajectory:
    return rl.simulate(scene, [t], raise_on_failure=False, max_events=most)


def same(
    m: rl.Trajectory, got: rl.Trajectory, k: int = 0, skip: int = 0, start: float = 0.0
) -> bool:
    """Return whether the motion `got`, started at `start`, has the events of `m` from event k on.

    The first eight kinds and the first three times are compared, without the first `skip` events of
    `got`.
    """
    complete = len(m.events) < MOST
    if complete and m.status is not got.status:
        return False
    if complete and len(got.events) < MOST and len(m.events) - k != len(got.events) - skip:
        return False
    pairs = list(zip(m.events[k : k + 8], got.events[skip:], strict=False))
    if m.events[k:] and not pairs:
        return False
    near = (abs(p.t - q.t - start) <= SAME_TIME * max(p.t, start) for p, q in pairs[:3])
    return all(p.kind is q.kind for p, q in pairs) and all(near)


def touches(scene: rl.Scene) -> bool:
    return bool(scene.z == rl.geometry.support(scene.theta, a=scene.a, b=scene.b))


def summed(m: rl.Trajectory, k: int) -> bool:
    """Return whether bounces are summed before event k."""
    if k < 1 or m.events[k - 1].state_after.mode is not rl.Mode.FLIGHT:
        return False
    until = m.events[k].t if k < len(m.events) else m.t_end
    state = m.at((m.events[k - 1].t + until) / 2)
    return state.mode is rl.Mode.FLIGHT and touches(at(m, state))


def beside_a_tie(m: rl.Trajectory, k: int) -> bool:
    """Return whether a relative change of an input by 1e-12 changes the events."""
    for name in INPUTS + STATE:
        value = getattr(m.scene, name)
        if value is None or not math.isfinite(value):
            continue
        size = max(abs(value), 1.0) if name == "theta" else abs(value)
        for off in (CHANGE * size, -CHANGE * size):
            try:
                changed = follow(m.scene.replace(**{name: value + off}), m.span)
            except ValueError:
                continue
            if not (same(m, changed) and same(m, changed, k, k)):
                return True
    return False


def jams_by_roundings(new: rl.Scene, got: rl.Trajectory) -> bool:
    """Return whether a start jams, but does not jam if its angle changes by eight ulp."""
    if got.status is not rl.Status.JAMMED or got.t_end > 0:
        return False
    off = 8 * np.spacing(abs(new.theta))
    free: Values = dict.fromkeys(("z", "z_dot"))
    beside = (new.replace(**free, theta=new.theta + side * off) for side in (-1, 1))
    return any(follow(each, 0.0).status is not rl.Status.JAMMED for each in beside)


def judged(
    m: rl.Trajectory, k: int, label: str, start: Callable[[], rl.Scene], t: float, due: bool
) -> Finding:
    """Judge a start at t, before event k of a motion; if `due`, this event may be silent."""
    case, off = f"rl.{m.scene!r}  # to {m.span!r} s, a start at {t!r} s, before event {k}", 0.0
    try:
        new = start()
    except ValueError as error:
        return label, "refused", off, f"{case}: {error}"
    past = 1 + 1e-6 * (m.status is rl.Status.JAMMED)  # the new motion must also reach the jam
    got = follow(new, max(m.t_end * past - t, 0.0))
    silent = due and m.events[k].kind is not rl.EventKind.IMPACT
    impact = bool(got.events) and got.events[0].kind is rl.EventKind.IMPACT
    if same(m, got, k, 0, t):
        pairs = zip(m.events[k:], got.events[:2], strict=False)
        off = max((abs(p.t - q.t - t) / p.t for p, q in pairs if p.t), default=0.0)
        return label, "same", off, case
    if silent and same(m, got, k + 1, 0, t):
        return label, "silent", off, case
    one_more = same(m, got, k, 1, t) or (silent and same(m, got, k + 1, 1, t))
    if impact and one_more and summed(m, k):
        return label, SUMMED, off, case
    if jams_by_roundings(new, got):
        return label, JAMS, off, case
    return label, "beside a tie" if beside_a_tie(m, k) else "wrong", off, case


def motions(rng: Any, n: int) -> Iterator[rl.Trajectory]:
    v = draw(rng, n)
    for i, t in enumerate(8 * clocks(v)):
        scene = scene_of(v, i)
        assert scene is not None
        yield follow(scene, float(t))


def at(m: rl.Trajectory, state: Any) -> rl.Scene:
    return m.scene.replace(**{name: getattr(state, name) for name in STATE})


def study_events(rng: Any, n: int) -> Iterator[Finding]:
    for m in motions(rng, n):
        for k, e in enumerate(m.events[:8], 1):
            roads: dict[str, Callable[[], rl.Scene]] = {
                "event": partial(at, m, e.state_after), "at": partial(at, m, m.at(e.t)),
                "scene_at": partial(m.scene_at, e.t),
            }  # fmt: skip
            for road, start in roads.items():
                label = f"{e.kind.name} {e.state_after.mode.name} by {road}"
                again = e.kind is rl.EventKind.JAM and e.t == 0  # a new start from a jam jams, too
                yield judged(m, k - again, label, start, e.t, due=False)


def study_cut(rng: Any, n: int) -> Iterator[Finding]:
    for m in motions(rng, n):
        for k, e in enumerate(m.events[1:6], 1):
            cut = follow(m.scene, m.span, k)
            for road, t in (("end", cut.t_end), ("before", math.nextafter(e.t, 0))):
                label = f"{e.state_before.mode.name} {e.kind.name} by {road}"
                yield judged(m, k, label, partial(cut.scene_at, t), t, due=True)


# ---------------------------------------------------------------- the run

STUDIES = {"ends": study_ends, "events": study_events, "cut": study_cut}


def report(records: list[Values]) -> None:
    """Print the counts of the verdicts, and each case whose verdict is not in EXCUSED."""
    for study in STUDIES:
        tally, worst = defaultdict[str, Counter[str]](Counter), defaultdict[str, float](float)
        some = [row for row in records if row["study"] == study]
        for label, verdict, count, off in (line for row in some for line in row["counts"]):
            tally[label][verdict] += count
            worst[label] = max(worst[label], off)
        for label, verdicts in sorted(tally.items()):
            unit = "units" if study == "ends" else "of the time"
            print(f"{study}: {label}: {dict(verdicts)}, worst {worst[label]:.2g} {unit}")
        for case in (case for row in some for case in row["cases"]):
            print(case)


def judge(study: str, seed: int, block: int) -> Values:
    tally, worst, cases = Counter[tuple[str, str]](), defaultdict[Any, float](float), []
    for label, verdict, off, case in STUDIES[study](np.random.default_rng([seed, block]), BLOCK):
        tally[label, verdict] += 1
        worst[label, verdict] = max(worst[label, verdict], off)
        cases += [f"# {verdict}, {label}\n{case}"] if verdict not in EXCUSED else []
    counts = [[*key, count, worst[key]] for key, count in tally.items()]
    return {"study": study, "seed": seed, "block": block, "counts": counts, "cases": cases}


def main() -> None:
    """Judge scenes that are not in the file yet, and report."""
    asked = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    asked.add_argument("--study", choices=STUDIES, default="ends")
    asked.add_argument("--scenes", type=int, default=1000, help=f"rounded up to {BLOCK}")
    asked.add_argument("--seed", type=int, default=1)
    asked.add_argument("--file", type=Path, help="results, a line a block of scenes")
    given = asked.parse_args()
    warnings.simplefilter("ignore", rl.ValidityWarning)
    records = read_records(given.file)
    done = {(row["study"], row["seed"], row["block"]) for row in records}
    for block in range(-(-given.scenes // BLOCK)):
        if (given.study, given.seed, block) not in done:
            records.append(judge(given.study, given.seed, block))
            add_record(given.file, records[-1])
    report(records)


if __name__ == "__main__":
    main()
