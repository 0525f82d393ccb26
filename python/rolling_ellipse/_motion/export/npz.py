"""Arrays of .npz files that may be damaged or foreign."""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Collection
from typing import Any

import numpy as np
import numpy.typing as npt

_VERSION = 1, 0  # version of .npy files; NumPy writes others only for very long headers
_HEADER = 256  # largest header of a .npy file [bytes]; arrays of numbers and text have 118


def arrays(content: bytes, names: Collection[str]) -> dict[str, npt.NDArray[Any]]:
    """Return the read-only arrays in the bytes of a file written by `numpy.savez`.

    Nothing is decompressed or unpickled, and no array is larger than the file. Any other content
    raises an exception of some kind.
    """
    found: dict[str, npt.NDArray[Any]] = {}
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        for member in archive.infolist():
            name = member.filename.removesuffix(".npy")
            if name in found or name not in names or name == member.filename:
                raise ValueError(f"it must hold known arrays, once each, got {member.filename!r}")
            if member.compress_type != zipfile.ZIP_STORED:
                raise ValueError(f"{name} must not be compressed")
            found[name] = _array(name, archive.read(member))
    return found


def _array(name: str, content: bytes) -> npt.NDArray[Any]:
    """Return the array in the bytes of a .npy file; its header must fit their number."""
    file = io.BytesIO(content)
    if (version := np.lib.format.read_magic(file)) != _VERSION:
        raise ValueError(f"{name} must be of version {_VERSION}, got {version}")
    shape, fortran_order, dtype = np.lib.format.read_array_header_1_0(file, _HEADER)
    if dtype.kind not in "fiU" or fortran_order:
        raise ValueError(f"{name} must hold numbers or text row by row, got {dtype}")
    size, start = math.prod(shape) * dtype.itemsize, file.tell()
    if size != len(content) - start:
        raise ValueError(f"{name} must have {size} bytes, got {len(content) - start}")
    values: npt.NDArray[Any] = np.ndarray(shape, dtype, buffer=content, offset=start)
    return values if dtype.isnative else values.astype(dtype.newbyteorder("="))


def require_array(
    name: str, values: npt.NDArray[Any], dtype: npt.DTypeLike, shape: tuple[int, ...],
    *, finite: bool = True,
) -> None:  # fmt: skip
    """Raise ValueError for another type or shape, or (if `finite`) for an infinite entry or NaN."""
    if values.dtype != dtype or values.shape != shape:
        raise ValueError(
            f"{name} must be of type {np.dtype(dtype)} and shape {shape}, got {values.dtype} and "
            f"{values.shape}"
        )
    if finite and not np.isfinite(values).all():
        raise ValueError(f"{name} must be finite, got {values[~np.isfinite(values)][0]!s}")
