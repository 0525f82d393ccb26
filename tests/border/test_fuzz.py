"""The fuzzer of `tools/fuzz_api.py`: a short run, that it drives everything, that it sees what is
wrong."""

import inspect
import json
import subprocess
import sys
from pathlib import Path

import pytest
import rolling_ellipse as rl
from oracles.paths import ROOT

TOOLS = ROOT / "tools"
CALLS = 600


@pytest.fixture(autouse=True)
def tools(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(TOOLS))


def test_nothing_is_found() -> None:
    """What it prints has the seed and index of each finding, to run that case alone."""
    command = [sys.executable, str(TOOLS / "fuzz_api.py"), "--seed", "1", "--calls", str(CALLS)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, (
        f"{' '.join(command)}\n{done.stdout[-9000:]}\n{done.stderr[-3000:]}"
    )
    assert f"{CALLS} cases" in done.stdout


def test_a_case_is_the_same_every_time() -> None:
    from fuzz.calls import case

    drawn = [case(3, index) for index in range(200)]
    assert drawn == [case(3, index) for index in range(200)] != [case(4, i) for i in range(200)]


def test_everything_public_is_driven() -> None:
    """A function that is new needs an entry in the table of `tools/fuzz/calls.py`."""
    from fuzz.calls import case

    missing = {
        f"{prefix}{name}"
        for prefix, module in (
            ("", rl), ("geometry.", rl.geometry), ("impacts.", rl.impacts), ("report.", rl.report),
        )
        for name in module.__all__
        if inspect.isfunction(getattr(module, name))
    }  # fmt: skip
    for index in range(200_000):  # pictures take long, and each is one of some 10 000 cases
        missing -= {line.does for line in case(5, index)[1]}
        if not missing:
            return
    pytest.fail(f"never called: {sorted(missing)}")


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
    ],
)
def test_it_sees(kind: str, code: str, tmp_path: Path) -> None:
    from fuzz.__main__ import main

    report = tmp_path / "findings.json"
    assert main(["--code", code, "--seconds-per-call", "0.3", "--report", str(report)]) == 1
    assert [each["kind"] for each in json.loads(report.read_text())] == [kind]
