"""Types of the C++ core (src/bindings)."""

import enum
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _settings
from ._check import FloatArray

class Mode(enum.IntEnum):
    """What the body does, one code a sample."""

    ROLLING = 0
    SLIDING = 1
    FLIGHT = 2
    REST = 3

class Restitution(enum.Enum):
    """What restitution means."""

    STRONGE = 0
    POISSON = 1
    NEWTON = 2

class Painleve(enum.Enum):
    """Does exactly one motion go on?"""

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
    """What a rolling body comes to first."""

    RESTS = 0
    ROCKS = 1
    ROLLS_OVER = 2
    SLIPS = 3
    LOSES_CONTACT = 4
    JAMS = 5
    EDGE = 6

class Model(enum.Enum):
    AUTO = 0
    ROLLING = 1
    MULTIPLIERS = 2
    CONTACT = 3

class EventKind(enum.Enum):
    """What changes at an event."""

    SLIP = 0
    STICK = 1
    REVERSE = 2
    LIFT_OFF = 3
    IMPACT = 4
    REST = 5
    JAM = 6

class Stabilization(enum.Enum):
    NONE = 0
    BAUMGARTE = 1
    PROJECTION = 2
    PROJECTION_ENERGY = 3
    GGL = 4

class Method(enum.Enum):
    AUTO = 0
    EXACT = 1
    DOP853 = 2
    DOPRI5 = 3
    RK4 = 4
    GAUSS = 5
    RADAU = 6

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
    """What a motion may pass a value of."""

    theta = 0
    x = 1
    z = 2
    omega = 3
    contact_x = 4

class Settings:
    def __init__(
        self,
        *,
        model: Model,
        method: Method,
        rtol: float,
        atol: float,
        step: float | None,
        stages: int | None,
        stabilization: Stabilization,
        baumgarte: tuple[float, float],
        max_steps: int,
        max_events: int,
        rest_speed: float | None,
    ) -> None: ...

class Impulse:
    def __init__(self, jx: float, jz: float, dx: float, dz: float) -> None: ...

class Scene:
    def __init__(
        self,
        a: float,
        b: float,
        mass: float,
        gravity: float,
        inertia: float | None,
        slope: float,
        friction: float,
        restitution: float,
        theta: float,
        omega: float,
        x: float,
        z: float | None,
        x_dot: float | None,
        z_dot: float | None,
        impulse: Impulse | None,
        reached: bool,
    ) -> None: ...
    @property
    def gyration2(self) -> float: ...

class State:
    @property
    def theta(self) -> float: ...
    @property
    def omega(self) -> float: ...
    @property
    def x(self) -> float: ...
    @property
    def z(self) -> float: ...
    @property
    def x_dot(self) -> float: ...
    @property
    def z_dot(self) -> float: ...
    @property
    def mode(self) -> Mode: ...

class InitialState:
    @property
    def state(self) -> State: ...
    @property
    def reaction_x(self) -> float: ...
    @property
    def reaction_z(self) -> float: ...
    @property
    def free_omega(self) -> float: ...
    @property
    def energy_lost(self) -> float: ...
    @property
    def touching(self) -> bool: ...
    @property
    def slip_removal(self) -> str: ...

class Continuation:
    @property
    def mode(self) -> Mode: ...
    @property
    def paradox(self) -> Painleve: ...
    @property
    def why_it_rolls(self) -> str: ...

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
def initial_state(scene: Scene) -> InitialState: ...
def first_continuation(scene: Scene, start: State) -> Continuation: ...
def energy_lost(scene: Scene, before: Sequence[float], after: Sequence[float]) -> float: ...
def certify(scene: Scene) -> dict[str, Any]: ...
def validate_length(name: str, value: float) -> None: ...
def classify_array(n: int, arguments: list[FloatArray], workers: int) -> npt.NDArray[np.int8]: ...
def outcome_array(scene: Scene, n: int, impulses: list[FloatArray]) -> npt.NDArray[np.int8]: ...
def outcome(scene: Scene) -> Outcome: ...
def required_friction(scene: Scene) -> float: ...
def sticking_friction(scene: Scene) -> float: ...
def press_to(scene: Scene, distance: float, omega: float) -> float: ...
def speed_to_the_tip(scene: Scene) -> float: ...
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
def contact_detail(
    scene: Scene,
    theta: FloatArray,
    omega: FloatArray,
    x: FloatArray,
    z: FloatArray,
    x_dot: FloatArray,
    z_dot: FloatArray,
    normal_force: FloatArray,
    friction_force: FloatArray,
) -> dict[str, FloatArray]: ...
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
