"""Speed versus accuracy: the errors and the times of many methods for one motion."""

from .race import work_precision as work_precision
from .results import WorkPrecision as WorkPrecision
