"""Many motions: scenes in tables, computed chunk by chunk by workers, in memory or in a folder."""

from .answers import MotionArrays as MotionArrays
from .ends import Ends as Ends
from .ends import ends as ends
from .event_arrays import EventArrays as EventArrays
from .folders import load_many as load_many
from .many import simulate_many as simulate_many
