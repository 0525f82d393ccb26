"""Speed against accuracy: many ways to compute one motion, timed side by side and judged."""

from .race import work_precision
from .results import WorkPrecision
from .run import Errors, Run

__all__ = ["Errors", "Run", "WorkPrecision", "work_precision"]
