"""Problems whose bodies roll all the time, as differential-algebraic equations."""

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebpts1
from numpy.polynomial.polynomial import polyder, polyfit, polyval
from oracles.paths import ROOT
from rolling_ellipse import Scene, benchmark

NAMES = [f"roll.{name}" for name in ("circle", "rock", "roll", "thin")]
NAMES += ["brink.back", "brink.over", "rest.lie"]
FORMS = ["index3", "index2", "index1", "ggl"]
PAGE = (ROOT / "docs" / "benchmark_dae.md").read_text(encoding="utf-8")
UPHILL = Scene(0.7, 1.9, mass=3.0, inertia=2.0, slope=0.1, omega=-2.0, theta=1.5, friction=np.inf)


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", [*NAMES, "uphill"])
def test_the_exact_motion_satisfies_the_equations_and_the_jacobian_is_right(
    name: str, form: str
) -> None:
    """The residual F is no larger than the change that 8 ulps of each entry of y and y' can cause.
    This covers the rounding errors of the motion and of F.

    Central differences have an error of step^2/6 = 2e-11 times the third derivatives, which for the
    thin body are about (a/b)^4 times the Jacobian, and a rounding error of 1e-16/step.
    """
    one = benchmark.problem("roll.rock" if name == "uphill" else name)
    if name == "uphill":
        one = replace(one, scene=UPHILL, times=np.linspace(0, 0.6, 7))
    dae, at = one.dae(form), one.trajectory.sol(one.times)
    y, yp = dae.exact(one.times), np.tile(0 * dae.y0, (one.times.size, 1))
    assert np.array_equal(dae.states(y), one.exact(one.times)) and y.shape[1] == len(dae.names)
    yp[:, :5] = y[:, 5:10]
    yp[:, 5:10] = np.stack([at.x_ddot, at.z_ddot, at.omega_dot, at.psi_ddot, at.r_ddot], axis=1)
    assert np.array_equal(yp[0], dae.yp0) and np.array_equal(y[0], dae.y0)
    given = [dae.residual(0.0, kind(y[-1]), kind(yp[-1])) for kind in (list, np.array)]
    assert np.array_equal(*given)
    for row in zip(y, yp, dae.residual(one.times, y, yp), strict=True):
        by_y, both = (dae.jacobian(0.0, *row[:2], cj) for cj in (0.0, 1.0))
        sizes = abs(by_y) @ abs(row[0]) + abs(both - by_y) @ abs(row[1])
        assert np.all(abs(row[2]) <= 8 * np.finfo(float).eps * sizes)
        assert np.array_equal(dae.algebraic, (both == by_y).all(axis=0))
    rng, steps = np.random.default_rng(33), 1e-5 * np.eye(y.shape[1])
    y, yp = y[-1] + 0.1 * rng.normal(size=y.shape[1]), yp[-1] + rng.normal(size=y.shape[1])
    ahead, behind = (dae.residual(0.0, y + s, yp + 0.7 * s) for s in (steps, -steps))
    jacobian = dae.jacobian(0.0, y, yp, 0.7)
    assert np.max(abs((ahead - behind).T / 2e-5 - jacobian)) < 1e-6 * np.max(abs(jacobian))


def determined(dae: benchmark.Dae, k: int) -> Any:
    """Mask of the entries of y' that F and its first k derivatives determine, at 1 s.

    The derivative of Taylor coefficient i of F along the motion with respect to coefficient j of y
    is A[i-j] + j E[i-j+1], where the coefficients of A = F_y and E = F_y' are fitted around 1 s.
    """
    nodes, width = chebpts1(17), 0.05
    y = dae.exact(1 + width * nodes)
    yp = polyval(nodes, polyder(polyfit(nodes, y, 12))).T / width
    rows, n, numbers = list(zip(y, yp, strict=True)), y.shape[1], range(1, k + 2)

    def fitted(cj: float) -> Any:
        """Coefficients of F_y + cj F_y', followed by zeros, which negative indices select."""
        values = [dae.jacobian(0.0, *row, cj).ravel() for row in rows]
        found = polyfit(nodes, np.array(values), 12)[: k + 2]
        return np.vstack([found, np.zeros((k + 2, n * n))]).reshape(-1, n, n)

    a, e = fitted(0.0), fitted(1 / width) - fitted(0.0)
    array = np.block([[a[i - j] + j * e[i - j + 1] for j in numbers] for i in range(k + 1)])
    _, sizes, directions = np.linalg.svd(array)
    return abs(directions[sizes < 1e-10 * sizes[0], :n]).max(axis=0, initial=0.0) < 1e-4


@pytest.mark.parametrize(
    ("name", "form", "least"),
    [
        ("roll.rock", "index3", "00000 00022 3331"), ("roll.circle", "index3", "00000 00022 2331"),
        ("roll.rock", "index2", "00000 00011 2221"), ("roll.rock", "index1", "00000 00000 1111"),
        ("roll.rock", "ggl", "00000 00011 2221 222"), ("roll.thin", "ggl", "00000 00011 2221 222"),
    ],
)  # fmt: skip
def test_the_index_is_the_largest_number_of_differentiations(
    name: str, form: str, least: str
) -> None:
    """The strings list how many differentiations are needed to determine each entry of y'."""
    dae = benchmark.problem(name).dae(form)
    found = sum((~determined(dae, k)).astype(int) for k in range(dae.index + 1))
    assert "".join(map(str, found)) == least.replace(" ", "")
    assert max(found) == dae.index


def program(library: str) -> Any:
    """The function `solve` that the page shows for a library."""
    pytest.importorskip(library)
    names: dict[str, Any] = {}
    programs = re.findall(r"```python\n(.*?)```", PAGE, re.S)
    exec(next(each for each in programs if f"from {library}" in each), names)
    return names["solve"]


@pytest.mark.parametrize("form", ["index2", "ggl"])
def test_solve_dae_stays_within_its_tolerance(form: str) -> None:
    """The page's program, which stores states as columns, is run for a second; the table on the
    page covers whole motions."""
    table = PAGE.partition("<!-- radau")[2].partition("<!-- end of radau")[0]
    errors = [float(each) for each in re.findall(rf"\| {form} \| (\S+) \|.* done \|", table)]
    assert len(errors) == 3 and max(errors) <= 1e-8
    solve, one = program("solve_dae"), benchmark.problem("roll.roll")
    dae, times = one.dae(form), one.times[one.times <= 1.0]
    found = solve(dae, times, 1e-8)
    assert found.success and found.t[-1] == times[-1] == 1.0
    assert np.max(abs(dae.states(found.y.T) - one.exact(times)) / one.scales) < 1e-8


def test_ida_stays_within_its_tolerance() -> None:
    """The page's program is run on one problem; all problems of the table would take minutes."""
    errors = re.findall(r"\n\| (\S+) \| (index1|ggl) \|[^|]*\| q, v \| (\S+) \|", PAGE)
    assert {row[:2] for row in errors} == {(name, form) for name in NAMES for form in FORMS[2:]}
    assert max(float(error) for *_, error in errors) <= 1e-8
    solve = program("sksundae")
    one = benchmark.problem("brink.over")
    times, states = one.times[one.times < one.horizon], one.states[one.times < one.horizon]
    for form in FORMS[2:]:
        dae = one.dae(form)
        found = solve(dae, times, 3e-14, ~dae.algebraic)
        assert np.max(abs(dae.states(found.y) - states) / one.scales) < 1e-8
    # with the multipliers included in the error test, IDA fails
    found = solve(dae, times, 3e-14, np.ones_like(dae.algebraic))
    assert not found.success and found.t[-1] < 0.1
