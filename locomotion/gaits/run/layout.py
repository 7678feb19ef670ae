"""What the running controller senses, does, learns and remembers: names, places in arrays, first values."""

import numpy as np

from locomotion.body import observed as seen

__all__ = [
    "ACTIONS",
    "BLEND",
    "CLIMB",
    "COM",
    "COM_AT_SWITCH",
    "COM_VELOCITY",
    "COM_X",
    "COM_Y",
    "COM_Z",
    "CONTACT",
    "FALLEN",
    "FEET",
    "FIRST_SENSOR",
    "HEADING",
    "LAST_TARGET",
    "LEFT_CONTACT",
    "LEFT_FOOT",
    "LEFT_PLANTED",
    "MIN_PHASE",
    "N_KNOTS",
    "OBSERVED",
    "PARAMETERS",
    "PHASE",
    "PLANTED",
    "RANK",
    "RIGHT_CONTACT",
    "RIGHT_FOOT",
    "RIGHT_PLANTED",
    "SENSORS",
    "SENSOR_VALUES",
    "SLOPE",
    "SPEED",
    "STANCE",
    "STATE_SIZE",
    "STEPS",
    "STEP_LENGTH",
    "STEP_SPEED",
    "STEP_TIME",
    "SWITCH_X",
    "SWITCH_Y",
    "TICKS",
    "TRIM",
    "TURN_RATE",
    "VELOCITY_X",
    "VELOCITY_Y",
    "VELOCITY_Z",
    "new_state",
    "parameter_slices",
]

SENSORS = (
    "pitch",
    "pitch_rate",
    "height",
    "vx",
    "vz",
    "dx",
    "roll",
    "yaw",
    "roll_rate",
    "yaw_rate",
    "vy",
    "dy",
)
"""Pelvis pitch and its rate; centre of mass above, velocity and place ahead of the stance foot; then the
lateral ones."""
ACTIONS = (
    "swing_hip_flexion",
    "swing_hip_abduction",
    "swing_hip_rotation",
    "stance_hip_flexion",
    "stance_hip_abduction",
    "stance_hip_rotation",
    "waist_pitch",
    "waist_roll",
    "waist_yaw",
)
CLIMB = (*ACTIONS, "swing_knee_flexion", "stance_knee_flexion", "stance_ankle_flexion")
"""What the slope under the feet and the sharpness of a bend change."""
RANK = 3
N_KNOTS = 8
MIN_PHASE = 0.6
"""Share of a step before which a touch of the swing foot does not end it."""

PARAMETERS: dict[str, int] = {
    "m_ap": 9 * RANK,  # (9, 3) action projection [rad per latent unit]
    "m_sp": RANK * 12,  # (3, 12) sensor projection
    "posture": 9,  # swing aim (pitch, roll, yaw); stance servo (pitch, rate, roll, rate, yaw, rate)
    "a_hat": 9,  # affine term [rad]
    "feed_forward": 3 * N_KNOTS,  # hip flexion, knee, ankle over the cycle [rad], periodic
    "turn": 9,  # rad per rad/s of turning towards the stance side
    "climb": 12,  # rad per unit of slope, uphill
    "timing": 2,  # step time [s]; amplitude of the legs' reference about its mean
    "arms": 1,  # amplitude of the arms' reference about its mean
    "descend": 12,  # rad per unit of slope, downhill
    "climb_legs": 3 * N_KNOTS,  # change of feed_forward per unit of slope, uphill
    "descend_legs": 3 * N_KNOTS,  # the same downhill
    "climb_timing": 2,  # change of timing per unit of slope, uphill
    "descend_timing": 2,  # the same downhill
    "bend": 12,  # rad per (m/s^2)^2 of sideways acceleration, whichever side is the inner one
}
"""Blocks of a parameter vector, in order, with their lengths."""


def parameter_slices() -> dict[str, slice]:
    """Where each block of `PARAMETERS` lies in a parameter vector."""
    result, start = {}, 0
    for name, size in PARAMETERS.items():
        result[name] = slice(start, start + size)
        start += size
    return result


# --- what the controller remembers -------------------------------------------------------------------------
PHASE, STANCE, HEADING, SPEED, TURN_RATE, TRIM, STEPS, STEP_TIME, SLOPE, TICKS = range(10)
"""Phase of the step [0, 1]; stance side (-1 right, +1 left); reference heading [rad], speed [m/s], turn
rate [rad/s]; speed correction [m/s]; steps made; time since the switch [s]; estimated slope along the
heading; ticks made."""
FALLEN, STEP_LENGTH, STEP_SPEED = 10, 11, 12
"""1 after a fall; length [m] and mean speed [m/s] of the last step. (13 is free.)"""
_OBSERVED = 14
OBSERVED = slice(_OBSERVED, _OBSERVED + seen.OBSERVED_SIZE)
"""What was observed of the body (`locomotion.body.observed`). The names of its numbers are those there:"""


def _here(part: slice) -> slice:
    return slice(_OBSERVED + part.start, _OBSERVED + part.stop)


COM, COM_VELOCITY, FEET, CONTACT = map(_here, (seen.COM, seen.COM_VELOCITY, seen.FEET, seen.CONTACT))
COM_X, COM_Y, COM_Z = _OBSERVED + seen.COM_X, _OBSERVED + seen.COM_Y, _OBSERVED + seen.COM_Z
VELOCITY_X, VELOCITY_Y = _OBSERVED + seen.VELOCITY_X, _OBSERVED + seen.VELOCITY_Y
VELOCITY_Z = _OBSERVED + seen.VELOCITY_Z
RIGHT_FOOT, LEFT_FOOT = _OBSERVED + seen.RIGHT_FOOT, _OBSERVED + seen.LEFT_FOOT
RIGHT_CONTACT, LEFT_CONTACT = _OBSERVED + seen.RIGHT_CONTACT, _OBSERVED + seen.LEFT_CONTACT
PLANTED, COM_AT_SWITCH = slice(28, 34), slice(34, 37)
RIGHT_PLANTED, LEFT_PLANTED, SWITCH_X, SWITCH_Y = 28, 31, 34, 35
"""Touchdown places of the right and the left foot [m]; centre of mass at the last switch [m]."""
SENSOR_VALUES = slice(37, 49)
"""Deviations of the `SENSORS` from their reference at the last tick, clipped."""
FIRST_SENSOR = 37
BLEND, LAST_TARGET = slice(49, 49 + 39), slice(88, 88 + 39)
"""What is left of the jump of the targets at the last switch; PD targets of the last tick [rad]."""
STATE_SIZE = 127


def new_state() -> np.ndarray:
    """A controller state, (STATE_SIZE,) float64: right stance, at the start of a step, heading 0, speed 0."""
    state = np.zeros(STATE_SIZE)
    state[STANCE] = -1.0
    return state
