"""Pictures and films: everything that needs matplotlib, loaded when first asked for."""

from .animation import animate
from .constraints import plot_constraints
from .energy import plot_energy
from .error import plot_error
from .forces import plot_forces
from .overview import plot
from .paths import plot_paths
from .phase import plot_phase
from .phase_map import plot_phase_map
from .strobe import plot_strobe

__all__ = [
    "animate", "plot", "plot_constraints", "plot_energy", "plot_error", "plot_forces", "plot_paths",
    "plot_phase", "plot_phase_map", "plot_strobe",
]  # fmt: skip
