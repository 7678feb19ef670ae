"""What a person may do walking and running: limits along a path, and when it goes over from one to the
other."""

import math

import numpy as np

from locomotion.body.observed import VELOCITY_X, VELOCITY_Z
from locomotion.gaits.run.skill import RunSkill
from locomotion.gaits.walk.layout import CLOCK, DOUBLE, PHASE, USUAL_SPEED, WALK_HEADING, WALK_STEPS
from locomotion.gaits.walk.skill import WalkSkill
from locomotion.paths.table import TrackingLimits

__all__ = ["PERSON_RULES", "RUN_ENTRY", "SHORT_ENTRY", "run_entry_speed", "run_limits", "walk_limits"]

PERSON_RULES = {"radius": 0.3, "headroom": 1.9, "max_slope": math.radians(20.0), "max_step": 0.2}
"""Where a person can run: radius [m], headroom [m], steepest slope [rad], highest step under a foot [m]."""
RUN_ENTRY, SHORT_ENTRY = 1.1, 0.65
"""[m/s] of walking from which a person begins to run; and where it has little room before an obstacle."""
_SHARE_OF_TURNING = 0.8  # the rest of the skill's sideways acceleration is left for corrections
_SLOWEST_RUN = 2.5  # [m/s]: slower it crosses its legs
_SHARPEST, _STEEPEST = 0.2, 0.12  # [1/m], slope: where it would rather walk
_SLOWEST, _SIDEWAYS = 0.3, 0.5  # [m/s], [m/s^2] of a walk
_TIGHT = 0.75, 1.5  # [m/s], [rad/s] of a walk in bends in which that is faster
_OVER_STEPS = 0.85  # [m/s] of a walk where the ground steps up or down: faster it trips
_FASTER, _SLOWER = 0.7, 0.5  # [m/s^2] of a walk
_UPHILL, _DOWNHILL = 1.6, 2.2  # [m/s per unit of slope] of a walk
_FORESIGHT = 0.8  # [m] of a walk: it takes about two steps to go slower
_FIRST_STEPS = 3  # made walking before it runs
_AHEAD = 0.2  # [rad] off its way at most when it begins to run


def run_limits(skill: RunSkill) -> TrackingLimits:
    """What a running person can follow."""
    sideways = _SHARE_OF_TURNING * skill.max_lateral
    speeds = max(skill.speeds[0], _SLOWEST_RUN), skill.speeds[1]
    return TrackingLimits(speeds, sideways=sideways, sharpest=_SHARPEST, steepest=_STEEPEST)


def walk_limits(skill: WalkSkill) -> TrackingLimits:
    """What a walking person can follow."""
    speeds = _SLOWEST, skill.speed
    return TrackingLimits(
        speeds,
        _SIDEWAYS,
        _FASTER,
        _SLOWER,
        _UPHILL,
        _DOWNHILL,
        foresight=_FORESIGHT,
        usual=USUAL_SPEED,
        tight=_TIGHT,
        steps=_OVER_STEPS,
    )


def run_entry_speed(
    walk: np.ndarray, observed: np.ndarray, heading: float, least: float = RUN_ENTRY
) -> float | None:
    """Speed [m/s] with which a walking person can begin to run towards ``heading`` [rad] now, just after it
    has put a foot down; None when it cannot. ``observed``: as in `locomotion.body.observed`. ``least``:
    [m/s] at which it can."""
    if walk[PHASE] != DOUBLE or walk[CLOCK] > 0.0 or walk[WALK_STEPS] < _FIRST_STEPS:
        return None
    now = walk[WALK_HEADING]
    vx, vy = observed[VELOCITY_X:VELOCITY_Z]
    speed = float(vx * math.cos(now) + vy * math.sin(now))
    straight = abs(math.remainder(heading - now, 2.0 * math.pi)) < _AHEAD
    return speed if straight and speed >= least else None
