"""The state of a person's gait as the run keeps it, also of one that walks."""

import numpy as np

from locomotion.gaits.run import layout as run
from locomotion.gaits.walk import layout as walk
from locomotion.human.human import Human

__all__ = ["gait_state"]


def gait_state(human: Human) -> np.ndarray:
    """The running controller's state, (`locomotion.gaits.run.layout.STATE_SIZE`,); in a walk with heading,
    turn rate, speed, stance and steps of the walk in place of its own."""
    state, memory = human.control, human.on_feet.walk
    if not human.on_feet.walks:
        return state
    state = state.copy()
    state[run.HEADING], state[run.TURN_RATE] = memory[walk.WALK_HEADING], memory[walk.WALK_TURN_RATE]
    state[run.SPEED], state[run.STANCE] = memory[walk.WALK_SPEED], memory[walk.WALK_STANCE]
    state[run.STEPS] = memory[walk.WALK_STEPS]
    return state
