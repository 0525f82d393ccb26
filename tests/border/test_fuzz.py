"""The fuzzer of `tools/fuzz_api.py`: a short run, that it drives everything, that it sees what is
wrong."""

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


def test_nothing_is_found() -> None:
    """What it prints has the lines of each finding, to be pasted."""
    command = [sys.executable, str(TOOLS / "fuzz_api.py"), "--seed", "1", "--calls", str(CALLS)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, (
        f"{' '.join(command)}\n{done.stdout[-9000:]}\n{done.stderr[-3000:]}"
    )
    assert f"{CALLS} cases" in done.stdout


def test_every_argument_of_what_is_public_is_drawn() -> None:
    """A function that is new is called by its signature: its arguments need a line in `NUMBERS` or
    `OTHERS` of `tools/fuzz/calls.py`."""
    import inspect

    from fuzz.calls import FUNCTIONS, NUMBERS, OTHERS, OWN, PICTURES, PLAIN, RARE

    assert set(FUNCTIONS) == {*OWN, *PICTURES, *PLAIN, *RARE}
    names = {
        parameter
        for name in FUNCTIONS
        if name not in OWN
        for parameter in inspect.signature(FUNCTIONS[name]).parameters
    }
    assert names - NUMBERS.keys() - OTHERS.keys() == {"options"}


def test_a_case_is_the_same_every_time() -> None:
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


def test_a_finding_is_made_short(capfd: pytest.CaptureFixture[str]) -> None:
    """Every motion of a body with a mass of its own is a finding here, and one is printed."""
    from fuzz.process import Finding
    from fuzz_api import Hunt

    class Touchy:
        def findings(self, lines: list[str]) -> list[Finding]:
            wrong = "mass=" in lines[0] and "rl.simulate(" in lines[0]
            return [Finding("planted", "a mass", tuple(lines[:1]))] if wrong else []

    process: Any = Touchy()
    hunt = Hunt(process, 1)
    hunt.go(300)
    (found,) = hunt.found.values()
    assert "mass=10.0" in found.lines[0] and "slope=" not in found.lines[0]
    assert "planted: a mass" in capfd.readouterr().out


@pytest.mark.parametrize(
    ("kind", "code"),
    [
        ("crash", "__import__('os').abort()"),
        ("hang", "[i for i in range(10**12)]"),
        ("deaf", "__import__('signal').signal(2, 1) and [i for i in range(10**12)]"),
        ("exception", "1 / 0"),
        ("unnamed", "rl.certify(int('x'))"),
        ("warning", "__import__('warnings').warn('planted', stacklevel=1)"),
        ("nan", "{'a': (np.array([1.0, (lambda big: big - big)(4 * 2.0**1023)]),)}"),
        ("copy", "promises.same(*(rl.simulate(rl.scenes.rolling, t) for t in ([1.0], [0.5])))"),
    ],
)
def test_it_sees(kind: str, code: str) -> None:
    from fuzz.process import Process

    with Process(0.3) as process:
        assert [found.kind for found in process.findings([code])] == [kind]
