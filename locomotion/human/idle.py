"""What a person who stands as learned does: it breathes, looks about and sways.

Only joints above the pelvis move, so the feet stay and nothing has to be simulated. All of it is a function
of how long it has been at rest and of one number of its own, so nothing has to be remembered.
"""

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import JOINT_NAMES

__all__ = ["idle_pose"]

_STILL, _SETTLING = 1.0, 2.0  # [s] after which it begins, and in which it comes into its own
_BREATH, _LOOK, _SWAY = 4.0, 4.5, 7.0  # [s] that a breath, a look and a sway take on average
_LOOKING = 0.16  # share of a look in which the head turns
_STEPS = (0.7548776662466927, 0.5698402909980532)
"""Steps of two sequences that fill 0 to 1 evenly and never repeat (Roberts, "The unreasonable effectiveness
of quasirandom sequences", 2018)."""
_TURN, _DIP = 0.75, 0.12  # [rad] of the head at most
_BREATHING = {"chest_pitch": -0.012, "right_clavicle_elevation": 0.03, "left_clavicle_elevation": 0.03}
_LOOKING_ABOUT = {"neck_yaw": 0.75, "chest_yaw": 0.12, "waist_yaw": 0.13}  # shares of the turn
_SWAYING = {
    "waist_roll": 0.015, "chest_roll": 0.012, "neck_roll": -0.027, "right_shoulder_flexion": 0.03,
    "left_shoulder_flexion": -0.025, "right_elbow_flexion": 0.03, "left_elbow_flexion": 0.02,
}  # fmt: skip
# [rad] at most


def _row(shares: dict[str, float]) -> NDArray[np.float64]:
    row = np.zeros(len(JOINT_NAMES))
    for name, share in shares.items():
        row[JOINT_NAMES.index(name)] = share
    return row


_BREATHS, _TURNS, _DIPS, _SWAYS = map(_row, (_BREATHING, _LOOKING_ABOUT, {"neck_pitch": 1.0}, _SWAYING))


def idle_pose(angles: NDArray[np.float64], seconds: float, habit: float) -> NDArray[np.float64]:
    """The joint ``angles`` (39,) [rad] of a person who has been at rest for so many ``seconds``, as it
    breathes and looks about. ``habit``: 0 to 1, what makes it an individual."""
    share = _eased((seconds - _STILL) / _SETTLING)
    if share == 0.0:
        return angles
    own, other = (habit * 13.0) % 1.0, (habit * 29.0) % 1.0
    tempo = 0.85 + 0.3 * own
    breath = math.sin(2.0 * math.pi * (seconds * tempo / _BREATH + other))
    sway = 0.6 * math.sin(2.0 * math.pi * (seconds * tempo / _SWAY + own)) + 0.4 * math.sin(
        2.0 * math.pi * (0.37 * seconds * tempo / _SWAY + other)
    )
    now = seconds * tempo / _LOOK + 7.0 * other
    now += 0.3 * math.sin(2.5 * now)  # now longer, now shorter
    n = math.floor(now)
    u = _eased((now - n) / _LOOKING)
    turn, dip = (
        _nth(n - 1, start, step) + u * (_nth(n, start, step) - _nth(n - 1, start, step))
        for start, step in zip((own, other), _STEPS, strict=True)
    )
    offsets = breath * _BREATHS + _TURN * turn * _TURNS + _DIP * dip * _DIPS + sway * _SWAYS
    return angles + share * offsets


def _eased(share: float) -> float:
    u = min(max(share, 0.0), 1.0)
    return u * u * (3.0 - 2.0 * u)


def _nth(n: int, start: float, step: float) -> float:
    """The ``n``-th place, -1 to 1; most are near 0."""
    place = 2.0 * ((start + n * step) % 1.0) - 1.0
    return place * abs(place)
