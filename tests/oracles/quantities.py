"""Numbers with units like those of other libraries, and plain numbers that resemble them."""

from typing import Any

import numpy as np


class Pint:
    """A wrapper of a number or an array, like Quantity of pint, which NumPy can convert."""

    def __init__(self, magnitude: Any, units: str = "centimeter") -> None:
        self.magnitude, self.units = magnitude, units

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.magnitude, dtype)

    def __float__(self) -> float:
        return float(self.magnitude)


class Astropy(np.ndarray):
    """A subclass of arrays with an attribute `unit`, like Quantity and Column of astropy."""

    unit: Any = None


class Unyt(np.ndarray):
    """A subclass of arrays with a property `units`, like unyt_array and Quantity of quantities."""

    @property
    def units(self) -> Any:
        return "cm"


class Brian(np.ndarray):
    """A subclass of arrays with an attribute `dimensions`, like Quantity of brian2."""

    dimensions = frozenset({"length"})


class OpenMM:
    """An object with a value and a unit, like Quantity of openmm."""

    def __init__(self, value: Any) -> None:
        self.value, self.unit = value, "angstrom"

    def __float__(self) -> float:
        return float(self.value)


class Labelled:
    """An array whose entries of `attrs` are also attributes, like DataArray of xarray."""

    __slots__ = ("attrs", "data")

    def __init__(self, data: Any, **attrs: Any) -> None:
        self.data, self.attrs = data, attrs

    def __getattr__(self, name: str) -> Any:
        if name in ("data", "attrs") or name not in self.attrs:
            raise AttributeError(name)
        return self.attrs[name]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.asarray(self.data, dtype)


class NetCDF:
    """A variable with the names of its axes, like Variable of netCDF4."""

    dimensions = ("time",)

    def __init__(self, values: Any) -> None:
        self.values = values

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        return np.array(self.values, dtype)


def with_unit(values: Any) -> Astropy:
    found = np.array(values).view(Astropy)
    found.unit = "cm"
    return found


def quantities(value: Any) -> list[Any]:
    """Numbers or arrays with units, like those of each library."""
    found = [
        Pint(value), Pint(value, "dimensionless"), with_unit(value), np.array(value).view(Unyt),
        np.array(value).view(Brian), Labelled(Pint(value)),
    ]  # fmt: skip
    return [*found, OpenMM(value)] if np.ndim(value) == 0 else found


def plain(values: list[float]) -> list[Any]:
    """Arrays without units that have attributes such as `unit` or `dimensions`."""
    return [np.array(values).view(Astropy), Labelled(np.array(values), units="m"), NetCDF(values)]
