"""What the walking controller is tuned by and what it remembers: names, first values, places in arrays."""

import math

import numpy as np

from surefoot.kernels import kernel

__all__ = [
    "ATTITUDES", "BODY_HEIGHT", "CAUGHT", "CLOCK", "DOUBLE", "FAST", "FAST_SPEED", "FOOTHOLD",
    "FOOTHOLD_NORMAL", "FOOTHOLD_YAW", "GAINS", "HUMP", "LEVEL", "LIFT", "LIFT_NORMAL", "LIFT_YAW", "LONGER",
    "MISSED", "PHASE", "REST", "SEEN", "SEEN_ANCHORS", "SEEN_AXES", "SEEN_FEET", "SEEN_PELVIS", "SEEN_SOLES",
    "SEEN_TORQUES", "SETTING_OFF", "SIDEWAYS", "SINGLE", "STAIRS", "STAIRS_AHEAD", "STANDING", "STEEP",
    "STEEPNESS", "STEPPED_AT", "STEPPED_FROM", "STEP_MADE", "STRAINS",
    "SUDDEN", "SWING_ANGLES",
    "SWING_TIME", "TILTED", "TOLD", "UNEVEN",
    "USUAL_SPEED", "WALKS", "WALK_HEADING", "WALK_SIZE", "WALK_SPEED", "WALK_STANCE", "WALK_STEPS",
    "WALK_TICKS", "WALK_TRIM", "WALK_TURN_RATE", "clamp", "fast_share", "first_gains", "gain_limits",
    "new_walk", "pace_of", "steep_share", "step_share", "wrap",
]  # fmt: skip

_STILL_FAST = 0.1  # [m/s] by which steps are faster than asked for, at most, in a steady walk
_LOW_STEP, _STEP = 0.03, 0.07  # of a step of 2, and of 6 cm
_LEVEL_SLOPE, _STEEP_SLOPE = 0.1, 0.3
# slopes up to which a person goes as on level ground; from which as on steep

GAINS: dict[str, tuple[float, float, float]] = {
    "swing_time": (0.36, 0.26, 0.6),  # [s] of single support, unless a step has to be made sooner
    "transfer_time": (0.06, 0.04, 0.25),  # [s] in which the load goes over to the new stance foot
    "width": (0.16, 0.08, 0.3),  # [m] between the lines of the feet
    "height": (0.94, 0.82, 0.96),  # [m] of the centre of mass above the soles
    "pressure_gain": (1.6, 0.0, 4.0),  # shift of the centre of pressure per error of the capture point
    "pressure_along": (0.09, 0.01, 0.12),  # [m] by which the centre of pressure may move along the foot
    "pressure_across": (0.024, 0.005, 0.04),  # [m] the same across the foot
    "height_stiffness": (150.0, 30.0, 300.0),  # [1/s^2] of the vertical force
    "height_damping": (26.0, 5.0, 50.0),  # [1/s]
    "tilt_stiffness": (220.0, 100.0, 1500.0),  # [Nm/rad] that keeps the pelvis upright
    "tilt_damping": (85.0, 10.0, 150.0),  # [Nm s/rad]
    "tilt_moment": (85.0, 20.0, 150.0),  # [Nm] of both at most
    "yaw_stiffness": (240.0, 20.0, 500.0),  # [Nm/rad]
    "yaw_damping": (12.0, 2.0, 40.0),  # [Nm s/rad]
    "clearance": (0.13, 0.05, 0.2),  # [m] of the swing foot above the straight line to its foothold
    "lean": (0.15, -0.1, 0.25),  # forward lean of the pelvis
    "leg_damping": (0.84, 0.3, 1.0),  # share of the servos' damping that is cancelled in a stance leg
    "arm_swing": (0.65, 0.0, 1.0),  # of a shoulder per flexion of the other leg's hip
    "pressure_rest": (0.01, -0.04, 0.06),  # [m] ahead of the sole's middle where the pressure rests
    "reaction": (0.75, 0.0, 1.5),  # share of the swing hip's torques that the stance leg takes up
    "moment": (155.0, 40.0, 180.0),  # [Nm] of the ground's force about the centre of mass at most
    "drop": (-0.02, -0.1, 0.2),  # [m] above the lower foot that the body's base may be
    "swing_lead": (0.08, 0.0, 0.12),  # [s] by which the swing leg's targets lead
    "narrowest": (0.065, -0.15, 0.12),  # [m] between the lines of the feet at least; below 0 they cross
    "roughness": (23.0, 0.0, 80.0),  # cost of a foothold per [m] of unevenness under the sole
    "steepness": (4.5, 0.0, 10.0),  # cost of a foothold that is not level
    "foot_pitch": (0.18, 0.0, 0.6),  # slope [rise over run] up to which a foot turns uphill
    "foot_roll": (0.43, 0.1, 0.5),  # slope up to which it turns sideways
    "ankle_spare": (0.05, -0.1, 0.4),  # [rad] that an ankle bends less than it could when a foot is put down
    "foot_turn": (0.65, 0.0, 0.7),  # [rad] by which a foot turns off its way to stand less steep sideways
    "lean_slope": (0.3, -0.2, 0.8),  # lean per unit of slope uphill
    "foot_hold": (
        0.2,
        0.0,
        2.0,
    ),  # share of its servos' stiffness that keeps a foot on its edge as put
    "height_slope": (0.1, -0.1, 0.4),  # [m] that the body is lower per unit of slope downhill
    "height_uphill": (0.14, -0.1, 0.4),  # [m] the same uphill
    "longest": (0.66, 0.35, 0.8),  # [m] above which a step is made sooner instead
    "trim_rate": (
        0.12,
        0.0,
        0.3,
    ),  # correction of the speed asked for per step's error in speed
    "most_trim": (0.34, 0.0, 0.8),  # [m/s] by which it is corrected at most
    "climb_rate": (0.75, 0.3, 2.0),  # [m/s] up and down at which the body is asked to go at most
    "lateness": (0.0, 0.0, 0.12),  # [s] by which a foot lands later than its swing was to take
    "swing_foreseen": (0.7, 0.0, 1.0),  # share of its targets that reckon with delay and inertia
    "most_missed": (0.12, 0.05, 0.3),  # [m] by which footholds are moved back at most because feet miss them
    "momentum": (1.1, 0.0, 1.5),  # share of what the legs' swinging adds to the speed that is not counted
    "tilt_integral": (190.0, 0.0, 1500.0),  # [Nm/(rad s)] of the moment that keeps the pelvis upright
}
"""Gains by name, in the order of the kernel's array: first guess, least and greatest value."""


LEVEL, STEEP, REST, STAIRS, FAST = range(5)
"""The rows of gains: for level ground, for steep ground, for coming to rest there, for stairs and for fast
walks."""


def first_gains() -> np.ndarray:
    """First guess, (len(GAINS),) float64."""
    return np.array([first for first, _, _ in GAINS.values()])


def gain_limits() -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest values, (len(GAINS),) float64 each."""
    table = np.array(list(GAINS.values()))
    return table[:, 1].copy(), table[:, 2].copy()


# --- what the controller remembers -------------------------------------------------------------------------
PHASE, CLOCK, WALK_STANCE, WALK_HEADING, WALK_TURN_RATE, WALK_SPEED, SIDEWAYS, SETTING_OFF = range(8)
"""`STANDING`, `SINGLE` or `DOUBLE` support; time in it [s]; stance side (-1 right, +1 left); reference
heading [rad], turn rate [rad/s], speed and sideways speed to the left [m/s]; 1 while the weight is shifted
for the first step."""
STANDING, SINGLE, DOUBLE = 0.0, 1.0, 2.0
SWING_TIME, MISSED, WALK_STEPS, WALK_TICKS, FOOTHOLD_YAW, LIFT_YAW = range(8, 14)
"""Planned time of this step's single support [s]; distance [m] by which feet land ahead of their footholds
(the mean near a stand, summed in a walk); steps and ticks made; yaw [rad] of the swing foot at its foothold
and where it left the ground."""
FOOTHOLD, FOOTHOLD_NORMAL, LIFT, LIFT_NORMAL = slice(14, 17), slice(17, 20), slice(20, 23), slice(23, 26)
"""Where the swing foot's sole is to land and the foot's normal there; where it left the ground."""
SWING_ANGLES = slice(26, 32)
"""Angles [rad] of the swing leg asked for at the last tick."""
SEEN_SOLES, SEEN_FEET, SEEN_PELVIS = slice(32, 38), slice(38, 56), slice(56, 65)
"""After the last physics step: middles of the right and the left sole [m]; rotations (2, 9) of the feet and
(9,) of the pelvis."""
SEEN_ANCHORS, SEEN_AXES, SEEN_TORQUES = slice(65, 101), slice(101, 137), slice(137, 149)
"""The same for the six joints of the right and of the left leg: anchors [m] and axes, (2, 6, 3) in the world;
torques, (2, 6) [Nm]."""
SEEN = slice(SEEN_SOLES.start, SEEN_TORQUES.stop)
"""All of these."""
USUAL_SPEED = 1.25
"""[m/s] of a walk up to which it goes by the gains for level ground."""
FAST_SPEED = 1.45
"""[m/s] from which it goes by those for fast walks."""
WALKS = 149
"""1 while this controller moves the body, 0 while it runs."""
HUMP = 150
"""How far [m] the ground rises above the straight line from where the swing foot left it to its foothold."""
WALK_TRIM, STEPPED_AT, STEPPED_FROM = 151, 152, slice(153, 155)
"""Speed [m/s] asked for on top of the reference so that the steps are as fast as it; tick of the last
touchdown, and centre of mass [m] at it."""
STEEPNESS = 155
"""Slope [rise over run] of the ground stepped on, of late."""
BODY_HEIGHT = 156
"""Height [m] at which the centre of mass is to be now; NaN before the first tick."""
ATTITUDES = slice(157, 163)
"""Normals (2, 3) of the right and the left foot as they were last put down."""
CAUGHT = 163
"""1 if the walk began out of a run, 0 if from a stand."""
STAIRS_AHEAD = 164
"""Slope [rise over run] of steps just before it, 0: there are none."""
UNEVEN = 165
"""How much it walks as on steep ground or stairs, 0 to 1."""
LONGER = slice(166, 168)
"""Times [s] by which this step's transfer and swing take longer than learned."""
TILTED = 168
"""Integral [rad s] of how far the pelvis leans forward beyond what it is to."""
STEP_MADE = 169
"""Speed [m/s] of the last step of a fast walk along its way; 0 in other walks."""
TOLD = 170
"""Heading [rad] asked for at the last tick."""
SUDDEN = 171
"""How much [rad] of a turn that was asked for at once, not bit by bit as in a bend, is still to come."""
STRAINS = slice(172, 174)
"""How strained the walk was at the last touchdown, and at the one before (`locomotion.gaits.walk.strain`)."""
WALK_SIZE = 174


def new_walk(heading: float = 0.0) -> np.ndarray:
    """A person standing on both feet, (WALK_SIZE,) float64; the left leg will be the first stance leg."""
    walk = np.zeros(WALK_SIZE)
    walk[WALKS], walk[WALK_STANCE], walk[WALK_HEADING], walk[TOLD] = 1.0, 1.0, heading, heading
    walk[BODY_HEIGHT] = np.nan
    walk[ATTITUDES] = 0.0, 0.0, 1.0, 0.0, 0.0, 1.0
    return walk


@kernel
def clamp(x, low, high):
    """``x`` within ``low`` to ``high``."""
    return min(max(x, low), high)


@kernel
def wrap(angle):
    """``angle`` [rad] within -π to π."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


@kernel
def steep_share(steepness):
    """How much a slope [rise over run] counts as steep, 0 (gone as level ground) to 1."""
    return clamp((steepness - _LEVEL_SLOPE) / (_STEEP_SLOPE - _LEVEL_SLOPE), 0.0, 1.0)


@kernel
def step_share(ahead):
    """How much a step in the ground counts as stairs, 0 to 1. ``ahead``: its height per metre looked ahead,
    as of `STAIRS_AHEAD`."""
    return clamp((ahead - _LOW_STEP) / (_STEP - _LOW_STEP), 0.0, 1.0)


@kernel
def pace_of(walk):
    """Speed [m/s] at which a person walks: that of its reference, or of its steps where it has to slow down
    from a fast walk and has not yet."""
    made = walk[STEP_MADE] - _STILL_FAST
    return made if made > max(walk[WALK_SPEED], USUAL_SPEED) else walk[WALK_SPEED]


@kernel
def fast_share(speed):
    """How much a walk of ``speed`` [m/s] is a fast one, 0 to 1."""
    return clamp((speed - USUAL_SPEED) / (FAST_SPEED - USUAL_SPEED), 0.0, 1.0)
