"""pymunk, the Python interface of Chipmunk.

Chipmunk has no ellipses: the body is a polygon of 2048 vertices, or a circle. The number of
iterations is the default, since one contact needs no more; the allowed overlap is 0.001 max(a, b),
since the default of 0.1 is meant for pixels. Friction and restitution of the ground are 1, because
pymunk multiplies them by the values of the body.
"""

import math

import pymunk

from ..._ask.scene import Scene
from ..._ask.xml import gravity
from . import Run, engine

VERTICES = 2048


@engine
def simulate(scene: Scene, step: float) -> Run:
    if scene.friction == math.inf:
        raise NotImplementedError("friction is finite in pymunk")
    if scene.rolling_resistance:
        raise NotImplementedError("pymunk has no rolling resistance")
    a, b, at, note = scene.a, scene.b, scene.initial_state, "circle"
    body = pymunk.Body(scene.mass, scene.mass * scene.gyration2)
    shape: pymunk.Shape = pymunk.Circle(body, a)
    if a != b:
        turns = [math.tau * k / VERTICES for k in range(VERTICES)]
        shape = pymunk.Poly(body, [(a * math.cos(turn), b * math.sin(turn)) for turn in turns])
        gap = max(a, b) * (1 - math.cos(math.pi / VERTICES))
        note = f"polygon of {VERTICES} vertices, off by {gap:.1e} m"
    body.position, body.angle = (at.x, at.z), -at.theta
    body.velocity, body.angular_velocity = (at.x_dot, at.z_dot), -at.omega
    shape.friction, shape.elasticity = scene.friction, scene.restitution
    space = pymunk.Space()
    space.gravity, space.collision_slop = gravity(scene)[::2], 1e-3 * max(a, b)
    ground = pymunk.Segment(space.static_body, (-1e4, -1.0), (1e4, -1.0), radius=1.0)
    ground.friction = ground.elasticity = 1.0
    space.add(ground, body, shape)
    return (
        lambda steps: [space.step(step) for _ in range(steps)],
        lambda: [*body.position, -body.angle, *body.velocity, -body.angular_velocity],
        note,
    )
