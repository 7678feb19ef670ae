"""Columns of what is remembered of a recorded person, as one row of float64."""

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.body.traits import PHASE as TRAIT_PHASE
from locomotion.body.traits import TRAITS as _TRAITS

__all__ = ["BEFORE", "OFFSETS", "PLACE", "RATES", "ROW", "STEPS", "TRAITS", "new_row"]

GAIT = 0
"""Number of the gait (of the posture graph) that it moves in, -1 at rest."""
PHASE = 1
"""Of the gait's cycle, 0 to 1, from the right foot's strike."""
SPEED = 2
"""[m/s] at which it is drawn: its body's of late; below 0 backwards."""
LEVEL = 3
"""What is sampled of it: the number of one of `locomotion.recorded.skeletons.LEVELS`."""
NODE = 4
"""Number of the posture that it is in while it plays none: what its hands hold changes its arms."""
BUSY = 5
"""1 while it plays its postures or is about to."""
AGE, SINCE = 6, 7
"""Ticks since it was made, and since its body's last: bodies have theirs in turns."""
CROSSES = 8
"""What it does about an obstacle on its way: one of `NOTHING`, `APPROACHES`, `RUNS_UP`, `CLEARS`."""
NOTHING, APPROACHES, RUNS_UP, CLEARS = 0.0, 1.0, 2.0, 3.0
LATE = 9
"""[s] since its steps went on last, by which its phase, speed and feet are behind."""
PLACE = slice(10, 14)
"""x, y, z [m] and yaw [rad] where it is drawn: between its body's last two places."""
BEFORE = slice(14, 18)
"""The first of these. What every tick needs of everybody ends here; memory is read in this order."""
LAID = 18
"""1 while it has feet on the ground in `STEPS`: it stands, walks or runs."""
STILL = 19
"""1 while its body is at rest and its feet are where they belong: its steps have come to an end."""
HASTE = 20
"""How many times as quick its steps are as its speed has them: it comes to an obstacle in step."""
FADE_BEGUN, FADE_SECONDS = 21, 22
"""[s] of its own time when its motion last changed from one source to another, and how long that shows."""
TRAITS = slice(23, 23 + len(_TRAITS))
"""What it differs from others in (`locomotion.body.traits`)."""
STEPS = slice(TRAITS.stop, TRAITS.stop + 2 * 3 * 6)
"""(2, 3, 6) of the right and the left foot: where it stands, is on its way to, and is to be put down
(`locomotion.recorded_people.stepping`): x, y, z [m], heading, slopes ahead and to the left [rad]."""
OFFSETS = slice(STEPS.stop, STEPS.stop + 6 + len(JOINT_NAMES))
"""How it differed, when its motion last changed, from where the new motion has it: root [m], its turn as a
rotation vector [rad] in the world, joints [rad] (`locomotion.recorded_people.fading`)."""
RATES = slice(OFFSETS.stop, OFFSETS.stop + 6 + len(JOINT_NAMES))
"""How fast that changed [1/s]."""
ROW = RATES.stop


def new_row(level: int, node: int, traits: np.ndarray, place: np.ndarray) -> np.ndarray:
    """One with these ``traits`` (7,) that stands at ``place`` (4,), (ROW,) float64."""
    row = np.zeros(ROW)
    row[GAIT], row[PHASE], row[LEVEL], row[NODE] = -1.0, traits[TRAIT_PHASE], level, node
    row[TRAITS], row[HASTE] = traits, 1.0
    row[PLACE] = row[BEFORE] = place
    return row
