"""How many examples the properties have, and which.

The suite draws the same ones every time, a few of each property. Any number of new ones:

    ROLLING_ELLIPSE_EXAMPLES=5000 pytest tests/properties

What fails is printed as the smallest example that does, with a line that draws it again.
"""

import os
import tempfile
from pathlib import Path

from hypothesis import HealthCheck, settings

#: Constants of the sources, which hypothesis tries as numbers, are kept there and not in the
#: checkout.
FOLDER = Path(tempfile.gettempdir()) / "rolling_ellipse_hypothesis"

examples = os.environ.get("ROLLING_ELLIPSE_EXAMPLES")
os.environ.setdefault("HYPOTHESIS_STORAGE_DIRECTORY", str(FOLDER))
settings.register_profile(
    "rolling_ellipse",
    max_examples=int(examples or 60),
    derandomize=examples is None,
    deadline=None,  # whatever else the machine does
    database=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("rolling_ellipse")
