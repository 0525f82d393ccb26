"""A typed script that calls each function of `_verbs`; the suite runs it and checks its types."""

from pathlib import Path

import numpy as np
import rolling_ellipse as rl
from rolling_ellipse import benchmark, course, geometry, impacts, report


def use(folder: Path) -> list[float]:
    body = rl.Scene(2.0, 1.0, omega=3.2, friction=0.5)
    blow = rl.Impulse.press(48.0, 1.5)
    start: rl.InitialState = body.replace(impulse=blow, omega=0.0).initial_state
    motion = rl.simulate(rl.scenes.jump, np.linspace(0.0, 2.0, 21))
    rolls = rl.simulate(body, [0.0, 0.5, 1.0], method="dop853")
    names = [rl.outcome(body).name, rl.classify(a=2.0, b=1.0, omega=1.0).name, start.mode.name]
    tips: list[float] = motion.when(event="roll_over").tolist()
    several = [times.size for times in motion.when(theta=[0.5, 1.0])]
    slips = [event.t for event in motion.events if event.kind == "SLIP"]
    assert motion.when(event=rl.EventKind.SLIP).tolist() == slips and motion.status == "COMPLETED"
    many = rl.simulate_many([body, rl.scenes.jump], 1.0)
    last = [each.x[-1] for each in many if isinstance(each, rl.Trajectory)]
    grid = rl.simulate_many({"a": 2.0, "b": 1.0, "omega": [1.0, 2.0]}, [0.5], returns="x")
    hits = rl.simulate_many([body, rl.scenes.jump], 1.0, returns="events")
    table: rl.EventTable = motion.events.table
    assert table["t"][table["kind"] == rl.EventKind.SLIP].tolist() == slips
    assert hits.axes == ("scene",)
    stored = rl.load_many(rl.simulate_many([body], 1.0, out=folder / "many"))
    stopped = rl.simulate(rl.scenes.jump, np.inf, stop=(rl.EventKind.IMPACT, "rest"))
    landed = rl.ends([rl.scenes.jump], np.inf, stop="impact").go_on(stopped.t_end, stop="decided")
    ended = landed.status == rl.Status.COMPLETED
    theta, _, x = rl.flow(1.0, a=2.0, b=1.0, theta=0.0, omega=1.0)
    slope = rl.flow_jacobian(1.0, a=2.0, b=1.0, theta=0.0, omega=1.0).sum()
    q, q_dot = rl.kinematics([0.1, 0.2], 1.0, a=2.0, b=1.0)
    off = rl.constraints(q, q_dot, a=2.0, b=1.0).slip.max()
    rate = rl.rolling_equation(body)(0.0, np.zeros(3))[0] + rl.period(body)
    proof, bounds = rl.certify(body).validity == rl.Validity.VALID, rl.thresholds(2.0, 1.0)
    needed = rl.required_friction(body) + rl.blow_to(rl.Scene(2.0, 1.0), 1.5).jz
    track = rl.read_track({"t": motion.t, "x": motion.x}, t="t", x="x")
    fit = rl.fit_motion(*track, scene=motion.scene, free=("omega",), sigma=1e-3)
    race = rl.work_precision(body, 0.5, methods=["flow"], rounds=1, max_seconds=0.1)
    growth = motion.sensitivity(wrt="omega").state[-1].sum() + rolls.sol(0.3).x[0] + rolls.at(0.3).x
    grown: rl.Growth = motion.growth(wrt="theta")
    rolls.save(folder / "motion.npz")
    loaded = rl.load(folder / "motion.npz") == rolls and rl.Scene.from_json(body.to_json()) == body
    given = rl.Trajectory.from_arrays(motion.t, theta=motion.theta, scene=motion.scene)
    curves = [motion.plot_curves("theta", "omega"), rl.ends([body], 1.0).plot("x")]
    plots = [rl.plot(motion), motion.plot_phase(), rl.plot_phase_map(resolution=4), fit.plot()]
    pages = [rl.animate(rolls).figure, rl.explore(body), rl.examples(folder / "examples")]
    marked, known = course.mark("3.2", 1.9).right, benchmark.run(lambda p, t, s: p.exact(t))
    course.sheet(1, seed=7).save(folder / "sheet.html")
    (folder / "answers.csv").write_text("student,seed,task,answer\nAda,7,1.1,0.2")
    of_class: dict[str, int] = course.mark_table(folder / "answers.csv").points
    height: float = geometry.support(0.3, a=2.0, b=1.0) + report.errata()[0].evaluate().gap
    struck = impacts.collide(0.3, 0.0, -1.0, 0.0, a=2.0, b=1.0, friction=0.3, restitution=0.5)
    rows = motion.to_dataframe().shape[0] + motion.to_xarray().sizes["t"] + len(motion.events)
    print(names, several, stored, ended, proof, bounds, race, loaded, marked, known)
    print(curves, plots, pages, of_class)
    return [*tips, *last, theta, x, slope, off, rate, needed, growth, height, *struck, rows,
            grid["x"].sum(), given.z[-1], *grown.exponents]  # fmt: skip
