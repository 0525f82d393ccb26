"""Pictures and films: all code that needs matplotlib, imported on first use."""

from .animation import animate as animate
from .curves import plot_curves as plot_curves
from .errors import plot_constraints as plot_constraints
from .errors import plot_energy as plot_energy
from .errors import plot_error as plot_error
from .forces import plot_forces as plot_forces
from .overview import plot as plot
from .phase import plot_phase as plot_phase
from .phase_map import plot_phase_map as plot_phase_map
from .stills import plot_paths as plot_paths
from .stills import plot_strobe as plot_strobe
