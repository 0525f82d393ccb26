"""The fuzzer `tools/fuzz_api.py`: a short run, its coverage, and planted faults that it finds."""

import inspect
import subprocess
import sys
from typing import Any

import pytest
from oracles.paths import ROOT

TOOLS = ROOT / "tools"
CALLS = 600


@pytest.fixture(autouse=True)
def tools(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(TOOLS))


def test_a_short_run_finds_no_fault() -> None:
    """If there is a finding, the message of the assertion has the lines that reproduce it."""
    command = [sys.executable, str(TOOLS / "fuzz_api.py"), "--seed", "1", "--calls", str(CALLS)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, (
        f"{' '.join(command)}\n{done.stdout[-9000:]}\n{done.stderr[-3000:]}"
    )
    assert f"{CALLS} cases" in done.stdout


def test_the_fuzzer_draws_every_public_argument() -> None:
    """An argument of a new function needs an entry in `NUMBERS` or `OTHERS` of `fuzz/calls.py`."""
    from fuzz.calls import FUNCTIONS, NUMBERS, OTHERS, OWN, PLAIN, SLOW

    assert set(FUNCTIONS) == {*OWN, *PLAIN, *SLOW}
    names = {each for name in PLAIN for each in inspect.signature(FUNCTIONS[name]).parameters}
    assert names <= {*NUMBERS, *OTHERS}


def test_the_same_seed_draws_the_same_cases() -> None:
    from fuzz_api import Hunt

    drawn: list[list[list[str]]] = []

    class Recorder:
        def findings(self, lines: list[str]) -> list[None]:
            drawn[-1].append(lines)
            return []

    for seed in (3, 3, 4):
        drawn.append([])
        process: Any = Recorder()
        Hunt(process, seed).go(100)
    assert drawn[0] == drawn[1] != drawn[2]


def test_a_failing_case_is_shrunk(capfd: pytest.CaptureFixture[str]) -> None:
    """Here every call of simulate with restitution=1.0 is a finding. Only one is kept."""
    from fuzz.process import Finding
    from fuzz_api import Hunt

    class Touchy:
        def findings(self, lines: list[str]) -> list[Finding]:
            wrong = "restitution=1.0" in lines[0] and "rl.simulate(" in lines[0]
            return [Finding("planted", "elastic", tuple(lines[:1]))] if wrong else []

    process: Any = Touchy()
    hunt = Hunt(process, 1)
    hunt.go(1000)
    (found,) = hunt.found.values()
    assert "restitution=1.0" in found.lines[0] and "slope=0.0" in found.lines[0]
    assert "planted: elastic" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("kind", "code"),
    [
        ("crash", "__import__('os').abort()"),
        ("hang", "all(True for _ in iter(int, 1))"),
        ("deaf", "__import__('signal').signal(27, 1) and all(True for _ in iter(int, 1))"),
        ("exception", "1 / 0"),
        ("unnamed", "rl.certify(int('x'))"),
        ("warning", "__import__('warnings').warn('planted', stacklevel=1)"),
        ("nan", "{'a': (np.array([1.0, (lambda big: big - big)(4 * 2.0**1023)]),)}"),
        ("copy", "promises.same(*(rl.simulate(rl.scenes.rolling, t) for t in ([1.0], [0.5])))"),
    ],
)
def test_the_fuzzer_finds_planted_faults(kind: str, code: str) -> None:
    from fuzz.process import Process

    with Process(0.3) as process:
        assert [found.kind for found in process.findings([code])] == [kind]
