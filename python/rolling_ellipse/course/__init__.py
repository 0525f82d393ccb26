"""A course of ten sheets (docs/course), with numbers for each student and marks for the answers.

The package computes the right answers, and also those that result from common mistakes.

Examples
--------
>>> task = rl.course.tasks()[0]
>>> print(task.question)
How high is the centre above the ground, $h$?
>>> height = rl.geometry.support(**task.data)
>>> rl.course.mark(task.number, height).right
True
"""

from ._marks import Mark, mark
from ._sheets import Sheet, sheet
from ._table import MarkedTable, mark_table
from ._tasks import Task, film, measured_impacts, tasks

__all__ = [
    "Mark", "MarkedTable", "Sheet", "Task", "film", "mark", "mark_table", "measured_impacts",
    "sheet", "tasks",
]  # fmt: skip


def __dir__() -> list[str]:
    return __all__
