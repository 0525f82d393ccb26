"""Impacts under three laws agree with small steps along the impulse path, and a fit recovers the
coefficients of a series of impacts."""

import math
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot
from oracles.numbers import EPS
from rolling_ellipse import course, geometry, impacts

LAWS = impacts.LAWS
ENERGY_KEEPING: tuple[Any, ...] = ("stronge", "poisson")
BODY: dict[str, Any] = {"a": 0.7, "b": 0.3}
K2 = (0.7**2 + 0.3**2) / 4


def approaching(count: int, seed: int = 1, **body: float) -> np.ndarray:
    """theta, x_dot, z_dot, omega of approaching contacts with any slip, shape (4, n)."""
    rng = np.random.default_rng(seed)
    theta, omega = rng.uniform(-4, 4, count), rng.normal(0, 3, count)
    shape = body or BODY
    h, slope = (f(theta, **shape) for f in (geometry.support, geometry.support_slope))
    x_dot = h * omega + rng.normal(0, 1.5, count)
    z_dot = slope * omega - rng.uniform(0.1, 2, count)
    return np.stack([theta, x_dot, z_dot, omega])


def contact(state: np.ndarray, velocities: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Slip and gap rate of velocities, at the angle of a state."""
    h, slope = (f(state[0], **BODY) for f in (geometry.support, geometry.support_slope))
    return velocities[0] - h * velocities[2], velocities[1] - slope * velocities[2]


def speed(velocities: np.ndarray, k2: float = K2) -> np.ndarray:
    return np.sqrt(velocities[0] ** 2 + velocities[1] ** 2 + k2 * velocities[2] ** 2)


def after(state: Any, law: Any, friction: float, restitution: float, **body: Any) -> np.ndarray:
    """Velocities after an impact, shape (3, ...)."""
    given = BODY | body | {"friction": friction, "restitution": restitution, "law": law}
    return np.stack(impacts.collide(*state, **given))


PUSHES = 5000  # steps of the oracle; each impulse step is the approach speed over PUSHES


def walked(law: Any, state: np.ndarray, friction: float, restitution: float) -> np.ndarray:
    """Velocities after many small normal impulses. Each is followed by the friction that stops the
    slip, limited by the cone, and by a check of whether restitution is complete. The oracle does
    not distinguish cases. The velocities follow from Newton's and Euler's laws for unit mass."""
    theta, x_dot, z_dot, omega = state
    h, slope = (f(theta, **BODY) for f in (geometry.support, geometry.support_slope))
    first = u = contact(state, state[1:])[1]
    step = -first / PUSHES
    impulse: Any = 0.0
    work: Any = 0.0
    compression_impulse = compression_work = 0.0
    while True:
        # trial slip after the normal impulse alone; G_tt = 1 + h^2/k^2
        trial = x_dot - h * (omega - slope * step / K2)
        pull = float(np.clip(-trial / (1 + h * h / K2), -friction * step, friction * step))
        x_dot, z_dot = x_dot + pull, z_dot + step
        omega -= (h * pull + slope * step) / K2
        u_before, u = u, z_dot - slope * omega
        impulse, work = impulse + step, work + step * (u_before + u) / 2
        if u < 0:
            compression_impulse, compression_work = impulse, work
        elif {
            "stronge": work - compression_work >= -(restitution**2) * compression_work,
            "poisson": impulse >= (1 + restitution) * compression_impulse,
            "newton": u >= -restitution * first,
        }[law]:
            return np.array([x_dot, z_dot, omega])


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("friction", "restitution"), [(0.1, 0.9), (0.4, 0.6), (1.1, 0.3), (0, 1)])
def test_laws_agree_with_small_steps_along_the_impulse_path(
    law: Any, friction: float, restitution: float
) -> None:
    """The oracle ends compression up to a step late, which restitution at most doubles, and ends
    restitution up to a step late. Friction makes a step up to sqrt(1 + mu^2) < 1.5 times as large,
    and changes the velocities by up to sqrt(1 + (h^2 + h'^2)/k^2) < 2.1 times a step. Three steps
    change them by 2e-3 of the approach speed."""
    for state in approaching(25, seed=3).T:
        found = after(state, law, friction, restitution)
        true = walked(law, state, friction, restitution)
        approach = -contact(state, state[1:])[1]
        assert speed(found - true) < 2e-3 * approach


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("friction", [0.0, 0.15, 0.8, math.inf])
def test_the_impulse_acts_at_the_contact_within_the_friction_cone(
    law: Any, friction: float
) -> None:
    """The bound is a hundred roundings of the largest velocities, 10 m/s."""
    state = approaching(400)
    velocities = after(state, law, friction, 0.7)
    h, slope = (f(state[0], **BODY) for f in (geometry.support, geometry.support_slope))
    tangential, normal, spin = velocities - state[1:]
    small = 100 * EPS * 10
    # angular momentum about the contact
    assert np.max(np.abs(K2 * spin + h * tangential + slope * normal)) < small
    assert np.all(normal > -small)
    if math.isfinite(friction):
        assert np.all(np.abs(tangential) <= friction * normal + small)
    assert np.all(contact(state, velocities)[1] > -small)


@pytest.mark.parametrize("law", ENERGY_KEEPING)
def test_stronge_and_poisson_create_no_energy(law: Any, shape: tuple[float, float]) -> None:
    a, b = shape
    state = approaching(1000, seed=4, a=a, b=b)
    k2 = (a * a + b * b) / 4
    for friction in (0.0, 0.1, 0.5, 1.2, 1e6, math.inf):
        for restitution in (0.0, 0.5, 0.9, 1.0):
            found = after(state, law, friction, restitution, a=a, b=b)
            # the bound is a hundred roundings
            assert np.all(speed(found, k2) <= speed(state[1:], k2) * (1 + 100 * EPS))


def test_a_thin_fast_turning_body_of_small_inertia_gains_no_energy() -> None:
    """h' omega can exceed 100 times z_dot, so no velocity may be a difference of two such terms.

    The three velocities have about ten roundings each, and the energy has twice as many.
    """
    random = np.random.default_rng(6)
    body: dict[str, Any] = {"a": 1.0, "b": 0.05, "gyration2": 1e-4}
    theta = random.choice([1.0, -1.0], 4000) * random.uniform(0.002, 0.05, 4000)
    omega = random.uniform(-60, 60, 4000)  # k omega is up to 0.6 m/s
    before = np.array([random.uniform(-0.2, 0.2, 4000), random.uniform(-1, 1, 4000), omega])
    slope = geometry.support_slope(theta, a=1.0, b=0.05)
    hits = before[1] < slope * omega
    theta, before, slope = theta[hits], before[:, hits], slope[hits]
    assert np.max(np.abs(slope * before[2] / before[1])) > 100
    k2 = body["gyration2"]
    for friction in (0.0, 0.3, math.inf):
        found = after((theta, *before), "stronge", friction, 1, **body)
        gained = speed(found, k2) ** 2 / speed(before, k2) ** 2 - 1
        assert np.max(gained) < 40 * EPS
        if friction == 0:
            assert np.min(gained) > -40 * EPS


def test_newtons_law_can_create_energy() -> None:
    """The contact is behind the centre and slips forwards, so that friction increases the speed of
    approach until the slip stops. The initial u does not contain this increase, and Newton's law
    returns more energy than was absorbed."""
    theta = -math.pi / 4
    h, slope = geometry.support(theta, **BODY), geometry.support_slope(theta, **BODY)
    before = np.array([0.5, -1.0, 0.0])  # no spin: slip 0.5 m/s, approach 1 m/s
    assert h > 0 > slope
    found = {law: after((theta, *before), law, 0.6, 1.0) for law in LAWS}
    ratio = {law: float(speed(velocities) / speed(before)) for law, velocities in found.items()}
    assert ratio["newton"] ** 2 > 1.15
    assert all(ratio[law] <= 1 + 100 * EPS for law in ENERGY_KEEPING)


def test_newtons_restitution_is_the_ratio_of_gap_rates() -> None:
    state = approaching(300)
    rates = contact(state, after(state, "newton", 0.3, 0.4))[1]
    assert np.max(np.abs(rates + 0.4 * contact(state, state[1:])[1])) < 1000 * EPS


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.4, 1.1, math.inf])
def test_poissons_restitution_is_the_ratio_of_impulses(friction: float) -> None:
    """The impulse of restitution is e times that of compression, which is the whole impulse if
    e = 0. An impulse is computed as a change of z_dot (0.1 to 10 m/s, at velocities up to 10 m/s),
    with about ten roundings."""
    state = approaching(300)
    compression, whole = (after(state, "poisson", friction, e)[1] - state[2] for e in (0.0, 0.4))
    assert np.max(np.abs(whole - 1.4 * compression)) < 1000 * EPS


def test_the_laws_agree_without_friction_or_restitution() -> None:
    """Without friction the path is straight, so that work, impulse and speed agree on its end. With
    e = 0 every law ends at the end of compression."""
    state = approaching(300)
    for friction, restitution in ((0.0, 0.6), (0.0, 1.0), (0.5, 0.0), (math.inf, 0.0)):
        found = [after(state, law, friction, restitution) for law in LAWS]
        for other in found[1:]:
            assert np.max(speed(other - found[0])) < 1e-13  # roundings of ten velocities


@pytest.mark.parametrize("law", LAWS)
def test_unlimited_friction_is_the_limit_of_large_friction(law: Any) -> None:
    """The difference falls like 1/mu: ten times the friction leaves a tenth of it."""
    state = approaching(300)
    limit, much, more = (after(state, law, mu, 0.7) for mu in (math.inf, 1e5, 1e6))
    ratio = np.max(speed(much - limit)) / np.max(speed(more - limit))
    assert ratio == pytest.approx(10, rel=0.02)


@pytest.mark.parametrize("law", LAWS)
def test_a_separating_contact_keeps_its_velocities(law: Any) -> None:
    found = impacts.collide(0.4, 1.0, 2.0, 0.5, **BODY, friction=0.3, restitution=0.5, law=law)
    assert found == (1.0, 2.0, 0.5)


def test_the_default_body_is_a_uniform_disc() -> None:
    state: Any = approaching(5)
    law: dict[str, Any] = {**BODY, "friction": 0.2, "restitution": 0.5}
    default, disc, ring = (
        np.stack(impacts.collide(*state, **law, gyration2=k2)) for k2 in (None, K2, 2 * K2)
    )
    assert np.array_equal(default, disc) and not np.allclose(default, ring)


def test_kinetic_speed_follows_from_the_kinetic_energy() -> None:
    assert impacts.kinetic_speed(2.0, -3.0, 4.0, gyration2=2.25) == 7.0  # sqrt(4 + 9 + 36)
    both = impacts.kinetic_speed([[3.0], [0.0]], 4.0, [0.0, 1.0], gyration2=9.0)
    assert np.allclose(both, np.sqrt([[25, 34], [16, 25]]), rtol=4 * EPS)


E, MU = 0.61, 0.25  # true values, which are not points of the first grid of the fit


def series(law: Any, noise: float, count: int = 1000) -> tuple[Any, Any]:
    """Impacts with the coefficients E and MU, and with noise of equal energy in each direction."""
    before = approaching(count, seed=7)
    blur = np.random.default_rng(8).normal(0, 1, (3, count)) * noise
    return before, after(before, law, MU, E) + blur / np.array([[1.0], [1.0], [math.sqrt(K2)]])


@pytest.mark.parametrize("minimise", ["median", "rms"])
@pytest.mark.parametrize("law", LAWS)
def test_the_fit_recovers_the_coefficients_from_exact_data(law: Any, minimise: Any) -> None:
    """The fit is exact to its smallest step, 1/10240 of the range of each coefficient."""
    fitted = impacts.fit(*series(law, 0.0, 60), **BODY, law=law, minimise=minimise)
    assert fitted.restitution == pytest.approx(E, abs=1 / 10240)
    assert math.atan(fitted.friction) == pytest.approx(math.atan(MU), abs=math.pi / 2 / 10240)
    assert fitted.law == law and fitted.errors.shape == (60,)


def test_the_median_fit_ignores_outliers() -> None:
    before, found = series("stronge", 0.02)
    found[:, ::10] *= -3.0
    median, rms = (impacts.fit(before, found, **BODY, minimise=by) for by in ("median", "rms"))
    assert median.restitution == pytest.approx(E, abs=0.02)
    assert median.friction == pytest.approx(MU, abs=0.02)
    assert abs(rms.restitution - E) > 0.04
    assert median.median_error < rms.median_error and rms.rms_error < median.rms_error


def test_errors_are_those_of_the_fitted_coefficients() -> None:
    before, seen = series("newton", 0.1, 50)
    fitted, again = (impacts.fit(before, seen, **BODY, law="stronge") for _ in range(2))
    assert (again.restitution, again.friction) == (fitted.restitution, fitted.friction)

    def errors(de: float = 0.0, dmu: float = 0.0) -> np.ndarray:
        moved = after(before, "stronge", fitted.friction + dmu, fitted.restitution + de)
        return speed(moved - seen)

    assert np.allclose(fitted.errors, errors(), rtol=1e-12)
    assert fitted.median_error == np.median(fitted.errors)
    assert fitted.rms_error == pytest.approx(math.sqrt(np.mean(fitted.errors**2)), rel=1e-14)
    for de, dmu in ((0.05, 0), (-0.05, 0), (0, 0.05), (0, -0.05)):
        assert np.median(errors(de, dmu)) > fitted.median_error


def test_sticking_impacts_bound_friction_from_below() -> None:
    """Any friction above the largest |J_t|/J_n of sticking impacts gives the same velocities."""
    before: Any = approaching(200, seed=9)
    left: Any = after(before, "stronge", math.inf, 0.5)
    normal = left[1] - before[2]
    kept = normal > 0.05  # friction alone may stop the approach at a smaller impulse
    before, left = before[:, kept], left[:, kept]
    enough = np.max(np.abs(left[0] - before[1]) / normal[kept])
    fitted = impacts.fit(before, left, **BODY, minimise="rms")
    assert fitted.restitution == pytest.approx(0.5, abs=1e-3)
    assert fitted.friction > 0.95 * enough


DIE: dict[str, Any] = {"a": 0.035, "b": 0.025}


def thrown(seed: int, count: int, law: Any = "stronge", top: float = 0.25) -> tuple[Any, Any, Any]:
    """True e and mu, states before the impacts, and velocities after them with camera noise."""
    rng = np.random.default_rng(seed)
    true = rng.uniform((0.3, 0.08), (0.8, top))
    before = rng.uniform((-1.5, 0, -2.8, -8), (1.5, 1, -2.4, 8), (count, 4)).T
    noise = rng.normal(0, 1, (3, count)) * np.array([[0.03], [0.03], [2.0]])
    return true, before, after(before, law, true[1], true[0], **DIE) + noise


@pytest.mark.parametrize("law", LAWS)
def test_the_fit_is_as_good_as_the_best_of_a_fine_grid(law: Any) -> None:
    """The median has many local minima. From a coarse grid, a search may miss the lowest."""
    angle = np.linspace(0, math.pi / 2, 121)
    e: Any = np.linspace(0, 1, 121)
    mu: Any = np.append(np.tan(angle[:-1]), math.inf)
    k2 = (0.035**2 + 0.025**2) / 4
    for seed in range(6):
        _, before, seen = thrown(seed, 24, law, top=0.5)
        grid = after(before[:, None, None], law, mu[:, None], e[:, None, None], **DIE)
        off = np.sort(speed(grid - seen[:, None, None], k2))
        median, rms = ((off[..., 11] + off[..., 12]) / 2).min(), np.sqrt(np.mean(off**2, -1).min())
        assert impacts.fit(before, seen, **DIE, law=law).median_error <= median
        assert impacts.fit(before, seen, **DIE, law=law, minimise="rms").rms_error <= rms


def test_the_fit_to_the_course_data_finds_the_narrow_minimum() -> None:
    """The best point of a plain grid has a median error of 0.0799 m/s at e = 0.5134, mu = 0.18."""
    k2 = 0.7522033542556 * (0.035**2 + 0.025**2) / 4
    before, seen = course.measured_impacts()
    fitted = impacts.fit(list(before), list(seen), **DIE, gyration2=k2)
    assert fitted.median_error < 0.0799 and fitted.rms_error < 0.0855
    assert abs(fitted.restitution - 0.5134) < 0.001 and abs(fitted.friction - 0.18) < 0.001


@pytest.mark.parametrize("minimise", ["median", "rms"])
def test_errors_match_the_scatter_about_the_truth(minimise: Any) -> None:
    """The bounds are four standard deviations. The root mean square of 40 pulls is 1 with a
    standard deviation of 1/sqrt(80), and the share of pulls below 1 is 0.68 with a standard
    deviation of sqrt(0.68 0.32/40)."""
    pulls = []
    for seed in range(40):
        true, before, seen = thrown(seed, 60)
        fitted = impacts.fit(before, seen, **DIE, minimise=minimise)
        off = (fitted.restitution, fitted.friction) - true
        pulls.append(off / (fitted.restitution_error, fitted.friction_error))
    sizes = np.abs(pulls)
    assert np.all(np.abs(np.sqrt(np.mean(sizes**2, axis=0)) - 1) < 4 / math.sqrt(80))
    assert np.all(np.abs(np.mean(sizes < 1, axis=0) - 0.68) < 4 * math.sqrt(0.68 * 0.32 / 40))


@pytest.mark.parametrize("minimise", ["median", "rms"])
def test_neither_order_nor_mirroring_changes_the_fit(minimise: Any) -> None:
    _, before, seen = thrown(3, 25)
    order = np.random.default_rng(1).permutation(25)
    mirror = np.array([[-1], [-1], [1], [-1]])
    fitted, shuffled, mirrored = (
        impacts.fit(list(states), list(velocities), **DIE, minimise=minimise)
        for states, velocities in (
            (before, seen), (before[:, order], seen[:, order]), (before * mirror, seen * mirror[1:])
        )
    )  # fmt: skip
    assert fitted == shuffled == mirrored
    assert np.array_equal(fitted.errors[order], shuffled.errors)


def test_undetermined_coefficients_have_infinite_errors() -> None:
    """If all impacts stick, infinite friction fits equally well. Errors are estimated from halves
    of the series, which must have at least 20 impacts."""
    state = approaching(200, 9)
    seen = after(state, "stronge", 0.3, 0.6) + np.random.default_rng(9).normal(0, 0.05, (3, 200))
    fitted = impacts.fit(list(state), list(seen), **BODY)
    chart = fitted.plot()
    shown = np.array([line.get_ydata() for line in chart.residuals.values()])
    pyplot.close("all")
    assert np.array_equal(shown, fitted.measured - fitted.predicted)
    state[1] = geometry.support(state[0], **BODY) * state[3]
    stuck = impacts.fit(list(state), list(after(state, "stronge", math.inf, 0.6)), **BODY)
    assert stuck.friction_error == math.inf and 0 < stuck.restitution_error < 1e-4
    few = impacts.fit(list(state[:, :19]), list(seen[:, :19]), **BODY)
    assert few.restitution_error == few.friction_error == math.inf
