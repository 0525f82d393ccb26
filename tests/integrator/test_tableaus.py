"""The coefficients of the integrators, rounded to doubles, satisfy their order conditions.

Explicit methods are tested with rooted trees: a method has order p if, for every tree of up to p
nodes, phi(tree) = 1/gamma(tree) (J. C. Butcher; E. Hairer, S. P. Norsett, G. Wanner, Solving
Ordinary Differential Equations I, II.2). Implicit methods are tested with the simplifying
assumptions B, C, D (the same work, II.7 and IV.5). The arithmetic is long double, whose roundings
are 2000 times smaller.
"""

from collections.abc import Callable, Iterator
from functools import cache, reduce
from math import prod
from typing import Any, NamedTuple

import numpy as np
import pytest
from rolling_ellipse import _core

Long = Any  # an array of np.longdouble
Tree = tuple[Any, ...]  # the branches, sorted; () is a single node
TABLEAUS = _core.tableaus()
EXPLICIT = ("rk4", "dopri5", "dop853")
GAUSS = ("gauss2", "gauss3", "gauss4")
ROUNDING = 2.0**-53  # relative rounding of one coefficient


def long(values: Any) -> Long:
    return np.array(values, np.longdouble)


class Violation(AssertionError):
    """A condition that the coefficients do not satisfy."""


def require(actual: Long, exact: Any, terms: Long, factors: int) -> None:
    """Require `actual` to equal `exact` within rounding. `actual` is a sum of products of up to
    `factors` rounded numbers, and `terms` is the sum of the magnitudes of the products. Each factor
    may be off by its own rounding, or by twice that if it was computed."""
    off = np.abs(long(actual) - exact)
    allowed = 2 * factors * ROUNDING * long(terms)
    if not np.all(off <= allowed):
        raise Violation(f"off by {float(np.max(off)):.3g}, allowed {float(np.max(allowed)):.3g}")


def test_every_tableau_is_tested() -> None:
    assert {*EXPLICIT, *GAUSS, "radau"} == TABLEAUS.keys()
    assert tuple(DENSE_ORDERS) == EXPLICIT


@cache
def trees(nodes: int) -> tuple[Tree, ...]:
    """Rooted trees with the given number of nodes."""
    return tuple(forests(nodes - 1, nodes - 1))


def forests(nodes: int, largest: int) -> Iterator[Tree]:
    """Multisets of trees with the given total number of nodes, no tree larger than `largest`."""
    if nodes == 0:
        yield ()
        return
    for size in range(min(nodes, largest), 0, -1):
        for branch in trees(size):
            for rest in forests(nodes - size, size):
                if not rest or (size_of(branch), branch) >= (size_of(rest[0]), rest[0]):
                    yield (branch, *rest)


@cache
def size_of(tree: Tree) -> int:
    return 1 + sum(size_of(branch) for branch in tree)


@cache
def gamma(tree: Tree) -> int:
    return size_of(tree) * prod(gamma(branch) for branch in tree)


def elementary_weight(a: Long, b: Long) -> Callable[[Tree], Long]:
    """phi of a method, as a function of the tree."""

    @cache
    def stage_weight(tree: Tree) -> Long:
        return reduce(np.multiply, (a @ stage_weight(branch) for branch in tree), np.ones_like(b))

    return lambda tree: b @ stage_weight(tree)


def require_order(a: Long, b: Long, sizes: Long, order: int, s: float = 1.0) -> None:
    """Require that the weights b give the solution at the fraction s of a step to the given order.
    For s = 0 this requires that phi vanishes, as for the difference of the weights of two methods.
    Each weight is a sum of terms, the magnitudes of which add up to `sizes`."""
    phi, size = elementary_weight(a, b), elementary_weight(np.abs(a), sizes)
    for nodes in range(1, order + 1):
        for tree in trees(nodes):
            require(phi(tree), long(s) ** nodes / gamma(tree), size(tree), nodes)


def test_rooted_trees_are_counted_correctly() -> None:
    """Counts of rooted trees are OEIS A000081; gamma has its known values for 3 and 4 nodes."""
    assert [len(trees(n)) for n in range(1, 10)] == [1, 1, 2, 4, 9, 20, 48, 115, 286]
    assert all(len(set(trees(n))) == len(trees(n)) for n in range(1, 10))
    assert {gamma(tree) for tree in trees(3)} == {3, 6}
    assert sorted(gamma(tree) for tree in trees(4)) == [4, 8, 12, 24]


class Explicit(NamedTuple):
    """Coefficients of an explicit method, in long double."""

    order: int
    stages: int
    c: Long
    a: Long  # all stages: for the step, for the slope at its end, for the dense output
    error: Long
    dense: Long

    @property
    def b(self) -> Long:
        return self.a[self.stages]


def explicit(name: str) -> Explicit:
    t = TABLEAUS[name]
    error, dense = t["error"][: t["error_estimates"]], t["dense"][: t["dense_terms"]]
    return Explicit(t["order"], t["stages"], *map(long, (t["c"], t["a"], error, dense)))


# orders of the embedded results from which the error is estimated, and of the dense output
ERROR_ORDERS = {"rk4": (), "dopri5": (4,), "dop853": (5, 3)}
DENSE_ORDERS = {"rk4": 3, "dopri5": 4, "dop853": 7}


def dense_weights(method: Explicit, s: float) -> tuple[Long, Long]:
    """b_j(s) of y(s) - y(0) = s (F0 + (1-s) (F1 + s (F2 + (1-s) (F3 + s (F4 + ...))))), with F0 =
    y(1) - y(0), F1 = h y'(0) - F0, F2 = 2 F0 - h (y'(0) + y'(1)); and the sums of the magnitudes of
    their terms."""
    b = method.b
    before, after = np.eye(len(b), dtype=np.longdouble)[[0, method.stages]]
    terms = [b, before - b, 2 * b - before - after, *method.dense]
    sizes = [np.abs(b), before + np.abs(b), 2 * np.abs(b) + before + after, *np.abs(method.dense)]

    def nested(values: list[Long]) -> Long:
        total = np.zeros_like(b)
        for i in reversed(range(len(values))):
            total = values[i] + (1 - long(s) if i % 2 == 0 else long(s)) * total
        return long(s) * total

    return nested(terms), nested(sizes)


def check_explicit(name: str, **changed: Long) -> None:
    method = explicit(name)._replace(**changed)
    a, b = method.a, method.b
    require(a.sum(axis=1), method.c, np.abs(a).sum(axis=1) + method.c, 1)
    require_order(a, b, np.abs(b), method.order)
    for weights, order in zip(method.error, ERROR_ORDERS[name], strict=True):
        require_order(a, weights, np.abs(weights) + np.abs(b), order, 0.0)
    for weights in method.dense:  # these terms vanish if the solution is a cubic polynomial
        require_order(a, weights, np.abs(weights), 3, 0.0)
    for s in (0.1, 0.37, 0.5, 0.83, 1.0):
        require_order(a, *dense_weights(method, s), DENSE_ORDERS[name], s)


@pytest.mark.parametrize("name", EXPLICIT)
def test_stages_of_explicit_methods_use_only_earlier_stages(name: str) -> None:
    method = explicit(name)
    assert np.all(np.triu(method.a) == 0)
    assert method.c[0] == 0 and method.c[method.stages] == 1
    assert np.all(method.error[:, method.stages + 1 :] == 0)


@pytest.mark.parametrize("name", EXPLICIT)
def test_no_method_has_a_higher_order_than_stated(name: str) -> None:
    method = explicit(name)
    with pytest.raises(Violation):
        require_order(method.a, method.b, np.abs(method.b), method.order + 1)
    with pytest.raises(Violation):
        require_order(method.a, *dense_weights(method, 0.37), DENSE_ORDERS[name] + 1, 0.37)
    for weights, order in zip(method.error, ERROR_ORDERS[name], strict=True):
        phi = elementary_weight(method.a, weights)
        assert any(abs(phi(tree)) > 1e-6 for tree in trees(order + 1))


def test_the_error_estimate_of_dopri5_uses_its_fourth_order_weights() -> None:
    """From J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19, Table 2."""
    lower = [5179 / 57600, 0, 7571 / 16695, 393 / 640, -92097 / 339200, 187 / 2100, 1 / 40]
    method = explicit("dopri5")
    require(method.error[0], method.b - lower, np.abs(method.b) + np.abs(lower), 1)


def powers(c: Long, highest: int) -> tuple[Long, Long]:
    """Exponents k = 1 ... highest as a row, and c_i^(k-1) in row i."""
    k = np.arange(1, highest + 1)
    return k, c[:, None] ** (k - 1)


def check_quadrature(b: Long, c: Long, order: int) -> None:
    """B(order): the weights integrate polynomials of degree below the order."""
    k, ck = powers(c, order)
    require(b @ ck, long(1) / k, b @ ck, order)


def check_stages(a: Long, sizes: Long, c: Long, order: int) -> None:
    """C(order): the stages integrate polynomials of degree below the order."""
    k, ck = powers(c, order)
    exact = c[:, None] ** k / k
    require(a @ ck, exact, sizes @ ck + exact, order + 1)


def check_dual(a: Long, sizes: Long, b: Long, c: Long, order: int) -> None:
    """D(order): sum_i b_i c_i^(k-1) a_ij = b_j (1 - c_j^k)/k."""
    k, ck = powers(c, order)
    weighted = b[:, None] * ck
    exact = b[:, None] * (1 - c[:, None] ** k) / k
    require(a.T @ weighted, exact, sizes.T @ weighted + b[:, None], order + 2)


def check_gauss(c: Long, b: Long, mu: Long, nu: Long) -> None:
    stages = len(c)
    if np.any(mu + mu.T != 1):  # long double holds these sums exactly
        raise Violation("mu_ij + mu_ji is not 1")
    sizes = (np.abs(mu) + 1) * b  # mu_ij and mu_ji are rounded together, to an absolute error
    check_quadrature(b, c, 2 * stages)
    check_stages(mu * b, sizes, c, stages)
    check_dual(mu * b, sizes, b, c, stages)
    # Stages of the next step: the polynomial of degree below the number of stages through the
    # slopes of this step, integrated from the end of the step to 1 + c_i.
    k, ck = powers(c, stages)
    foreseen = ((1 + c[:, None]) ** k - 1) / k
    require((nu * b) @ ck, foreseen, np.abs(nu * b) @ ck + foreseen, stages + 2)


def check_radau(
    c: Long, gamma: Long, alpha: Long, beta: Long, transform: Long, inverse_transform: Long
) -> None:
    """The matrix a = T inverse(eigenvalues) inverse(T), with the transform T, has order 5."""
    if c[-1] != 1:
        raise Violation("the last stage is not the end of the step")
    sizes = np.abs(transform) @ np.abs(inverse_transform)
    require(transform @ inverse_transform, np.eye(3), sizes, 2)
    zero, square = np.zeros_like(alpha), alpha**2 + beta**2
    inverse = long([[square / gamma, zero, zero], [zero, alpha, beta], [zero, -beta, alpha]])
    product = (transform, inverse / square, inverse_transform)
    a = np.linalg.multi_dot(product)
    sizes = np.linalg.multi_dot([np.abs(m) for m in product])
    check_quadrature(a[-1], c, 5)
    check_stages(a, sizes, c, 3)
    check_dual(a, sizes, a[-1], c, 2)


def collocation(name: str) -> dict[str, Long]:
    return {key: long(values) for key, values in TABLEAUS[name].items()}


def check(name: str, **changed: Long) -> None:
    """Require the order of a method, some of whose coefficients may be changed: 2s for Gauss, from
    B(2s), C(s), D(s); 5 for Radau IIA, from B(5), C(3), D(2)."""
    if name in EXPLICIT:
        check_explicit(name, **changed)
    else:
        (check_gauss if name in GAUSS else check_radau)(**collocation(name) | changed)


def coefficients(name: str) -> Iterator[tuple[str, Long, Any]]:
    """Name of an array, the array and an index, for each number that a method uses."""
    if name in EXPLICIT:
        arrays = {field: getattr(explicit(name), field) for field in ("c", "a", "error", "dense")}
    else:
        arrays = collocation(name)
    for field, values in arrays.items():
        for index in np.ndindex(values.shape):
            if values[index] or name not in EXPLICIT:
                yield field, values, index


@pytest.mark.parametrize("name", TABLEAUS)
def test_methods_have_their_stated_orders_and_a_wrong_digit_is_detected(name: str) -> None:
    """A change of 1e-12 in any coefficient violates one of the conditions."""
    check(name)
    for field, values, index in coefficients(name):
        wrong = values.copy()
        wrong[index] += 1e-12
        with pytest.raises(Violation):
            check(name, **{field: wrong})


@pytest.mark.parametrize("name", GAUSS)
def test_no_gauss_method_has_a_higher_order_than_stated(name: str) -> None:
    method = collocation(name)
    with pytest.raises(Violation):
        check_quadrature(method["b"], method["c"], 2 * len(method["c"]) + 1)
    with pytest.raises(Violation):
        sizes = (np.abs(method["mu"]) + 1) * method["b"]
        check_stages(method["mu"] * method["b"], sizes, method["c"], len(method["c"]) + 1)


@pytest.mark.parametrize("name", GAUSS)
def test_gauss_weights_are_symmetric(name: str) -> None:
    """c_i + c_(s+1-i) = 1 and b_i = b_(s+1-i): the reversed step undoes the step."""
    method = collocation(name)
    assert np.array_equal(method["b"], method["b"][::-1])
    require(method["c"] + method["c"][::-1], 1, np.ones_like(method["c"]), 1)
    require(method["mu"] + method["mu"][::-1, ::-1], 1, np.abs(method["mu"]) + 1, 1)
