"""Known answers for other simulators, integrators and gradients.

This package is not a general simulator of bodies and joints and does not compete with yours. It has
twenty problems of an ellipse on the ground with exact answers, computed by two independent
programs, and with condition numbers. Units are SI and radians; ``x`` is along the ground (downhill
on a slope), ``z`` is normal to it, ``theta`` is the clockwise rotation, unwrapped. States are in
the order x, z, theta, x_dot, z_dot, omega.

Examples
--------
>>> rl.benchmark.problem("slide.stick").question
'When does the slip end?'
>>> def mine(problem, times, step):  # your simulator returns states at the times
...     return problem.exact(times) + 1e-4
>>> rl.benchmark.run(mine, problems="slide.stick")[0].passed
True
"""

from ._equations import Dae, Ode
from ._files import export
from ._problem import Gradient, KnownEvent, Problem, gradients, problem, problems
from ._results import Result
from ._run import run, score
from ._scores import Score, Scores

__all__ = [
    "Dae", "Gradient", "KnownEvent", "Ode", "Problem", "Result", "Score", "Scores", "export",
    "gradients", "problem", "problems", "run", "score",
]  # fmt: skip
