"""Split a file of a trajectory into its JSON and arrays, and join them again."""

import io
import json
from collections.abc import Callable
from typing import Any

import numpy as np


def taken_apart(content: bytes) -> tuple[Any, dict[str, Any]]:
    """The JSON of a file, and its arrays."""
    with np.load(io.BytesIO(content)) as data:
        arrays: dict[str, Any] = {name: data[name] for name in data.files}
    return json.loads(str(arrays.pop("about"))), arrays


def put_together(about: Any, arrays: dict[str, Any], save: Callable[..., None] = np.savez) -> bytes:
    file = io.BytesIO()
    text = about if isinstance(about, str) else json.dumps(about)
    save(file, about=np.array(text), **arrays)
    return file.getvalue()
