"""Any state that a motion returns can start a motion with the same mode and later events.

reference/judge_restarts.py draws the motions, and uses their ends, samples, states after events and
intermediate scenes as starts. Its first lines state the tolerances.
"""

import math
import secrets

import pytest
import rolling_ellipse as rl
from hypothesis import settings
from judge_restarts import BLOCK, STUDIES, judge

KNOWN = settings.get_profile("rolling_ellipse")
BLOCKS = math.ceil(3 * KNOWN.max_examples / BLOCK)
SEED = 1 if KNOWN.derandomize else secrets.randbits(32)
MET = {  # labels of findings that must occur, by study
    "ends": ("ROLLING", "SLIDING", "FLIGHT", "REST"),
    "events": tuple(
        f"{kind} by {road}"
        for kind in ("SLIP SLIDING", "STICK ROLLING", "REVERSE SLIDING", "LIFT_OFF FLIGHT",
                     "IMPACT FLIGHT", "IMPACT SLIDING", "IMPACT ROLLING")
        for road in ("event", "at", "scene_at")
    ),
    "cut": ("FLIGHT IMPACT by end", "FLIGHT IMPACT by before", "SLIDING STICK by before"),
}  # fmt: skip


@pytest.mark.filterwarnings("ignore::rolling_ellipse.ValidityWarning")
@pytest.mark.parametrize("study", STUDIES)
def test_a_motion_continues_from_any_state_that_it_returns(study: str) -> None:
    """The states are ends, states at events, and states where `max_events` stopped the motion."""
    met = set()
    for block in range(BLOCKS):
        found = judge(study, SEED, block)
        assert found["cases"] == []
        met |= {label for label, verdict, *_ in found["counts"] if verdict == "same"}
    assert met >= {*MET[study]}


def test_only_scenes_from_scene_at_may_start_with_an_impact() -> None:
    """A scene built from the same numbers would move into the ground."""
    motion = rl.simulate(rl.scenes.bounce, 5.0, max_events=3, raise_on_failure=False)
    due = motion.scene_at(motion.t_end)
    assert due.initial_state.mode is rl.Mode.FLIGHT
    assert rl.simulate(due, 0.1).events[0].kind is rl.EventKind.IMPACT
    with pytest.raises(ValueError, match=r"^z_dot must be at least h'\(theta\)\*omega"):
        due.replace()
