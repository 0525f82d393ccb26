"""pymunk, Chipmunk for Python: impulses by iteration.

It has no ellipse. The body is a polygon of 1024 vertices, which with more takes seconds a problem;
a disc is pymunk's circle. The iterations are the default, since one contact needs no more; the
overlap that is let stand is 0.001 max(a, b), since pymunk's default of 0.1 is meant for pixels.
Friction and restitution are those of the body: pymunk multiplies them with the ground's, 1.
"""

from __future__ import annotations

import math

import numpy as np
import pymunk

from ..._ask.check import FloatArray
from ..._ask.scene import Scene
from .._problem import Problem
from .._result import Result
from . import STEP, need, sampled

VERTICES = 1024
_FAR, _THICK = 1e4, 10.0  # half length and thickness of the ground [m]


def simulate(problem: Problem, times: FloatArray, setting: float | None = None) -> Result:
    """Run a problem with a time step [s]."""
    return motion(problem.scene, times, STEP if setting is None else setting)


def motion(scene: Scene, times: FloatArray, step: float) -> Result:
    """Run a scene."""
    need(math.isfinite(scene.friction), "friction is finite in pymunk")
    long, at, note = max(scene.a, scene.b), scene.initial_state, ""
    space = pymunk.Space()
    space.gravity = (scene.gravity * math.sin(scene.slope), -scene.gravity * math.cos(scene.slope))
    space.collision_slop = 1e-3 * long
    corners = [(-_FAR, -_THICK), (_FAR, -_THICK), (_FAR, 0.0), (-_FAR, 0.0)]
    ground = pymunk.Poly(space.static_body, corners)
    body = pymunk.Body(scene.mass, scene.mass * scene.gyration2)
    shape: pymunk.Shape = pymunk.Circle(body, scene.a)
    if scene.a != scene.b:
        turn = 2 * np.pi * np.arange(VERTICES) / VERTICES
        points = np.stack([scene.a * np.cos(turn), scene.b * np.sin(turn)], axis=1)
        shape = pymunk.Poly(body, points.tolist())
        gap = long * (1 - math.cos(math.pi / VERTICES))
        note = f"polygon of {VERTICES} vertices, off by {gap:.1e} m"
    shape.friction, shape.elasticity = scene.friction, scene.restitution
    ground.friction, ground.elasticity = 1.0, 1.0
    body.position, body.angle = (at.x, at.z), -at.theta
    body.velocity, body.angular_velocity = (at.x_dot, at.z_dot), -at.omega
    space.add(ground, body, shape)

    def advance(done: int, count: int) -> None:
        for _ in range(done, count):
            space.step(step)

    def state() -> list[float]:
        impulse = [pymunk.Vec2d.zero()]
        body.each_arbiter(lambda arbiter: impulse.append(arbiter.total_impulse))
        along, away = sum(impulse, pymunk.Vec2d.zero()) / step
        motion = [*body.position, -body.angle, *body.velocity, -body.angular_velocity]
        return [*motion, away, along]

    return sampled(times, step, advance, state, note)
