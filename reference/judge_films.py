"""Test `fit_motion` with right and wrong films of known scenes.

    python reference/judge_films.py judged.jsonl --study right --films 300

A fit takes one to six seconds. A run continues an existing file, and each study has its own seeds.
`--films 0` only prints the results in the file. The studies:

right    films of all kinds of motion with normal noise: how many are reported as wrong, and, if
         sigma is estimated, the errors of the parameters, in standard errors
camera   the same with a camera of unknown scale, ground and clock
resistance  films of bodies that rolling resistance brings to rest, every second one from such a
         camera, with given sigma: chi2, the errors of the parameters, and the time of a fit
wrong    films that were changed and do not fit their scene: how many are reported as wrong, and for
         how many the message names the reading of the data that makes them fit
example  the film of docs/film.md: cost of the fit minus that of a fit from the true scene
wild     the same film with 4 of 80 angles off by a quarter turn, fitted alternately with "soft_l1"
         and "cauchy"
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
from scipy.special import betainc, ndtri

Tracks = dict[str, Any]
TRACKS = ("x", "z", "theta")
# the scene of docs/film.md
EXAMPLE = rl.Scene(0.035, 0.025, z=0.1, theta=0.5, omega=12.0, friction=0.18, restitution=0.52)
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
    """Return a random scene of a kind, its free parameters, the noise of the tracks, and the times
    of the frames."""
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
    """Return the scene with the guesses of a person who has watched the film once."""
    guess = {name: 1.2 * value_of(scene, name) for name in free}
    for name, off in {"x": 0.1 * scene.a, "z_dot": 0.1 * math.sqrt(9.81 * scene.a)}.items():
        guess |= {name: guess[name] + off} if name in free else {}
    guess |= {"theta": scene.theta + 0.2} if "theta" in free else {}
    return scene.replace(**guess | ({"restitution": 0.5} if "restitution" in free else {}))


def largest(fit: rl.Fit) -> float:
    """Return the largest T of a fit's tracks: a normal deviate exceeds it as rarely as noise
    exceeds the correlation of neighbouring residuals that `judged` in films/judgement.py defines.
    """
    found = [0.0]
    for r in fit.residuals.T:
        pairs = np.isfinite(r[:-1]) & np.isfinite(r[1:])
        one, other = r[:-1][pairs], r[1:][pairs]
        if one.size >= 8:
            unlike = float((one - other) @ (one - other)) / (2 * float(one @ one + other @ other))
            found.append(-float(ndtri(betainc(one.size / 2, one.size / 2, unlike))))
    return max(found)


def with_gaps(film: Tracks, random: Any) -> None:
    """Replace about a tenth of the numbers in each track by NaN."""
    for name in TRACKS:
        film[name][random.random(len(film[name])) < 0.1] = np.nan


def results(fit: rl.Fit, true: dict[str, float], **more: Any) -> dict[str, Any]:
    """Return the results of a fit to a right film; `off` has the errors of the parameters in
    standard errors."""
    off = {name: (fit.values[name] - value) / fit.errors[name] for name, value in true.items()}
    return more | {
        "frames": len(fit.residuals), "T": largest(fit), "off": off, "chi2": fit.chi2,
        "dof": int(np.isfinite(fit.residuals).sum()) - len(true),
        "alarm": "not fit" in fit.message, "message": fit.message,
    }  # fmt: skip


def right(seed: int) -> dict[str, Any]:
    random, kind = np.random.default_rng([1, seed]), KINDS[seed % 5]
    scene, free, sigma, t = drawn(kind, random)
    film = noisy(scene, t, sigma, random)
    if seed // 5 % 2:
        with_gaps(film, random)
    given = sigma if seed // 10 % 3 == 2 else None
    fit = rl.fit_motion(**film, scene=guessed(scene, free), free=free, sigma=given)
    true = {name: value_of(scene, name) for name in free}
    return results(fit, true, kind=kind, given=given is not None)


def camera(seed: int) -> dict[str, Any]:
    """Return the results of a film from a camera of unknown scale, ground and clock.

    The scale is 0.2 to 5, and the ground is off by up to three semi-axes. The first frame is up to
    1.5 sqrt(a/g) after the start, and the clock of the film may have started long before.
    """
    random, kind = np.random.default_rng([7, seed]), KINDS[seed % 5]
    scene, free, sigma, t = drawn(kind, random)
    scale = float(np.exp(random.uniform(math.log(0.2), math.log(5))))
    ground = float(random.uniform(-3, 3)) * scene.a * scale
    late = float(random.uniform(0, 1.5)) * math.sqrt(scene.a / 9.81)
    clock = late - float(random.choice([0, 0, 17.0, -0.3, 0.1]))
    film = noisy(scene, t - t[0] + late, sigma, random)
    film |= {"x": scale * film["x"], "z": ground + scale * film["z"]}
    if seed // 5 % 2:
        with_gaps(film, random)
    film["t"] = film["t"] - clock
    free = tuple(name for name in free if name != "z")  # not independent of the clock
    guess = guessed(scene, free)
    true = {name: value_of(scene, name) for name in free}
    true |= {"scale": scale, "ground": ground, "clock": clock}
    given = {n: s * (1 if n == "theta" else scale) for n, s in sigma.items()}
    known = given if seed % 3 == 0 else None
    fit = rl.fit_motion(**film, scene=guess, free=tuple(true), sigma=known)
    return results(fit, true, kind=kind, given=known is not None)


def resisted(seed: int) -> tuple[rl.Scene, tuple[str, ...], dict[str, float], Any]:
    """Like `drawn`, for a body that comes to rest and whose lever exceeds five standard errors.

    The spin of a rolling body is not fitted if the clock of the camera is unknown, because each
    swing would then contain an equivalent start. The film ends at 0.7 to 1.1 times the time of
    rest, which is below 60 sqrt(a/g).
    """
    random, small = np.random.default_rng([8, seed]), seed // 6 % 2
    while True:
        a = 0.035 if small else float(np.exp(random.uniform(np.log(0.02), np.log(1.0))))
        b, speed = 0.025 if small else a * random.uniform(0.5, 0.95), math.sqrt(9.81 * a)
        body: dict[str, Any] = {"a": a, "b": b, "theta": random.uniform(-1, 1)}
        body["rolling_resistance"] = b * float(np.exp(random.uniform(np.log(2e-3), np.log(0.03))))
        body["friction"] = random.uniform(0.15, 0.5)
        spin = speed / a * random.uniform(-1, 1)
        free: tuple[str, ...] = ("theta", *(() if seed % 2 else ("omega",)), "rolling_resistance")
        if seed % 3 == 0:
            body |= {"omega": spin, "friction": 5.0}
        elif seed % 3 == 1:
            body |= {"x_dot": speed * random.uniform(1, 2), "omega": spin / 2}
            free = ("theta", "x_dot", "friction", "rolling_resistance")
        else:
            body |= {"z": a * random.uniform(1.2, 3), "x_dot": speed * random.uniform(-0.5, 0.5)}
            body |= {"omega": spin, "restitution": random.uniform(0.2, 0.6)}
            free = ("theta", "omega", "x_dot", "friction", "restitution", "rolling_resistance")
        place = a * random.choice([0.003, 0.01, 0.02])
        sigma = {"x": place, "z": place, "theta": float(random.choice([0.005, 0.01, 0.03]))}
        scene, longest = rl.Scene(**body), 60 * math.sqrt(a / 9.81)
        motion = rl.simulate(scene, np.linspace(0, longest, 2), raise_on_failure=False)
        ends = [event.t for event in motion.events if event.kind is rl.EventKind.REST]
        if not ends:
            continue
        rate, last = random.choice([60, 240]), ends[0] * random.uniform(0.7, 1.1)
        t = np.arange(1, max(20, int(rate * last)) + 1) / rate
        t = t[:: math.ceil(t.size / 300)]  # as from a slower camera
        if scene.rolling_resistance > 5 * _error(scene, free, sigma, t):
            return scene, free, sigma, t


def _error(scene: rl.Scene, free: tuple[str, ...], sigma: dict[str, float], t: Any) -> float:
    """Return the standard error of the lever for a known camera.

    It is computed from central differences at the true scene.
    """
    columns = []
    for name in free:
        step = 1e-6 * {"rolling_resistance": scene.b}.get(name, 1.0)
        two = [scene.replace(**{name: value_of(scene, name) + way * step}) for way in (-1, 1)]
        before, after = (rl.simulate(one, t, raise_on_failure=False) for one in two)
        if before.t.size < t.size or after.t.size < t.size:
            return math.inf
        columns.append([(getattr(after, n) - getattr(before, n)) / (2 * step * sigma[n])
                        for n in TRACKS])  # fmt: skip
    jacobian = np.reshape(columns, (len(free), -1))
    return float(np.sqrt(np.linalg.pinv(jacobian @ jacobian.T)[-1, -1]))


def resistance(seed: int) -> dict[str, Any]:
    random, (scene, free, sigma, t) = np.random.default_rng([9, seed]), resisted(seed)
    true, scale, ground, late = {n: value_of(scene, n) for n in free}, 1.0, 0.0, 0.0
    if seed % 2:
        scale = float(np.exp(random.uniform(math.log(0.5), math.log(2))))
        ground = float(random.uniform(-3, 3)) * scene.a * scale
        late = float(random.uniform(0, 1)) * math.sqrt(scene.a / 9.81)
        true |= {"scale": scale, "ground": ground, "clock": late}
    film = noisy(scene, t + late, sigma, random)
    film |= {"t": t, "x": scale * film["x"], "z": ground + scale * film["z"]}
    given = {n: s * (1 if n == "theta" else scale) for n, s in sigma.items()}
    guess, start = guessed(scene, free).replace(rolling_resistance=0.0), time.process_time()
    fit = rl.fit_motion(**film, scene=guess, free=tuple(true), sigma=given)
    seconds = time.process_time() - start
    levers = scene.rolling_resistance / fit.errors["rolling_resistance"]
    return results(fit, true, seconds=seconds, levers=levers)


def _smoothed(track: Any) -> Any:
    return np.convolve(np.pad(track, 4, mode="edge"), np.ones(9) / 9, "valid")


def _drag(film: Tracks, random: Any) -> Tracks:
    """Return the film of a body in thick air, whose velocities decay."""
    slower = (1 - np.exp(-0.8 * film["t"])) / 0.8
    motion = rl.simulate(EXAMPLE, slower)
    return {n: film[n] + getattr(motion, n) - getattr(rl.simulate(EXAMPLE, film["t"]), n)
            for n in TRACKS}  # fmt: skip


# for each kind: the change of a film, and the reading of the data that undoes it, or ""
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
    alarm = "not fit" in fit.message or "beyond any" in fit.message
    named = fit.message.partition("it fits with")[2]
    return {"kind": kind, "given": given is not None, "alarm": alarm, "reading": reading,
            "named": bool(reading) and reading in named, "message": fit.message}  # fmt: skip


def _over_truth(film: Tracks, loss: str) -> dict[str, Any]:
    """Return the results of a fit; `over` is its cost minus that of a fit from the true scene."""
    start = time.process_time()
    fit = rl.fit_motion(**film, scene=GUESS, free=FREE, sigma=SIGMA, loss=loss)
    seconds, squares = time.process_time() - start, (fit.residuals / fit.sigma) ** 2
    cost = float(np.nansum(_LOSS[loss](squares)) / 2)
    return {"over": cost - _local(film, loss), "seconds": seconds, "message": fit.message}


_LOSS: dict[str, Callable[[Any], Any]] = {
    "linear": lambda z: z,
    "soft_l1": lambda z: 2 * (np.sqrt(1 + z) - 1),
    "cauchy": np.log1p,
}


def _local(film: Tracks, loss: str) -> float:
    """Return the cost of the minimum that SciPy alone reaches from the true scene."""
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
    return _over_truth(_example_film(np.random.default_rng(seed)), "linear")


def wild(seed: int) -> dict[str, Any]:
    random = np.random.default_rng(seed)
    film = _example_film(random)
    film["theta"][random.choice(80, 4, replace=False)] += np.pi / 2
    return _over_truth(film, "soft_l1" if seed % 2 == 0 else "cauchy")


def _example_film(random: Any) -> Tracks:
    film = noisy(EXAMPLE, TIMES, SIGMA, random)
    film["theta"] = np.mod(film["theta"], np.pi)
    return film


STUDIES = {
    "right": right, "camera": camera, "resistance": resistance, "wrong": wrong,
    "example": example, "wild": wild,
}  # fmt: skip


def report(rows: list[dict[str, Any]]) -> None:
    for study in STUDIES:
        some = [row for row in rows if row["study"] == study]
        if some and study in ("right", "camera", "resistance"):
            chosen = [row for row in some if study != "right" or not row["given"]]
            off = np.array([v for row in chosen for v in row["off"].values()])
            off = np.abs(off[off != 0])
            print(f"{study}: {len(some)} films, {sum(row['alarm'] for row in some)} alarms, "
                  f"largest T {max(row['T'] for row in some):.2f}; {off.size} "
                  f"parameters, {np.mean(off < 1):.1%} within 1, {np.mean(off < 3):.1%} within 3 "
                  f"errors, largest {off.max():.1f}")  # fmt: skip
            if study == "resistance":
                names = "chi2", "dof", "levers", "seconds"
                chi2, dof, levers, seconds = np.array([[row[n] for n in names] for row in some]).T
                print(f"chi2/n {np.sum(chi2) / np.sum(dof):.3f}, of films {min(chi2 / dof):.2f} to "
                      f"{max(chi2 / dof):.2f}; levers of {min(levers):.0f} errors or more; median "
                      f"time of a fit {np.median(seconds):.2f} s")  # fmt: skip
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
