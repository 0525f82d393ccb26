"""What a writer may leave behind."""

from typing import Any


def half_a_file(file: Any, **arrays: Any) -> None:
    file.write(b"PK half of what should be here")
    file.flush()
