"""Number and choice of the examples for each property.

Every run of the suite draws the same few examples. To draw new ones:

    ROLLING_ELLIPSE_EXAMPLES=5000 pytest tests/properties

A failure is printed as its smallest example, with a line that reproduces it.
"""

import os
import tempfile
from pathlib import Path

from hypothesis import HealthCheck, settings

#: Folder, outside the checkout, for the constants that Hypothesis collects from the sources.
FOLDER = Path(tempfile.gettempdir()) / "rolling_ellipse_hypothesis"

examples = os.environ.get("ROLLING_ELLIPSE_EXAMPLES")
os.environ.setdefault("HYPOTHESIS_STORAGE_DIRECTORY", str(FOLDER))
settings.register_profile(
    "rolling_ellipse",
    max_examples=int(examples or 60),
    derandomize=examples is None,
    deadline=None,  # the load of the machine has no effect
    database=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("rolling_ellipse")
