"""Speed versus accuracy: many methods for one motion, judged and timed side by side."""

from .race import work_precision as work_precision
from .results import WorkPrecision as WorkPrecision
