"""Arguments as source text: ordinary numbers, extremes, and values that are not numbers.

Everything drawn is a Python expression, so that a finding can be pasted into a shell.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TypeVar

from hypothesis import strategies as st

T = TypeVar("T")

# Limits of doubles, of the package and of integers, and neighbours of some limits.
EXTREMES = (
    "0", "0.0", "-0.0", "nan", "-nan", "inf", "-inf", "5e-324", "-5e-324",
    "2.2250738585072014e-308", "2.225073858507201e-308", "1.7976931348623157e308",
    "-1.7976931348623157e308", "1e-300", "1e300", "1e-160", "1e160", "-1", "-1.0", "1", "1.0", "2",
    "2**31", "-2**31", "2**32", "2**40", "2**53 + 1", "2**63", "2**63 - 1", "2**64",
    "1e16", "0.1", "1e-30", "1e30", "nextafter(1e-30, 0)", "nextafter(1e30, inf)", "1e-3", "1e3",
    "nextafter(1e-3, 0)", "nextafter(1e3, inf)", "pi / 2", "-pi / 2", "1.5", "-1.5",
    "nextafter(1.5, 2)", "nextafter(1, 0)", "nextafter(1, 2)", "1e50", "1e22", "1e6", "1e-6",
)  # fmt: skip

# Numbers of other types: the package accepts each, or rejects it and names the argument.
DRESSED = (
    "True", "np.bool_(True)", "np.float16(1.5)", "np.float32(1.5)", "np.int8(1)",
    "np.uint64(2**64 - 1)", "np.longdouble(1) / 3", "Fraction(1, 3)", "Decimal('0.5')",
    "np.array(1.0)", "np.array([1.0])", "np.float64(nan)", "np.array(2, dtype='>i4')",
    "type('Mine', (float,), {})(2.0)", "type('Whole', (), {'__index__': lambda self: 3})()",
)  # fmt: skip

# Values that are not a single number.
WRONG = (
    "None", "'1'", "'nan'", "''", "b'1'", "bytearray(b'1')", "1j", "complex(1, 0)",
    "np.complex64(1)", "np.complex128(2)", "np.array([1 + 2j, 3])", "np.ma.masked",
    "np.ma.masked_array([1.0, 2.0], [False, True])", "np.ma.masked_array(1.0, True)",
    "np.array([1.0, None])", "np.array(1.0, dtype=object)", "np.datetime64('2020-01-01')",
    "np.datetime64('NaT')", "np.timedelta64(3, 's')", "np.array('1')", "np.array(['1', '2'])",
    "[]", "()", "[1.0]", "[[1.0], [2.0, 3.0]]", "[None]", "{}", "{1.0}", "{'a': 1.0}",
    "(v for v in (1.0, 2.0))", "Decimal('NaN')", "Decimal('1e400')", "Decimal('sNaN')",
    "np.longdouble('1e4000')", "10**400", "-10**400", "Fraction(10**400)", "object()", "type",
    "range(3)", "slice(3)", "...", "NotImplemented", "np.void(b'abc')", "memoryview(b'abc')",
    "np.array([(1.0, 2.0)], dtype='f8,f8')", "np.empty(0)", "np.empty((2, 0))", "np.ones((2, 3))",
    "np.ones((1, 1, 1, 1))", "np.array([1.0, 2.0, 3.0])", "np.array(['NaT'], dtype='M8[s]')",
    "[1.0, 'a']", "np.array([10**400])", "'\\ud800'", "'a' * 10000", "np.ones((1,) * 40)",
    "eval('[' * 90 + ']' * 90)", "type('Mine', (str,), {})('auto')",
    "type('Metre', (), {'unit': 'm', '__float__': lambda self: 2.0})()",
    "np.ones(3).view(type('Metres', (np.ndarray,), {'units': 'm'}))",
    "[np.array(1.0).view(type('Metres', (np.ndarray,), {'units': 'm'}))] * 2",
)  # fmt: skip

SHAPES = ((), (), (), (1,), (3,), (7,), (0,), (2, 3), (2, 1), (1, 1), (2, 0), (40,))

# Expressions that create an array, or another sequence, from a list of numbers.
MAKES = (
    *["np.array({0})"] * 8, *["{0}"] * 3, "tuple({0})", "np.array({0}, dtype='>f8')",
    "np.repeat({0}, 2)[::2]", "np.array({0}[::-1])[::-1]", "np.array({0}, dtype=np.longdouble)",
    "np.frombuffer(np.array({0}).tobytes())",
    "np.frombuffer(b'-' + np.array({0}).tobytes(), float, offset=1)",
    "np.array([(1, v) for v in {0}], dtype='i1,f8')['f1']",
)  # fmt: skip

# Arguments that bound the work and therefore get no large numbers.
WORK = ("max_steps", "max_events", "count", "max_frames", "width", "dpi")


class Draw:
    """The choices of one case, made by Hypothesis; the first option is the simplest."""

    def __init__(self, draw: st.DrawFn) -> None:
        self._draw = draw

    def pick(self, *options: T) -> T:
        found: T = self._draw(st.sampled_from(options))
        return found

    def of(self, strategy: st.SearchStrategy[T]) -> T:
        return self._draw(strategy)

    def chance(self, probability: float) -> bool:
        return self._draw(st.integers(0, 99)) >= 100 * (1 - probability)

    def between(self, low: float, high: float) -> float:
        return self._draw(st.floats(low, high))

    def share(self) -> float:
        """Draw a number in [0, 1)."""
        return self._draw(st.floats(0, 1, exclude_max=True))

    def whole(self, low: int, high: int) -> int:
        return self._draw(st.integers(low, high))

    def power(self, low: float, high: float) -> float:
        """Draw a number between 10^low and 10^high; sometimes a pure power of ten."""
        if self.chance(0.2):
            return 10.0 ** self.whole(math.ceil(low), math.floor(high))
        return float(10.0 ** self.between(low, high))

    def count(self, most: int) -> int:
        """Draw a whole number from 1 to `most`, on a logarithmic scale."""
        return round(self.power(0, math.log10(most)))

    def beside(self, value: float) -> float:
        """The value, or a double a few ulp away from it."""
        for _ in range(self.pick(0, 0, 1, 1, 2, 7)):
            value = math.nextafter(value, self.pick(-math.inf, math.inf))
        return value

    def extreme(self) -> str:
        kind = self.whole(0, 3)
        if kind == 0:
            return repr(self.pick(1, 1, -1) * 2.0 ** self.whole(-1074, 1023))
        if kind == 1:
            return self.pick("nan", "inf", "-inf", repr(self._draw(st.floats())))
        return self.pick(*EXTREMES)

    def hostile(self) -> str:
        """Draw a value that a caller might pass by mistake."""
        return self.extreme() if self.chance(0.5) else self.pick(*DRESSED, *WRONG, *WRONG)

    def mutated(self, arguments: dict[str, str]) -> dict[str, str]:
        """The arguments of a call; up to two of them are hostile."""
        found = dict(arguments)
        for _ in range(self.pick(*[0] * 20, *[1] * 4, 2) if found else 0):
            name = self.pick(*found)
            found[name] = self.odd(name)
        return found

    def odd(self, name: str) -> str:
        return self.pick("0", "-1", "nan", *WRONG) if name in WORK else self.hostile()

    def array(self, values: Sequence[float], shape: tuple[int, ...] | None = None) -> str:
        """Source text of an array, or of another sequence, with the given numbers."""
        if shape is not None and len(shape) != 1:
            return f"np.array({list(values)}).reshape({shape})"
        if all(abs(v) < 1e9 for v in values) and self.chance(0.05):
            kind = self.pick("np.float32", "np.int64", "bool")
            return f"np.array({list(values)}).astype({kind})"
        return self.pick(*MAKES).format(list(values))


def call(function: str, *arguments: str, **options: str) -> str:
    """Source text of a call; the options are passed by name."""
    parts = [*arguments, *(f"{name}={value}" for name, value in options.items())]
    return f"{function}({', '.join(parts)})"
