"""Peers of the benchmark: installed ones solve the problem, missing ones are named."""

import importlib
import math
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bench_peers
import peers
import pytest
from peers.problem import RATES
from peers.scipy_ivp import peer as scipy_peer
from rolling_ellipse import Mode, Scene, flow, period, simulate

R = Scene(2.0, 1.0, theta=0.2, omega=3.2)
T = 1.37 * period(R) / 2
TOLERANCE = 1e-10
# The tolerance bounds the error of one step. Errors of a few hundred steps grow at most tenfold
# over the tip, so their sum stays below 1e4 tolerances.
BOUND = 1e4 * TOLERANCE


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[list[Any], dict[str, str]]]:
    """The installed and the missing peers; compiled files go to a temporary folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        installed, missing = peers.available()
        yield installed, missing


def largest(state: Any, exact: Any) -> float:
    return max(abs(p - q) for p, q in zip(state, exact, strict=True))


def exact_end(t: float, gravity: float = R.gravity) -> tuple[float, float, float]:
    theta, omega, x = flow(t, a=R.a, b=R.b, theta=R.theta, omega=R.omega, gravity=gravity)
    return theta, omega, x


def test_every_library_takes_part_or_is_missing_for_a_reason(found: Any) -> None:
    installed, missing = found
    libraries = {peer.library.split()[0] for peer in installed}
    assert "scipy" in libraries
    for library in peers.MODULES.values():
        assert (library.partition(".")[0] in libraries) is (library not in missing)
    assert all(missing.values())
    assert len({peer.name for peer in installed}) == len(installed)


def test_a_broken_installation_is_reported_with_its_message(monkeypatch: Any) -> None:
    def broken(name: str, package: str | None = None) -> Any:
        if "heyoka" in name:
            raise OSError("libsomething.so: not today")
        raise ModuleNotFoundError(f"No module named {name!r}", name=name)

    monkeypatch.setattr(importlib, "import_module", broken)
    installed, missing = peers.available()
    assert installed == [] and missing.keys() == set(peers.MODULES.values())
    assert missing["heyoka"] == "OSError: libsomething.so: not today"
    assert missing["scipy"].endswith("is not installed")


def test_no_library_is_loaded_before_it_is_needed() -> None:
    folder = str(Path(peers.__file__).parents[1])
    heavy = {"numpy", "scipy", "numba", "heyoka", "rebound", "jax", "sksundae"}
    script = f"import sys; sys.path.insert(0, {folder!r}); import peers; "
    script += f"assert not {heavy} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", script], check=True, timeout=60)


def test_every_peer_reproduces_the_exact_motion(found: Any) -> None:
    for peer in found[0]:
        run = peer.prepare(R, T, TOLERANCE)
        first = run()
        assert largest(first, exact_end(T)) < BOUND, peer.name
        assert run() == first, f"{peer.name}: a call integrates anew"
        assert all(count >= 0 for count in run.counts.values()), peer.name


def test_samples_agree_with_the_motion(found: Any) -> None:
    times = [0.0, 0.25 * T, 0.5 * T, 0.5 * T, T]
    exact = [exact_end(t) for t in times]
    for peer in found[0]:
        sampled = peer.prepare(R, T, TOLERANCE).sample(times)
        for row, state in zip(zip(*sampled, strict=True), exact, strict=True):
            assert largest(row, state) < 10 * BOUND, peer.name  # interpolation has a lower order


@pytest.mark.parametrize("slope", [0.1, -0.1])
def test_peers_and_the_package_agree_for_motions_on_slopes(found: Any, slope: float) -> None:
    scene = Scene(2.0, 1.0, slope=slope, theta=0.2, omega=2.0, x=1.0)
    end = simulate(scene, [0.7], model="rolling", method="dop853", rtol=1e-13, atol=1e-15)
    exact = end.theta[-1], end.omega[-1], end.x[-1]
    for peer in found[0]:
        assert largest(peer.prepare(scene, 0.7, TOLERANCE)(), exact) < BOUND, peer.name


def test_scenes_that_do_not_roll_are_rejected(found: Any) -> None:
    slides = Scene(2.0, 1.0, friction=0.01, omega=3.0, x_dot=1.0)
    flies = Scene(2.0, 1.0, z=5.0)
    assert slides.initial_state.mode is Mode.SLIDING
    for peer in found[0]:
        for scene, mode in ((slides, "SLIDING"), (flies, "FLIGHT")):
            with pytest.raises(ValueError, match=f"rolling only, and this scene starts {mode}"):
                peer.prepare(scene, 1.0, TOLERANCE)
        with pytest.raises(ValueError, match="t_end must be positive and finite, got inf"):
            peer.prepare(R, math.inf, TOLERANCE)


def test_a_peer_with_a_wrong_equation_is_detected() -> None:
    """If gravity is too strong by 1e-3, the error is the difference of the two exact motions."""

    def wrong(theta: Any, omega: Any, body: Any) -> Any:
        return RATES(theta, omega, (*body[:4], 1.001 * body[4], body[5]))

    end = scipy_peer("DOP853", compiled=False, rates=wrong).prepare(R, T, TOLERANCE)()
    difference = largest(exact_end(T, 1.001 * R.gravity), exact_end(T))
    assert 1e-4 < difference < 1e-2
    assert abs(largest(end, exact_end(T)) - difference) < 2 * BOUND


def test_the_quick_benchmark_lists_every_contender(found: Any, capsys: Any) -> None:
    """An hour is allowed so that the load of the machine does not matter."""
    ((_, race),) = bench_peers.main(["--quick", "--seconds", "3600"]).items()
    printed = capsys.readouterr().out
    for library, reason in found[1].items():
        assert f"missing: {library}: {reason}" in printed
    assert set(race.names) == {*bench_peers.METHODS, *(peer.name for peer in found[0])}
    for name in race.names:
        mine = [run for run in race.runs if run.name == name]
        assert all(run.completed or run.reason for run in mine), name
        reached = min(run.errors.largest for run in mine if run.completed)
        assert reached < (1e-14 if name == "flow" else BOUND), name
    assert race.reference.name == "quadrature_in_40_digits" and race.reference.floor == 0
    assert "best peer / best of package" in printed and "is unbeaten" in printed
    assert "empty call   known scene     new scene" in printed


def test_a_peer_that_is_ahead_of_the_package_is_marked() -> None:
    """A peer that takes no time is ahead of the package at the errors that it reaches."""

    class Lucky:
        name, library = "lucky", "none"

        def prepare(self, scene: Scene, t_end: float, setting: float) -> Any:
            answer = exact_end(t_end)
            return lambda: answer

    race = bench_peers.race("R", 1.37, [Lucky()], rounds=2, max_seconds=5.0, tolerances=[1e-2])
    assert bench_peers.factor(race, 1e-2).endswith(bench_peers.BEHIND)
    assert race.verdict().splitlines()[1].startswith("lucky" + bench_peers.AHEAD + "flow, ")
    known = bench_peers.costs(R, 1.37, [Lucky()], 2)
    assert list(known) == ["flow", "exact", "lucky"]
    assert all(seconds > 0 for row in known.values() for seconds in row)
    lines = bench_peers.table_of_calls(known).splitlines()
    assert [line.split()[0] for line in lines[1:]] == list(known)


def test_a_race_in_a_well_lasts_the_stated_number_of_half_periods() -> None:
    scene = bench_peers.SCENES["W"]
    assert bench_peers.end_of(scene, 0.42) == 0.42 * period(scene) / 2


def test_the_reference_of_a_race_reveals_a_small_error() -> None:
    """The reference shares no code with exact rolling, but agrees to a few ulp of x = 6.7 m."""
    exact = bench_peers.in_40_digits(R)
    off = [float(v[0] - own) for v, own in zip(exact([T]), exact_end(T), strict=True)]
    assert 0 < max(map(abs, off)) < 1e-14
    moved = [float(v[0] - own) for v, own in zip(exact([T + 1e-3]), exact_end(T), strict=True)]
    assert moved[0] == pytest.approx(1e-3 * exact_end(T)[1], rel=1e-2)


def test_a_downhill_race_ends_after_the_stated_number_of_half_turns() -> None:
    """Downhill, half turns become shorter and shorter."""
    scene = bench_peers.SCENES["S"]
    first, end = (bench_peers.end_of(scene, n) for n in (1.37, 10.37))
    theta = simulate(scene, [first]).theta[0]
    assert theta == pytest.approx(scene.theta + 1.37 * math.pi, rel=1e-14)
    assert end < 10.37 / 1.37 * first
