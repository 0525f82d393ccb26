"""Judge `fit_motion` by films made of known scenes, right ones and wrong ones.

    python reference/judge_films.py judged.jsonl --study right --films 300

A film takes one to six seconds. A run continues an existing file, and each study has its own seeds;
`--films 0` only prints what is in the file. The studies:

right    films of all kinds with normal noise: how many are called wrong, and, if sigma is
         estimated, how far parameters are from those of the scene, in standard errors
wrong    films that do not fit their scene, of the kinds below in turn: how many are called wrong,
         and for how many the reading that makes them fit is named
example  the film of docs/film.md: cost of the minimum above that of the one downhill from the truth
wild     the same with 4 of 80 angles off by a quarter turn, by "soft_l1" and "cauchy" in turn
"""

import argparse
import math
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse._motion.inputs import value_of
from runs import add_record, read_records

Tracks = dict[str, Any]
TRACKS = ("x", "z", "theta")
EXAMPLE = rl.Scene(
    0.035, 0.025, z=0.1, theta=0.5, omega=12.0, friction=0.18, restitution=0.52
)  # of docs/film.md
GUESS = EXAMPLE.replace(theta=0.3, omega=10.0, friction=0.4, restitution=0.3)
FREE = ("theta", "omega", "friction", "restitution")
SIGMA = {"x": 5e-4, "z": 5e-4, "theta": 0.01}
TIMES = np.linspace(0.005, 0.4, 80)
KINDS = ("dropped", "thrown", "sliding", "rolling", "bouncing")


def noisy(scene: rl.Scene, t: Any, sigma: dict[str, float], random: Any) -> Tracks:
    motion = rl.simulate(scene, t)
    noise = {name: random.normal(0, deviation, len(t)) for name, deviation in sigma.items()}
    return {"t": t} | {name: getattr(motion, name) + off for name, off in noise.items()}


def drawn(kind: str, random: Any) -> tuple[rl.Scene, tuple[str, ...], dict[str, float], Any]:
    """Scene of a kind, its unknowns, the tracker's noise, and the camera's times."""
    a = float(np.exp(random.uniform(np.log(0.02), np.log(1.0))))
    b, speed = a * random.uniform(0.5, 0.95), math.sqrt(9.81 * a)
    body: dict[str, Any] = {"a": a, "b": b, "theta": random.uniform(-1, 1)}
    body |= {"friction": random.uniform(0.1, 0.5), "restitution": random.uniform(0.3, 0.7)}
    spin = speed / a * random.uniform(0.3, 1.0) * random.choice([-1, 1])
    if kind == "dropped":
        made = {"z": a * random.uniform(2, 4), "omega": spin}
        free: tuple[str, ...] = ("theta", "omega", "friction", "restitution")
    elif kind == "thrown":
        made = {"z": a * random.uniform(2, 4), "omega": spin}
        made |= {"x_dot": speed * random.uniform(0.3, 1), "z_dot": speed * random.uniform(0, 1)}
        free = ("x", "z", "theta", "x_dot", "z_dot", "omega", "friction", "restitution")
    elif kind == "sliding":
        made = {"x_dot": speed * random.uniform(1, 2)}
        free = ("x_dot", "theta", "friction")
    elif kind == "rolling":
        made = {"omega": spin, "friction": 5.0}
        free = ("theta", "omega")
    else:
        made = {"z": a * random.uniform(3, 6), "omega": spin / 3}
        made["restitution"] = random.uniform(0.7, 0.9)
        free = ("omega", "friction", "restitution")
    rate = 60 if random.random() < 0.5 else 240
    t = np.arange(1, 201) / rate
    t = t[t < 9 * math.sqrt(a / 9.81)]
    place = a * random.choice([0.003, 0.01, 0.02])
    sigma = {"x": place, "z": place, "theta": float(random.choice([0.005, 0.01, 0.03]))}
    return rl.Scene(**body | made), free, sigma, t


def guessed(scene: rl.Scene, free: tuple[str, ...]) -> rl.Scene:
    """Scene with the guesses of somebody who has seen the film once."""
    guess = {name: 1.2 * value_of(scene, name) for name in free}
    for name, off in {"x": 0.1 * scene.a, "z_dot": 0.1 * math.sqrt(9.81 * scene.a)}.items():
        guess |= {name: guess[name] + off} if name in free else {}
    guess |= {"theta": scene.theta + 0.2} if "theta" in free else {}
    return scene.replace(**guess | ({"restitution": 0.5} if "restitution" in free else {}))


def largest(fit: rl.Fit) -> float:
    """Largest T of the tracks of a fit without outliers, by the definition of `fit_motion`."""
    found = [0.0]
    for r in fit.residuals.T:
        pairs = np.isfinite(r[:-1]) & np.isfinite(r[1:])
        one, other = r[:-1][pairs], r[1:][pairs]
        if one.size >= 8:
            squares = float(one @ one + other @ other) / 2
            found.append(math.sqrt(one.size) * float(one @ other) / squares)
    return max(found)


def right(seed: int) -> dict[str, Any]:
    random, kind = np.random.default_rng([1, seed]), KINDS[seed % 5]
    scene, free, sigma, t = drawn(kind, random)
    film = noisy(scene, t, sigma, random)
    if seed // 5 % 2:  # missing frames
        for name in TRACKS:
            film[name][random.random(t.size) < 0.1] = np.nan
    given = sigma if seed // 10 % 3 == 2 else None
    fit = rl.fit_motion(**film, scene=guessed(scene, free), free=free, sigma=given)
    off = {n: (value_of(fit.scene, n) - value_of(scene, n)) / fit.errors[n] for n in free}
    return {
        "kind": kind, "frames": t.size, "given": given is not None, "T": largest(fit), "off": off,
        "alarm": "not fit" in fit.message, "message": fit.message,
    }  # fmt: skip


def _smoothed(track: Any) -> Any:
    return np.convolve(np.pad(track, 4, mode="edge"), np.ones(9) / 9, "valid")


def _drag(film: Tracks, random: Any) -> Tracks:
    """A body in thick air: its velocities decay."""
    slower = (1 - np.exp(-0.8 * film["t"])) / 0.8
    motion = rl.simulate(EXAMPLE, slower)
    return {n: film[n] + getattr(motion, n) - getattr(rl.simulate(EXAMPLE, film["t"]), n)
            for n in TRACKS}  # fmt: skip


# by kind: the change of a film, and the reading that makes it fit, if any
WRONG: dict[str, tuple[Callable[[Tracks, Any], Tracks], str]] = {
    "counter-clockwise": (lambda f, _: {"theta": -f["theta"]}, "theta = -theta"),
    "degrees": (lambda f, _: {"theta": np.degrees(f["theta"])}, "theta = np.radians(theta)"),
    "both": (lambda f, _: {"theta": -np.degrees(f["theta"])}, "theta = -np.radians(theta)"),
    "other axis": (lambda f, _: {"theta": f["theta"] - np.pi / 2}, "theta = theta + np.pi / 2"),
    "centimetres": (lambda f, _: {"x": 100 * f["x"], "z": 100 * f["z"]}, "x = x / 100"),
    "millimetres": (lambda f, _: {"x": 1000 * f["x"], "z": 1000 * f["z"]}, "x = x / 1000"),
    "ground 3 mm": (lambda f, _: {"z": f["z"] - 0.003}, "z = z +0.00"),
    "ground 12 mm": (lambda f, _: {"z": f["z"] + 0.012}, "z = z -0.01"),
    "y down": (lambda f, _: {"z": 0.31 - f["z"]}, "z = 0.31 - z"),
    "image": (lambda f, _: {"z": 0.31 - f["z"], "theta": -f["theta"]}, "- z and theta = -theta"),
    "milliseconds": (lambda f, _: {"t": 1000 * f["t"]}, "t = t / 1000"),
    "frames": (lambda f, _: {"t": 200 * f["t"]}, "t = t / 200"),
    "slowed twice": (lambda f, _: {"t": 2 * f["t"]}, "t = t / 2"),
    "x shifted": (lambda f, _: {"x": f["x"] + 0.05}, "x = x -0.0"),
    "smoothed": (lambda f, _: {n: _smoothed(f[n]) for n in TRACKS}, ""),
    "in air": (_drag, ""),
}


def wrong(seed: int) -> dict[str, Any]:
    random, kind = np.random.default_rng([2, seed]), list(WRONG)[seed % len(WRONG)]
    change, reading = WRONG[kind]
    film = noisy(EXAMPLE, TIMES, SIGMA, random)
    given = SIGMA if seed // len(WRONG) % 2 else None
    fit = rl.fit_motion(**film | change(film, random), scene=GUESS, free=FREE, sigma=given)
    alarm, named = ("not fit" in fit.message or "beyond any" in fit.message), fit.message[-60:]
    return {"kind": kind, "given": given is not None, "alarm": alarm, "reading": reading,
            "named": bool(reading) and reading in named, "message": fit.message}  # fmt: skip


def _over_truth(film: Tracks, loss: str) -> dict[str, Any]:
    """How far the cost of the minimum is above that of the one downhill from the truth."""
    start = time.process_time()
    fit = rl.fit_motion(**film, scene=GUESS, free=FREE, sigma=SIGMA, loss=loss)
    seconds, cost = time.process_time() - start, _cost(fit, loss)
    return {"over": cost - _local(film, loss), "seconds": seconds, "message": fit.message}


def _cost(fit: rl.Fit, loss: str) -> float:
    squares = (fit.residuals / fit.sigma) ** 2
    return float(np.nansum(_LOSS[loss](squares)) / 2)


_LOSS: dict[str, Callable[[Any], Any]] = {
    "linear": lambda z: z,
    "soft_l1": lambda z: 2 * (np.sqrt(1 + z) - 1),
    "cauchy": np.log1p,
}


def _local(film: Tracks, loss: str) -> float:
    """Cost of the minimum that SciPy alone reaches from the truth."""
    from scipy.optimize import least_squares

    def residuals(u: Any) -> Any:
        changes = dict(zip(FREE, u.tolist(), strict=True))
        motion = rl.simulate(EXAMPLE.replace(**changes), film["t"], raise_on_failure=False)
        off = np.array([(film[n] - getattr(motion, n)) for n in TRACKS])
        off[2] -= np.pi * np.round(off[2] / np.pi)
        return (off / np.array(list(SIGMA.values()))[:, None]).ravel()

    truth = [value_of(EXAMPLE, name) for name in FREE]
    bounds = ([-9, -99, 0, 0], [9, 99, 9, 1])
    how: dict[str, Any] = {"xtol": 1e-10, "ftol": 1e-10, "jac": "3-point", "bounds": bounds}
    return float(least_squares(residuals, truth, loss=loss, x_scale=[1, 10, 0.1, 1], **how).cost)


def example(seed: int) -> dict[str, Any]:
    film = _example_film(np.random.default_rng(seed))
    return _over_truth(film, "linear")


def wild(seed: int) -> dict[str, Any]:
    random = np.random.default_rng(seed)
    film = _example_film(random)
    film["theta"][random.choice(80, 4, replace=False)] += np.pi / 2
    return _over_truth(film, "soft_l1" if seed % 2 == 0 else "cauchy")


def _example_film(random: Any) -> Tracks:
    film = noisy(EXAMPLE, TIMES, SIGMA, random)
    film["theta"] = np.mod(film["theta"], np.pi)
    return film


STUDIES = {"right": right, "wrong": wrong, "example": example, "wild": wild}


def report(rows: list[dict[str, Any]]) -> None:
    for study in STUDIES:
        some = [row for row in rows if row["study"] == study]
        if some and study == "right":
            off = np.array([v for row in some if not row["given"] for v in row["off"].values()])
            off = np.abs(off[off != 0])
            print(f"right: {len(some)} films, {sum(row['alarm'] for row in some)} alarms, "
                  f"largest T {max(row['T'] for row in some):.2f}; sigma estimated: {off.size} "
                  f"parameters, {np.mean(off < 1):.1%} within 1, {np.mean(off < 3):.1%} within 3 "
                  f"errors, largest {off.max():.1f}")  # fmt: skip
        elif some and study == "wrong":
            missed = Counter(row["kind"] for row in some if not row["alarm"])
            readable = [row for row in some if row["reading"]]
            unnamed = Counter(row["kind"] for row in readable if not row["named"])
            print(f"wrong: {len(some)} films, {len(some) - missed.total()} alarms, missed "
                  f"{dict(missed)}; {len(readable) - unnamed.total()} of {len(readable)} readings "
                  f"named, missed {dict(unnamed)}")  # fmt: skip
        elif some:
            over = np.array([row["over"] for row in some])
            print(f"{study}: {len(some)} films, {np.sum(over > 0.1)} more than 0.1 above the "
                  f"minimum, largest {over.max():.3g}, least {over.min():.3g}")  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", type=Path, help="results, a line a film")
    parser.add_argument("--study", choices=STUDIES, default="right")
    parser.add_argument("--films", type=int, default=0, help="seeds from 0")
    options = parser.parse_args()
    rows = read_records(options.file)
    done = {(row["study"], row["seed"]) for row in rows}
    for seed in range(options.films):
        if (options.study, seed) not in done:
            row = {"study": options.study, "seed": seed, **STUDIES[options.study](seed)}
            rows.append(row)
            add_record(options.file, row)
    report(rows)


if __name__ == "__main__":
    main()
