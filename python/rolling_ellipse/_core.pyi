"""Types of the C++ core (src/bindings)."""

import enum
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._ask import settings as _settings
from ._ask.check import FloatArray

class Mode(enum.IntEnum):
    """Mode of motion; one code per sample."""

    ROLLING = 0
    SLIDING = 1
    FLIGHT = 2
    REST = 3

class Restitution(enum.Enum):
    """Law of restitution."""

    STRONGE = 0
    POISSON = 1
    NEWTON = 2

class Painleve(enum.Enum):
    """Is there exactly one possible motion?"""

    DETERMINED = 0
    NO_MOTION = 1
    TWO_MOTIONS = 2

class Validity(enum.Enum):
    """Is rolling valid for the whole motion?"""

    VALID = 0
    INVALID = 1
    EDGE = 2
    NO_PROOF = 3

class Outcome(enum.IntEnum):
    """The first thing that happens to a rolling body."""

    RESTS = 0
    ROCKS = 1
    ROLLS_OVER = 2
    SLIPS = 3
    LOSES_CONTACT = 4
    JAMS = 5
    EDGE = 6

class EventKind(enum.Enum):
    """Kind of an event."""

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
    """A quantity of a motion."""

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
    def __init__(
        self, numbers: dict[str, float | None], impulse: Impulse | None, reached: bool
    ) -> None: ...
    @property
    def gyration2(self) -> float: ...

class Losses:
    @property
    def energy(self) -> float: ...
    @property
    def constraints(self) -> float: ...
    @property
    def projected(self) -> float: ...

class Solution:
    @property
    def ending(self) -> int: ...
    @property
    def followed_until(self) -> float: ...
    @property
    def valid_until(self) -> float: ...
    @property
    def message(self) -> str: ...
    @property
    def model(self) -> _settings.Model: ...
    @property
    def method(self) -> _settings.Method: ...
    @property
    def events(self) -> FloatArray: ...
    @property
    def stats(self) -> dict[str, int]: ...
    def reason(self, scene: Scene) -> str: ...
    def losses(self) -> Losses | None: ...
    def knots(self) -> FloatArray: ...
    def passages(
        self, quantity: Quantity, values: FloatArray, direction: int
    ) -> tuple[list[FloatArray], list[str]]: ...
    def zeros(
        self, function: Callable[[FloatArray], FloatArray], direction: int
    ) -> tuple[list[FloatArray], list[str]]: ...
    def sample_rolling(self, t: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]: ...
    def sample_coordinates(self, t: FloatArray) -> tuple[FloatArray, FloatArray]: ...
    def sample_contact(self, t: FloatArray) -> dict[str, Any]: ...

def support(n: int, arguments: list[FloatArray]) -> FloatArray: ...
def support_slope(n: int, arguments: list[FloatArray]) -> FloatArray: ...
def support_curvature(n: int, arguments: list[FloatArray]) -> FloatArray: ...
def curvature_radius(n: int, arguments: list[FloatArray]) -> FloatArray: ...
def contact_distance(n: int, arguments: list[FloatArray]) -> FloatArray: ...
def contact_angle(n: int, arguments: list[FloatArray]) -> FloatArray: ...
def centre_path(n: int, arguments: list[FloatArray]) -> FloatArray: ...
def arc_length(n: int, arguments: list[FloatArray]) -> FloatArray: ...
def initial_state(scene: Scene) -> dict[str, Any]: ...
def event_state(scene: Scene, row: Sequence[float], after: bool) -> dict[str, float]: ...
def certify(scene: Scene) -> dict[str, Any]: ...
def validate_length(name: str, value: float) -> None: ...
def classify_array(n: int, arguments: list[FloatArray], workers: int) -> npt.NDArray[np.int8]: ...
def outcome_array(scene: Scene, n: int, impulses: list[FloatArray]) -> npt.NDArray[np.int8]: ...
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
def simulate(scene: Scene, settings: Settings, t_end: float) -> Solution: ...
def simulate_coordinates(
    scene: Scene, q: FloatArray, q_dot: FloatArray, settings: Settings, t_end: float
) -> Solution: ...
def first_refused(scenes: FloatArray, reached: bool) -> tuple[int, str] | None: ...
def validate_settings(settings: Settings, t_end: float) -> None: ...
def simulate_table(
    scenes: FloatArray, settings: Settings, times: FloatArray, workers: int
) -> dict[str, npt.NDArray[Any]]: ...
def multiplier_detail(
    scene: Scene, settings: Settings, q: FloatArray, q_dot: FloatArray
) -> tuple[FloatArray, FloatArray]: ...
def contact_detail(scene: Scene, samples: dict[str, FloatArray]) -> dict[str, FloatArray]: ...
def project(scene: Scene, q: FloatArray, q_dot: FloatArray) -> tuple[FloatArray, FloatArray]: ...
def constraint_system(
    q: FloatArray, q_dot: FloatArray, a: float, b: float
) -> tuple[FloatArray, FloatArray]: ...
def period(scene: Scene) -> float: ...
def flow_scalar(
    t: float,
    a: float,
    b: float,
    theta: float,
    omega: float,
    gravity: float,
    gyration2: float | None,
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
) -> tuple[FloatArray, FloatArray, FloatArray]: ...
def flow_array(
    n: int, arguments: list[FloatArray], workers: int, level: str = "best"
) -> tuple[FloatArray, FloatArray, FloatArray]: ...
def flow_levels() -> list[str]: ...
def collide_arrays(
    n: int, arguments: list[FloatArray], law: Restitution
) -> tuple[FloatArray, FloatArray, FloatArray]: ...
def constraints(
    q: FloatArray, q_dot: FloatArray, a: float, b: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]: ...
def kinematics(
    n: int, theta: FloatArray, omega: FloatArray, a: float, b: float
) -> tuple[FloatArray, FloatArray]: ...
def rolling_equation(
    scene: Scene, theta: FloatArray, omega: FloatArray
) -> tuple[FloatArray, FloatArray]: ...
def feedback_growth(settings: Settings) -> float: ...
def tableaus() -> dict[str, dict[str, Any]]: ...
def build() -> dict[str, str]: ...
def rolling_contact(
    scene: Scene, theta: FloatArray, omega: FloatArray
) -> dict[str, FloatArray]: ...
def rolling_detail(
    scene: Scene, theta: FloatArray, omega: FloatArray, x: FloatArray
) -> dict[str, FloatArray]: ...
