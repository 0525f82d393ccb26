"""Compute data/hard_limit.csv and data/stiffness.csv, and write their tables into your_tests.md.

    python docs/makers/hard_limit.py            takes two minutes; needs gmpy2 and SciPy

`exact` computes the rigid answers to 64 digits with reference/contact_motion.py, which shares no
code with the package. `Soft` simulates the same body on a linear spring; its distance from the
rigid answers is measured for several stiffnesses.

Forces are per unit mass, k^2 = I/m and s = stiffness/m. h is the height of the centre of a touching
body, and o = dh/dtheta. The overlap is d = h - z; N acts at the distance o ahead of the centre, and
F at the distance h below it:

    x'' = F,   z'' = N - g,   k^2 omega' = -h F - (o + q) N,   slip v = x' - h omega

F = -mu |N| sign(v) while the contact slips, and F keeps v = 0 while it sticks. q is the lever of
rolling resistance with the sign of omega. There are two laws for N:

    latch     s d in compression, then s (d - d0)/e^2, which returns e^2 of the work (O. R. Walton,
              R. L. Braun, J. Rheology 30 (1986) 949); with e = 0 the impact ends at the largest d
    dashpot   s d + 2 zeta sqrt(s) d' until d = 0, with the zeta for which a normal impact without
              gravity has the restitution e; with e = 0 damping is critical
"""

import csv
import math
import sys
from pathlib import Path

import numpy as np
from pages import table, with_part

DOCS = Path(__file__).resolve().parents[1]
PAGE, DATA = DOCS / "your_tests.md", DOCS / "data"
sys.path.append(str(DOCS.parent / "reference"))
G = 9.81
INPUTS = ("a", "b", "inertia", "friction", "restitution", "rolling_resistance",
          "theta", "z", "x_dot", "z_dot", "omega")  # fmt: skip
AFTER = ("t", "x_after", "theta_after", "x_dot_after", "z_dot_after", "omega_after")
ANSWERS = (*AFTER, "slip_after", "angle", "law_spread")
BODIES = {"disc": (1.0, 1.0, 0.5), "ellipse": (2.0, 1.0, 1.25)}  # a, b, inertia; the mass is 1
IMPACTS = {"normal": (0.0, -1.0, 0.0), "oblique": (1.0, -1.0, 0.0), "spinning": (0.0, -1.0, 1.5)}
TILT = 0.5  # theta of an ellipse at an impact [rad]
ZERO = 1e-40  # smaller answers are zero to within the rounding errors of 64 digits
LADDERS = {"IMPACT": [1e4, 1e6, 1e8, 1e10], "STICK": [1e5, 1e6, 1e7], "REST": [1e5, 1e6, 1e7]}
NOISE = 1e-9  # largest error of the integrator; smaller differences are not measurable


def cases():
    """Yield the name, the kind of event and the fields of the scene of each case."""
    for name, (a, b, inertia) in BODIES.items():
        body = {"a": a, "b": b, "inertia": inertia}
        for kind, (x_dot, z_dot, omega) in IMPACTS.items():
            start = {"x_dot": x_dot, "z_dot": z_dot, "omega": omega}
            start["theta"] = TILT if a != b else 0.0
            for e in (1.0, 0.5, 0.0):
                for mu in (0.1, 0.3):
                    given = {"restitution": e, "friction": mu}
                    yield f"{name} {kind}", "IMPACT", body | start | given
        for mu in (0.1, 0.3):
            yield f"{name} slip to roll", "STICK", body | {"friction": mu, "x_dot": 3.0}
        start = {"omega": 2.0, "x_dot": 2.0} if a == b else {"theta": 0.4}
        for lever in (0.05, 0.1):
            given = {"friction": 1.0, "rolling_resistance": lever}
            yield f"{name} rolling decay", "REST", body | given | start


# ------------------------------------------------------------------------------ rigid, 64 digits


def exact(event, given):
    """Return the inputs of a case, and the state just after its event."""
    import gmpy2
    from contact_motion import Body, Scene, collide, follow
    from series import Road

    road = Road(64, 50, 1e-50)
    with road.context():
        start = {name: given.get(name, 0.0) for name in ("theta", "x_dot", "omega")}
        scene = Scene(gravity=G, **given | start | {"z": None})
        body, theta = Body(scene), gmpy2.mpfr(scene.theta)
        touch = body.touch(body.phi(theta))
        z_dot = given.get("z_dot", touch.o * scene.omega)
        if event == "IMPACT":
            v, u = scene.x_dot - touch.h * scene.omega, z_dot - touch.o * scene.omega
            hits = [collide(body, touch, v, u, law) for law in ("stronge", "poisson", "newton")]
            speeds = [
                (scene.x_dot + hit.along, z_dot + hit.away,
                 scene.omega - (touch.h * hit.along + touch.o * hit.away) / body.k2)
                for hit in hits
            ]  # fmt: skip
            after, slip = (0, 0, theta, *speeds[0]), hits[0].slip
            pairs = (zip(speeds[0], other, strict=True) for other in speeds[1:])
            spread = max(abs(p - q) for each in pairs for p, q in each)
        else:
            ((_, t, turned, omega, x, _, x_dot, up),) = follow(scene, 1e3, road, 1).rows
            after, slip, spread = (t, x, turned, x_dot, up, omega), 0, 0
        after = [0 if abs(each) < ZERO else each for each in after]
        slip, spread = (0 if abs(each) < ZERO else each for each in (slip, spread))
        angle = gmpy2.atan2(*after[3:5]) if any(after[3:5]) else math.nan
        known = {"restitution": 0.0, "rolling_resistance": 0.0} | given | scene.given()
        known |= {"z": touch.h, "z_dot": z_dot}
        known |= dict(zip(ANSWERS, (*after, slip, angle, spread), strict=True))
        return {name: float(known[name]) for name in (*INPUTS, *ANSWERS)}


# ------------------------------------------------------------------------------ soft, in doubles


class Soft:
    """A body on a spring. Its state y is x, z, theta, x_dot, z_dot, omega."""

    def __init__(self, row, s, law):
        self.row, self.s, self.latch = row, s, law == "latch"
        self.a, self.b, self.k2, self.mu, self.e, self.lever = (row[name] for name in INPUTS[:6])
        decay = math.log(self.e) if self.e else -math.inf
        self.zeta = 1.0 if decay == -math.inf else -decay / math.hypot(decay, math.pi)
        self.returns, self.d0 = False, 0.0  # whether restitution has begun, and d at its end
        self.side = self.turn = 0  # sign of the slip, 0 if it sticks; sign of a resisted rotation

    def touch(self, y):
        """Return h, o, the overlap and its rate."""
        sin, cos = math.sin(y[2]), math.cos(y[2])
        h = math.hypot(self.a * sin, self.b * cos)
        o = (self.a**2 - self.b**2) * sin * cos / h
        return h, o, h - y[1], o * y[5] - y[4]

    def normal(self, y):
        *_, d, rate = self.touch(y)
        if self.latch:
            return self.s * (d - self.d0) / self.e**2 if self.returns else self.s * d
        return self.s * d + 2 * self.zeta * math.sqrt(self.s) * rate

    def holding(self, y, normal):
        """Return the friction force that keeps the slip constant."""
        h, o, *_ = self.touch(y)
        arm = o + self.lever * self.turn
        return (o * y[5] ** 2 - h * arm * normal / self.k2) / (1 + h * h / self.k2)

    def slopes(self, t, y):
        h, o, *_ = self.touch(y)
        normal = self.normal(y)
        friction = -self.mu * abs(normal) * self.side if self.side else self.holding(y, normal)
        torque = -h * friction - (o + self.lever * self.turn) * normal
        return [*y[3:], friction, normal - G, torque / self.k2]

    def slip(self, t, y):
        """Return the slip in the direction `side`, or the unused friction if the contact sticks."""
        if self.side:
            return self.side * (y[3] - self.touch(y)[0] * y[5])
        normal = self.normal(y)
        return self.mu * abs(normal) - abs(self.holding(y, normal))

    def contact(self, t, y):
        """Return a value that is positive until the contact (or the latch's compression) ends."""
        if not self.latch:
            return self.touch(y)[2]
        return self.normal(y) if self.returns else self.touch(y)[3]

    def rotation(self, t, y):
        """Return the angular velocity in the direction `turn`."""
        return self.turn * y[5]

    def stick_or_slip(self, y):
        """Choose whether a contact without slip sticks; if N = 0, choose as for N = 1 m/s^2."""
        normal = self.normal(y) or 1.0
        friction = self.holding(y, normal)
        self.side = 0 if abs(friction) <= self.mu * abs(normal) else -int(np.sign(friction))

    def turn_or_rest(self, y):
        """Choose the sense in which a resting body starts to turn; 0 if the resistance holds it."""
        o = self.touch(y)[1]
        self.turn = 0 if abs(o) <= self.lever else -int(np.sign(o))

    def follow(self):
        """Return the time and the state at the event of the case."""
        from scipy.integrate import solve_ivp

        event, unit, t = self.row["event"], 1 / math.sqrt(self.s), 0.0
        y = [0.0, *(self.row[name] for name in ("z", "theta", "x_dot", "z_dot", "omega"))]
        if self.lever:
            self.turn = int(np.sign(y[5]))
            if not self.turn:
                self.turn_or_rest(y)
        self.side = int(np.sign(y[3] - self.row["z"] * y[5]))
        if not self.side:
            self.stick_or_slip(y)
        margins = [self.slip, self.rotation if event == "REST" else self.contact]
        ends = [lambda t, y, margin=margin: margin(t, y) for margin in margins]
        for end in ends:
            end.terminal, end.direction = True, -1
        while True:
            found = solve_ivp(
                self.slopes, (t, math.inf), y, "DOP853", rtol=1e-12, atol=1e-13, events=ends,
                first_step=1e-3 * unit, max_step=unit,
            )  # fmt: skip
            t, y = float(found.t[-1]), found.y[:, -1].tolist()
            if found.t_events[0].size:
                if event == "STICK":
                    return t, y
                self.stick_or_slip(y)
            elif event == "REST":
                self.turn_or_rest(y)
                self.stick_or_slip(y)
                if not self.turn:
                    return t, y
            elif self.latch and self.e and not self.returns:
                self.returns, self.d0 = True, (1 - self.e**2) * self.touch(y)[2]
            else:
                return t, y


def error(row, s, law):
    """Return the largest error: of x_dot, z_dot, k omega at impacts, of t, x, theta otherwise."""
    t, y = Soft(row, s, law).follow()
    impact = row["event"] == "IMPACT"
    found = np.array(y[3:] if impact else [t, y[0], y[2]])
    known = [row[name] for name in (AFTER[3:] if impact else AFTER[:3])]
    scale = [1.0, 1.0, math.sqrt(row["inertia"]) if impact else 1.0]
    return float(np.max(np.abs(found - known) * scale))


def ladder(row):
    """Yield a row for each law and stiffness; on a dashpot an impact with e = 0 does not end."""
    impact = row["event"] == "IMPACT"
    for law in ("latch", "dashpot") if impact else ("dashpot",):
        if law == "latch" or row["restitution"] or not impact:
            given = {name: row[name] for name in ("case", *INPUTS[3:6])}
            for s in LADDERS[row["event"]]:
                yield given | {"law": law, "stiffness": s, "error": f"{error(row, s, law):.4e}"}


def exponent(rungs):
    """Return the exponent of the error at the two stiffest springs; NaN for errors below NOISE."""
    (s, first), (t, last) = ((rung["stiffness"], rung["error"]) for rung in rungs[-2:])
    return math.log(last / first) / math.log(t / s) if last > NOISE else math.nan


# ------------------------------------------------------------------------------ files and tables


def write(name, rows):
    with (DATA / name).open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def read(name):
    """Return the rows of a table, with numbers as doubles."""
    with (DATA / name).open(encoding="utf-8", newline="") as file:
        return [
            {key: text if key in ("case", "event", "law") else float(text)
             for key, text in row.items()}
            for row in csv.DictReader(file)
        ]  # fmt: skip


def rungs_of(row, law, rungs):
    given = [row[name] for name in ("case", *INPUTS[3:6])]
    return [r for r in rungs if [*r.values()][:4] == given and r["law"] == law]


def limit(row, law, rungs):
    """Return the exponent, "exact" for errors below NOISE, or the error that remains."""
    found = rungs_of(row, law, rungs)
    if not found:
        return "–"
    power = exponent(found)
    if math.isnan(power):
        return "exact"
    return f"{power:.3f}".replace("-", "−") if power < -0.25 else f"{found[-1]['error']:.3f} left"


def tables():
    """Return the marked parts of the page, by name."""
    rows, rungs = read("hard_limit.csv"), read("stiffness.csv")
    number = "{:.15g}".format
    impacts, lasting = [], []
    for row in rows:
        latch, dashpot = (limit(row, law, rungs) for law in ("latch", "dashpot"))
        after = {name: number(row[name]).replace("nan", "–") for name in (*AFTER, "angle")}
        e, mu, lever = (
            f"{row[name]:g}" for name in ("restitution", "friction", "rolling_resistance")
        )
        case = row["case"].replace(" ", "\N{NO-BREAK SPACE}")
        if row["event"] == "IMPACT":
            answers = [after[name] for name in (*AFTER[3:], "angle")]
            impacts.append([case, e, mu, latch, dashpot, *answers])
        else:
            answers = [after[name] for name in (*AFTER[:4], "omega_after")]
            lasting.append([case, mu, lever, dashpot, *answers])
    return {
        "impacts": table(("case", "e", "μ", "latch", "dashpot", "ẋ [m/s]", "ż [m/s]", "ω [rad/s]",
                          "angle [rad]"), impacts),
        "lasting": table(("case", "μ", "lever [m]", "dashpot", "t [s]", "x [m]", "θ [rad]",
                          "ẋ [m/s]", "ω [rad/s]"), lasting),
    }  # fmt: skip


def with_tables(page):
    """Return the page with its marked parts computed from the files."""
    for name, made in tables().items():
        page = with_part(page, name, made, "hard_limit.py")
    return page


def main():
    rows = [{"case": name, "event": event} | exact(event, given) for name, event, given in cases()]
    write("hard_limit.csv", rows)
    write("stiffness.csv", [rung for row in rows for rung in ladder(row)])
    rungs = read("stiffness.csv")
    for row in rows:
        laws = [f"{law} {limit(row, law, rungs)}" for law in ("latch", "dashpot")]
        print(row["case"], *(row[name] for name in INPUTS[3:6]), *laws)
    PAGE.write_text(with_tables(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
