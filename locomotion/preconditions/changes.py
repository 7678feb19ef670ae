"""Changes of gait: what their odds depend on, from the physical state just before them.

Everything sideways is mirrored, so that the stance foot is the left one.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.run import layout
from locomotion.gaits.walk.layout import WALK_STANCE
from locomotion.human.person import Person
from locomotion.paths.command import HEADING_ASKED

__all__ = [
    "BRAKE", "CHANGES", "CHANGE_FEATURES", "CHOICES", "END_RUN", "SLOW_DOWN", "WALK_TO_RUN",
    "Changing", "changing", "describe_change",
]  # fmt: skip

WALK_TO_RUN, SLOW_DOWN, BRAKE, END_RUN = "walk-to-run", "slow-down", "brake", "end-run"
CHANGES = {
    WALK_TO_RUN: "speed-up",
    SLOW_DOWN: "slow-down",
    BRAKE: "brake",
    END_RUN: "walk-policy",
}
"""Changes that have preconditions, and the package's skill that each is made of."""
CHOICES = ("choice", "second choice")
CHANGE_FEATURES = (
    *CHOICES, "grip", "asked speed", "speed ahead", "speed sideways", "speed up", "heading",
    "turning", "beside", "ahead of foot", "inside of foot", "height", "step time", "steps made", "step speed",
    "trim", "upright", "face down", "pelvis height", "spin",
    *(f"error of {name}" for name in layout.SENSORS),
)  # fmt: skip
"""What is chosen (walk to run: whether in haste, and [m/s] by which the reference begins faster; slowing
down: [m/s²]; braking: times the learned deceleration); friction; speed asked for [m/s]; velocity of the
centre of mass along the heading wanted [m/s]; direction of that off the velocity [rad], turn rate of the
pelvis [rad/s]; [m] off the path; centre of mass ahead, inside and above of the stance foot [m]; [s] since the
last step; steps made, up to 8; speed of the last one, and its correction [m/s]; z of the pelvis's axes up and
ahead; its height over the lower foot [m], its whole rate [rad/s]; and how far the sensors of the run are off
their reference."""
_CHOSEN, _ERRORS = slice(0, len(CHOICES)), slice(CHANGE_FEATURES.index("spin") + 1, len(CHANGE_FEATURES))
_BODY = slice(_CHOSEN.stop, _ERRORS.start)
# columns of what is chosen, of the body, and of the sensors
_MOST_STEPS = 8.0
_LEAST_SPEED = 0.3  # [m/s] from which a velocity has a direction


class Changing(NamedTuple):
    """A person about to change. state: (STATE_SIZE,) memory of the running controller. plan: (4,) speed asked
    for [m/s], heading wanted [rad], stance side (-1 right, +1 left), coefficient of friction. beside: [m] to
    the left of its path. qpos (46,), qvel (45,): of the simulation."""

    state: NDArray[np.float64]
    plan: NDArray[np.float64]
    beside: float
    qpos: NDArray[np.float64]
    qvel: NDArray[np.float64]


def changing(person: Person, asked: float, grip: float) -> Changing:
    """What is kept of ``person`` now. ``asked``: speed asked for [m/s]; ``grip``: coefficient of friction."""
    feet, state = person.on_feet, person.control
    side = feet.walk[WALK_STANCE] if feet.walks else state[layout.STANCE]
    heading = float(person.command[HEADING_ASKED])
    plan = np.array([asked, heading, math.copysign(1.0, side), grip])
    return Changing(state.copy(), plan, person.lateral_error, person.qpos, person.data.qvel.copy())


def describe_change(body: Changing, choices: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, n) `CHANGE_FEATURES` of a person about to change, for each of ``choices`` (k, 2)."""
    state, (asked, heading, side, grip) = body.state, body.plan
    ahead = np.array([math.cos(heading), math.sin(heading)])
    inwards = side * np.array([ahead[1], -ahead[0]])
    velocity = state[layout.COM_VELOCITY]
    feet = state[layout.FEET].reshape(2, 3)
    foot = feet[1 if side > 0.0 else 0]
    off = 0.0
    if math.hypot(velocity[0], velocity[1]) > _LEAST_SPEED:
        off = math.remainder(math.atan2(velocity[1], velocity[0]) - heading, 2.0 * math.pi)
    w, x, y, z = body.qpos[3:7]
    up, forward = 1.0 - 2.0 * (x * x + y * y), 2.0 * (x * z - w * y)
    rates = body.qvel[3:6]
    com = state[layout.COM]
    row = np.empty(len(CHANGE_FEATURES))
    row[_BODY] = (
        grip, asked, ahead @ velocity[:2], inwards @ velocity[:2], velocity[2], side * off, side * rates[2],
        side * body.beside, ahead @ (com[:2] - foot[:2]), inwards @ (com[:2] - foot[:2]), com[2] - foot[2],
        state[layout.STEP_TIME], min(state[layout.STEPS], _MOST_STEPS), state[layout.STEP_SPEED],
        state[layout.TRIM], up, -forward, body.qpos[2] - feet[:, 2].min(), float(np.linalg.norm(rates)),
    )  # fmt: skip
    row[_ERRORS] = state[layout.SENSOR_VALUES]
    rows = np.tile(row, (len(choices), 1))
    rows[:, _CHOSEN] = choices
    return rows
