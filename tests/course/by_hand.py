"""Answers to the tasks of the course, computed from closed forms and Newton's law with SciPy. Wrong
answers come from the same formulas with typical mistakes."""

import math
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
from oracles.contact import reaction_by_pieces, response
from rolling_ellipse import course
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, least_squares, minimize
from sensitivity.chain import rates, support

TIP, DEGREE = math.pi / 2, 180 / math.pi
STATE = ("theta", "x_dot", "z_dot", "omega")
FILMED = {
    "10.1": "x_dot", "10.2": "omega", "10.3": "restitution", "10.4": "friction", "10.5": "chi2",
}  # fmt: skip
# The numbers from which the film of sheet 10 was computed, and its noise
THROWN = {
    "x": 0.0, "z": 0.1, "theta": 0.5, "x_dot": 0.317, "z_dot": 0.243, "omega": 11.63,
    "restitution": 0.55, "friction": 0.18,
}  # fmt: skip
NOISE = np.array([[5e-4], [5e-4], [0.01]])
SOLID = (0.035**2 + 0.025**2) / 4  # k^2 of the filmed body, a uniform disc
USUAL = (
    "sign", "degrees", "Degrees", "dEGREES", "DEGREES", "inertia", "friction", "angle", "small",
    "torque", "point", "weight", "slip", "freedom",
)  # fmt: skip
PLAIN = dict.fromkeys((*STATE, "slope", "restitution", "jx", "jz", "dx", "dz"), 0.0)
PLAIN |= {"a": 1.0, "b": 1.0, "mass": 1.0, "friction": 1e10}  # friction that prevents any slip
PLAIN |= {"torque": False}  # True for the mistake of setting the moment about C to I_C omega_dot
PLAIN |= {"posed": 1.0, "spun": 1.0}  # factors of theta and omega t in flight


@cache
def tasks_of(seed: int | None) -> dict[str, course.Task]:
    return {task.number: task for task in course.tasks(seed)}


class Given(SimpleNamespace):
    """The data of a task, completed with default values of a scene."""

    def __init__(self, number: str, seed: int | None = None, **changes: Any) -> None:
        known: dict[str, Any] = PLAIN | tasks_of(seed)[number].data | changes
        k2 = known.setdefault("gyration2", (known["a"] ** 2 + known["b"] ** 2) / 4)
        known |= {"number": number, "seed": seed, "inertia": known["mass"] * k2}
        super().__init__(**known)

    def but(self, **changes: Any) -> Any:
        return Given(**vars(self) | changes)

    def at(self, angle: Any) -> tuple[Any, Any, Any]:
        return support(angle, vars(self))

    def rolling(self, angle: float, omega: float) -> tuple[float, ...]:
        _, _, _, along, up, turn = rates("ROLLING", 0, [0, 0, angle, 0, 0, omega], vars(self))
        weight = self.gravity * math.cos(self.slope), self.gravity * math.sin(self.slope)
        if self.torque:
            h, lead, bend = self.at(angle)
            turn = (h * weight[1] - lead * weight[0]) / self.about_contact(angle)
            along, up = h * turn + lead * omega**2, lead * turn + bend * omega**2
        return turn, self.mass * (up + weight[0]), self.mass * (along - weight[1])

    def about_contact(self, angle: float) -> float:
        return float(self.gyration2 + self.at(angle)[0] ** 2 + self.at(angle)[1] ** 2)

    def speed(self, angle: float, lift: float) -> float:
        return math.sqrt(2 * self.gravity * (lift - self.at(angle)[0]) / self.about_contact(angle))

    def needed(self, flat: float) -> float:
        lift = self.b + self.about_contact(0) * flat**2 / 2 / self.gravity
        forces = [self.rolling(q, self.speed(q, lift)) for q in np.linspace(0, 0.999 * TIP, 250)]
        return max(abs(F / N) for _, N, F in forces)

    def turn(self, lift: float, end: float) -> float:
        return float(4 * quad(lambda q: 1 / self.speed(q, lift), 0, end)[0])

    def rocked(self) -> float:
        """Time from release to rest. Each swing is integrated until the rotation stops. There the
        couple against the rotation changes its direction, or holds the body at rest."""
        angle, now, lever = self.theta, 0.0, self.rolling_resistance
        while abs(self.at(angle)[1]) > lever:
            turn = -math.copysign(1, self.at(angle)[1])

            def rates(_: float, y: Any, turn: float = turn) -> list[float]:
                h, lead, bend = self.at(y[0])
                arm, load = lead + turn * lever, self.gravity + bend * y[1] ** 2
                inertia = self.gyration2 + h**2 + lead * arm
                return [y[1], -(arm * load + h * lead * y[1] ** 2) / inertia]

            def stops(_: float, y: Any, turn: float = turn) -> float:
                return float(turn * y[1])

            vars(stops).update(terminal=True, direction=-1)
            how: Any = {"events": stops, "rtol": 1e-10, "atol": 1e-12, "method": "DOP853"}
            swing: Any = solve_ivp(rates, (0, 9), [angle, 0.0], max_step=0.1, **how)
            angle, now = swing.y[0, -1], now + swing.t[-1]
        return now

    def small_rocking(self) -> float:
        """Time to rest for small angles: each half swing reduces the amplitude by the same step."""
        left, step, count = abs(self.theta), 2 * self.rolling_resistance / self.at(0)[2], 0
        while left > step / 2:
            left, count = left - step, count + 1
        return count * math.pi / TRUE["2.3"](self)

    def hit(self) -> tuple[Any, ...]:
        """Reaction (along the ground, up) and velocities after a blow and a Stronge impact."""
        spin = (self.jx * self.dz - self.jz * self.dx) / self.inertia
        v = self.x_dot + self.jx / self.mass, self.z_dot + self.jz / self.mass, self.omega + spin
        free: Any = self.but(x_dot=v[0], z_dot=v[1], omega=v[2])
        x, z = reaction_by_pieces(response(free, free), self.friction, self.restitution)
        arm = self.at(self.theta)[0] * x + self.at(self.theta)[1] * z
        return x, z, v[0] + x / self.mass, v[1] + z / self.mass, v[2] - arm / self.inertia

    def pushed(self) -> float:
        """Angular velocity after a push on ground that prevents slip or has no friction."""
        push = self.jx * (self.at(self.theta)[0] + self.dz) / self.mass
        return float(push / self.about_contact(self.theta)) if self.friction else self.hit()[4]

    def landed(self) -> Any:
        start, rate = self.posed * self.theta, self.spun * self.omega
        t = brentq(lambda t: self.z + self.z_dot * t - self.gravity * t**2 / 2
                   - self.at(start + rate * t)[0], 0, 1)  # fmt: skip
        return self.but(theta=start + rate * t, z_dot=self.z_dot - self.gravity * t)

    def slid(self) -> float:
        """Angular velocity after an impact that slips throughout: Lambda_x = -mu s Lambda_z."""
        h, lead, _ = self.at(self.theta)
        along = -self.friction * math.copysign(1, self.x_dot - h * self.omega)
        arm = (h * along + lead) / self.inertia
        up = -(1 + self.restitution) * (self.z_dot - lead * self.omega)
        return float(self.omega - arm * up / (1 / self.mass + lead * arm))

    def frames(self, t: Any) -> Any:
        """Positions and angles of a thrown body that hits the ground once."""
        lands = self.landed()
        end = (self.z_dot - lands.z_dot) / self.gravity
        before, after = np.minimum(t, end), np.maximum(t - end, 0)
        way = np.outer((self.x_dot, self.z_dot, self.omega), before)
        way += np.outer(lands.hit()[2:], after)
        way[1] -= self.gravity / 2 * t**2 - self.gravity * end * after
        return np.array([[self.x], [self.z], [self.theta]]) + way

    def struck(self) -> tuple[Any, Any]:
        before, after = course.measured_impacts(self.seed)
        found = [self.but(**dict(zip(STATE, row, strict=True))).hit()[2:] for row in before.T]
        return np.transpose(found), after

    def impacts(self) -> float:
        before, after = course.measured_impacts(self.seed)
        (h, slope, _), (x, z, turn) = self.at(before[0]), after - before[1:]
        moment = -(h * x + slope * z)
        own = (moment @ turn) / (turn @ turn)
        gap = [v[1] - slope * v[2] for v in (before[1:], after)]
        if self.number == "8.4":
            return least_rms(self.seed, self.gyration2)
        if self.number == "8.5":
            return least_rms(self.seed, own) / least_rms(self.seed, self.gyration2)
        if self.number == "8.6":
            found, _ = self.struck()
            ends = (found[0] - h * found[2]) * np.sign(before[1] - h * before[3])
            return float(np.sum(ends < 1e-9))
        parts = own, (moment @ moment) / (moment @ turn), np.median(-gap[1] / gap[0])
        return float(
            parts[int(self.number[2]) - 1] / (1 if self.number == "8.3" else self.gyration2)
        )

    def runs(self, parts: int) -> float:
        y, step = np.array([self.theta, self.omega]), self.step / parts
        for _ in range(round(self.T / step)):
            k = [0 * y]
            for share in (0, 0.5, 0.5, 1):
                theta, omega = y + share * step * k[-1]
                k.append(np.array([omega, self.rolling(theta, omega)[0]]))
            y = y + step / 6 * np.array([1, 2, 2, 1]) @ k[1:]
        return float(y[0])


@cache
def least_rms(seed: int | None, gyration2: float) -> float:
    """Root mean square error, minimised over e and the angle of friction."""
    given: Any = Given("8.4", seed, gyration2=gyration2)

    def error(numbers: Any) -> float:
        e, angle = np.clip(numbers, 0, [1, 1.5])
        found, after = given.but(restitution=e, friction=math.tan(angle)).struck()
        along, up, spin = found - after
        return float(np.sqrt(np.mean(along**2 + up**2 + gyration2 * spin**2)))

    how: dict[str, Any] = {"xatol": 1e-4, "fatol": 1e-7}
    return float(minimize(error, [0.52, 0.17], method="Nelder-Mead", options=how).fun)


def fitted(d: Any) -> float:
    return film_fit(d.seed, d.gyration2)[0][FILMED[d.number]]


TRUE: dict[str, Any] = {
    "1.1": lambda d: d.at(d.theta)[0], "1.2": lambda d: d.at(d.theta)[1],
    "1.3": lambda d: quad(lambda q: d.at(q)[0], 0, d.theta, limit=500)[0],
    "1.4": lambda d: quad(lambda q: d.at(q)[0] + d.at(q)[2], 0, d.theta, limit=500)[0],
    "2.1": lambda d: d.mass * d.about_contact(d.theta) * d.omega**2 / 2,
    "2.2": lambda d: -math.copysign(d.speed(0, d.at(d.theta)[0]), math.tan(d.theta)),
    "2.3": lambda d: math.sqrt(d.gravity * d.at(0)[2] / d.about_contact(0)),
    "2.4": lambda d: d.turn(d.at(d.theta)[0], math.asin(abs(math.sin(d.theta)))),
    "3.1": lambda d: d.rolling(0, d.omega)[1], "3.2": lambda d: d.rolling(d.theta, d.omega)[2],
    "3.3": lambda d: d.rolling(d.theta, d.omega)[0],
    "3.4": lambda d: abs(d.rolling(d.theta, 0)[2] / d.rolling(d.theta, 0)[1]),
    "3.5": Given.rocked,
    "4.1": lambda d: d.speed(0, d.a), "4.2": lambda d: d.speed(d.theta, d.a),
    "4.3": lambda d: d.needed(d.speed(0, d.a)),
    "4.4": lambda d: d.turn(d.b + d.about_contact(0) * d.omega**2 / 2 / d.gravity, TIP),
    "5.1": lambda d: d.hit()[4], "5.2": lambda d: d.hit()[0], "5.3": lambda d: d.pushed(),
    "5.4": lambda d: d.speed(0, d.a) / d.but(jz=-1.0).hit()[4],
    "6.1": lambda d: abs(d.hit()[0] / d.hit()[1]), "9.1": lambda d: d.runs(1),
    "6.2": lambda d: d.x_dot / d.friction / d.gravity / (1 + d.a**2 / d.gyration2),
    "6.3": lambda d: rates("SLIDING", 1, [0, 0, d.theta, d.x_dot, 0, d.omega], vars(d))[5],
    "6.4": lambda d: brentq(lambda flat: d.needed(flat) - d.friction, d.speed(0, d.a), 12),
    "7.1": lambda d: math.sqrt(abs(d.gravity / d.at(d.theta)[2])),
    "7.2": lambda d: -d.landed().z_dot / d.gravity, "7.4": lambda d: d.landed().hit()[4],
    "7.3": lambda d: d.mass * d.gravity * d.at(d.landed().theta)[0]
    + np.dot([d.mass, d.mass, d.inertia], np.square(d.landed().hit()[2:])) / 2,
    **dict.fromkeys(("8.1", "8.2", "8.3", "8.4", "8.5", "8.6"), Given.impacts),
    "9.2": lambda d: math.log2(abs((d.runs(1) - d.runs(2)) / (d.runs(2) - d.runs(4)))),
    "9.3": lambda d: np.polyval([1 / 24, 1 / 6, 1 / 2, 1, 1], -2 * d.alpha * d.step),
    "9.4": lambda d: math.sqrt(-d.gravity * d.at(TIP)[2] / d.about_contact(TIP)),
    **dict.fromkeys(FILMED, fitted),
}  # fmt: skip
WRONG: dict[tuple[str, str], Any] = {  # formulas with one mistake each
    ("small", "2.4"): lambda d: 2 * math.pi / TRUE["2.3"](d),
    ("small", "3.5"): Given.small_rocking,
    ("point", "1.3"): lambda d: TRUE["1.4"](d), ("point", "1.4"): lambda d: TRUE["1.3"](d),
    ("weight", "3.1"): lambda d: d.mass * d.gravity,
    ("slip", "7.4"): lambda d: d.landed().slid(),
    ("freedom", "10.5"): lambda d: fitted(d) * 31 / 39,
    **{("torque", number): lambda d: TRUE[d.number](d.but(torque=True))
       for number in ("3.2", "3.3", "4.3", "6.4", "9.1", "9.2")},
}  # fmt: skip


@cache
def film_fit(
    seed: int | None = None, gyration2: float = SOLID
) -> tuple[dict[str, float], dict[str, float]]:
    """Numbers that best fit the film for a given k^2, with chi^2/31, and their standard errors."""
    t, *tracks = course.film(seed).values()

    def missed(numbers: Any) -> Any:
        numbers = dict(zip(THROWN, numbers, strict=True))
        given: Any = Given("10.1", gyration2=gyration2, **numbers)
        return ((given.frames(t) - tracks) / NOISE).ravel()

    how: Any = {"jac": "3-point", "x_scale": "jac", "method": "dogbox"}
    # with another k^2 the search needs a start at which the contact slides
    start = THROWN | ({} if gyration2 == SOLID else {"friction": 0.09})
    best = least_squares(missed, [*start.values()], **how)
    errors = np.sqrt(np.linalg.inv(best.jac.T @ best.jac).diagonal())
    known, off = (dict(zip(THROWN, row, strict=True)) for row in (best.x, errors))
    return known | {"chi2": 2 * best.cost / 31}, off


@cache
def answer(number: str, made: tuple[str, ...] = (), seed: int | None = None) -> float:
    """The answer with mistakes. DEGREES means an answer in degrees, `degrees` data in degrees,
    Degrees a calculator in degree mode, and dEGREES such a calculator with only theta converted."""
    if made and made[0].startswith("task"):
        return answer(made[0][5:], (), seed)
    task, of, factor = tasks_of(seed)[number], TRUE[number], 1.0
    changes: dict[str, float] = {}
    for name in (name for name in USUAL if name in made):
        of = WRONG.get((name, number), of)
        if name == "sign":
            factor *= -1
        elif name == "DEGREES" and "rad" in task.unit:
            factor *= DEGREE
        elif name == "degrees":
            changes |= {k: v * DEGREE for k, v in task.data.items() if k in ("theta", "slope")}
        elif name == "Degrees" and number not in ("2.4", "3.5", "9.1", "9.2"):
            if "z" in task.data:
                changes |= {"posed": 1 / DEGREE, "spun": 1 / DEGREE}
            else:
                changes |= {k: v / DEGREE for k, v in task.data.items() if k in ("theta", "slope")}
            factor *= DEGREE if number in ("1.3", "1.4") and "theta" in changes else 1
        elif name == "dEGREES" and "z" in task.data:
            changes |= {"spun": 1 / DEGREE}
        elif name == "inertia":
            changes["gyration2"] = 2 * Given(number, seed).gyration2
        elif name == "friction" and number in ("5.1", "5.2", "5.3", "5.4", "7.4", "8.6"):
            changes["friction"] = 0.0
        elif name == "angle" and "theta" in task.data:
            changes["theta"] = 0.0
    return factor * float(of(Given(number, seed, **changes)))


def allowed(number: str, seed: int | None = None) -> float:
    """Tolerance: half a percent for answers from impacts and for chi^2, twice the standard error
    for those from the film, and half a unit of the fourth digit plus 1e-4 times the condition
    number for others."""
    right = abs(answer(number, (), seed))
    if number[0] == "8" or number == "10.5":
        return 5e-3 * right
    if number in FILMED:
        return 2 * film_fit(seed)[1][FILMED[number]]
    moved = ([TRUE[number](Given(number, seed, **{k: v * (1 + s)})) for s in (-1e-4, 1e-4)]
             for k, v in tasks_of(seed)[number].data.items())  # fmt: skip
    digit = 10.0 ** (math.floor(math.log10(right)) - 3)
    return digit / 2 + math.hypot(*(high - low for low, high in moved)) / 2
