"""Types of the C++ core (src/bindings)."""

import enum
from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from ._ask import settings as _settings
from ._ask.check import FloatArray

_Two = tuple[FloatArray, FloatArray]
_Three = tuple[FloatArray, FloatArray, FloatArray]
_Columns = list[FloatArray]  # of arguments, as `broadcast` returns them
_Found = tuple[list[FloatArray], list[str]]  # times of each value, and why some are missing

class Mode(enum.IntEnum):
    ROLLING = 0
    SLIDING = 1
    FLIGHT = 2
    REST = 3

class Restitution(enum.Enum):
    STRONGE = 0
    POISSON = 1
    NEWTON = 2

class Painleve(enum.Enum):
    DETERMINED = 0
    NO_MOTION = 1
    TWO_MOTIONS = 2

class Validity(enum.Enum):
    VALID = 0
    INVALID = 1
    EDGE = 2
    NO_PROOF = 3

class Outcome(enum.IntEnum):
    RESTS = 0
    ROCKS = 1
    ROLLS_OVER = 2
    SLIPS = 3
    LOSES_CONTACT = 4
    JAMS = 5
    EDGE = 6

class EventKind(enum.Enum):
    SLIP = 0
    STICK = 1
    REVERSE = 2
    LIFT_OFF = 3
    IMPACT = 4
    REST = 5
    JAM = 6

class Ending(enum.Enum):
    COMPLETED = 0
    MAX_STEPS = 1
    STEP_TOO_SMALL = 2
    STEP_TOO_LARGE = 3
    MAX_EVENTS = 4
    JAMMED = 5
    UNDETERMINED = 6
    VALIDITY_LOST = 7

class Quantity(enum.Enum):
    theta = 0
    x = 1
    z = 2
    omega = 3
    contact_x = 4

FIELDS: dict[str, dict[str, str]]  # units of the numbers of each struct, by name
COLUMNS: dict[str, tuple[str, ...]]  # of the tables that `simulate_table` takes and returns
STATS: tuple[str, ...]
MODELS: tuple[_settings.Model, ...]  # by their codes, as the others
METHODS: tuple[_settings.Method, ...]
STABILIZATIONS: tuple[_settings.Stabilization, ...]

class Settings:
    def __init__(self, fields: dict[str, Any]) -> None: ...

class Impulse:
    def __init__(self, jx: float, jz: float, dx: float, dz: float) -> None: ...

class Scene:
    gyration2: Final[float]

class Solution:
    ending: Final[int]
    followed_until: Final[float]
    message: Final[str]
    model: Final[_settings.Model]
    method: Final[_settings.Method]
    events: Final[FloatArray]
    stats: Final[dict[str, int]]
    def reason(self, scene: Scene) -> str: ...
    def valid_until(self, scene: Scene) -> float: ...
    def losses(self) -> tuple[float, float, float] | None: ...
    def knots(self) -> FloatArray: ...
    def passages(self, quantity: Quantity, values: FloatArray, direction: int) -> _Found: ...
    def zeros(self, function: Callable[[FloatArray], FloatArray], direction: int) -> _Found: ...
    def sample_at(self, scene: Scene, settings: Settings, t: float) -> dict[str, Any]: ...
    def samples(self, t: FloatArray) -> tuple[FloatArray, ...]: ...

def support(n: int, arguments: _Columns) -> FloatArray: ...
def support_slope(n: int, arguments: _Columns) -> FloatArray: ...
def support_curvature(n: int, arguments: _Columns) -> FloatArray: ...
def curvature_radius(n: int, arguments: _Columns) -> FloatArray: ...
def contact_distance(n: int, arguments: _Columns) -> FloatArray: ...
def contact_angle(n: int, arguments: _Columns) -> FloatArray: ...
def centre_path(n: int, arguments: _Columns) -> FloatArray: ...
def arc_length(n: int, arguments: _Columns) -> FloatArray: ...
def scene_of(numbers: dict[str, Any], impulse: Impulse | None, reached: bool) -> Scene | None: ...
def initial_state(scene: Scene) -> dict[str, Any]: ...
def event_state(scene: Scene, row: Sequence[float], after: bool) -> dict[str, float]: ...
def certify(scene: Scene) -> dict[str, Any]: ...
def validate_length(name: str, value: float) -> None: ...
def classify_array(n: int, arguments: _Columns, workers: int) -> npt.NDArray[np.int8]: ...
def outcome_array(scene: Scene, n: int, impulses: _Columns) -> npt.NDArray[np.int8]: ...
def outcome(scene: Scene) -> Outcome: ...
def required_friction(scene: Scene) -> float: ...
def sticking_friction(scene: Scene) -> float: ...
def press_to(scene: Scene, distance: float, omega: float) -> float: ...
def speed_to_the_tip(scene: Scene, theta: Any) -> Any: ...
def roll_over_speed(scene: Scene) -> float: ...
def thresholds(
    a: float, b: float, gravity: float, gyration2: float | None, friction: float
) -> dict[str, float | None]: ...
def lift_off(
    a: float,
    b: float,
    gravity: float,
    gyration2: float | None,
    friction: float,
    slip_speed: float,
    painleve_friction: float,
) -> tuple[float, tuple[tuple[float, float], ...]]: ...
def are_sample_times(t: FloatArray) -> bool: ...
def simulate(
    scene: Scene, settings: Settings, t: FloatArray, start: _Two | None
) -> tuple[Solution, tuple[FloatArray, ...]]: ...
def first_refused(scenes: FloatArray, reached: bool) -> tuple[int, str] | None: ...
def validate_settings(settings: Settings, t_end: float) -> None: ...
def ends_table(
    scenes: FloatArray, settings: Settings, times: FloatArray, workers: int
) -> dict[str, npt.NDArray[Any]]: ...
def simulate_table(
    scenes: FloatArray, settings: Settings, times: FloatArray, workers: int
) -> dict[str, npt.NDArray[Any]]: ...
def multiplier_detail(
    scene: Scene, settings: Settings, q: FloatArray, q_dot: FloatArray
) -> _Two: ...
def contact_detail(scene: Scene, samples: dict[str, FloatArray]) -> dict[str, FloatArray]: ...
def project(scene: Scene, q: FloatArray, q_dot: FloatArray) -> _Two: ...
def constraint_system(q: FloatArray, q_dot: FloatArray, a: float, b: float) -> _Two: ...
def period(scene: Scene) -> float: ...
def flow_scalar(
    t: float,
    a: float,
    b: float,
    theta: float,
    omega: float,
    gravity: float,
    gyration2: float | None,
    slope: float,
) -> tuple[float, float, float]: ...
def flow_times(
    t: FloatArray,
    a: float,
    b: float,
    theta: float,
    omega: float,
    gravity: float,
    gyration2: float | None,
    workers: int,
) -> _Three: ...
def flow_array(n: int, arguments: _Columns, workers: int, level: str = "best") -> _Three: ...
def slope_flow_array(n: int, arguments: _Columns, workers: int) -> _Three: ...
def flow_levels() -> list[str]: ...
def collide_arrays(n: int, arguments: _Columns, law: Restitution) -> _Three: ...
def constraints(
    q: FloatArray, q_dot: FloatArray, a: float, b: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]: ...
def kinematics(n: int, theta: FloatArray, omega: FloatArray, a: float, b: float) -> _Two: ...
def rolling_equation(scene: Scene, theta: FloatArray, omega: FloatArray) -> _Two: ...
def feedback_growth(settings: Settings) -> float: ...
def tableaus() -> dict[str, dict[str, Any]]: ...
def build() -> dict[str, str]: ...
def rolling_contact(
    scene: Scene, theta: FloatArray, omega: FloatArray
) -> dict[str, FloatArray]: ...
def rolling_detail(
    scene: Scene, theta: FloatArray, omega: FloatArray, x: FloatArray
) -> dict[str, FloatArray]: ...
