"""What one that stands does: it breathes, shifts its weight, looks about and moves its tail.

Everything is a function of its age and its habits, four numbers that it is given when it is put down. So
nothing has to be drawn while it lives, and no two are in step.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.quadruped import layout as at
from locomotion.quadruped.motion import DT
from surefoot.kernels import kernel

__all__ = ["habits", "live_on", "look_about", "tail_sway", "weight_shift"]

_SETTLING, _WAKING = 0.8, 0.15  # [s] half-lives: into idling, out of it
_LOOKS, _SHIFTS, _WAGS = 18.0, 55.0, 13.0  # mean time of a look, a stance, and a swing of the tail, in units
# of √(hip height / g), the time of a body that falls or swings: small ones are quicker
_SHIFTING = 0.14  # share of a stance that it takes to change to the next
_DRIFT = 0.12  # of a whole shift, to and fro in a stance
_QUICKER = 2.0  # how much faster it breathes when it runs
_GRAVITY = 9.81
_WALKS = (0.7548776662466927, 0.5698402909980532)
"""Steps of two sequences that fill 0 to 1 evenly and never repeat (Roberts, "The unreasonable effectiveness
of quasirandom sequences", 2018)."""


def habits(seed: int, place: NDArray[np.float64], yaw: float) -> NDArray[np.float64]:
    """(4,) 0 to 1: what makes one that is put down at ``place`` (3,) [m], facing ``yaw`` [rad], an
    individual. It depends on nothing else, so that a restored world goes on as it would have."""
    words = np.array([*place, yaw]).view(np.uint32).tolist()
    return np.random.default_rng([seed, *words]).random(4)


@kernel
def live_on(st, pr):
    """One tick of AGE, BREATH and IDLE."""
    st[at.AGE] += DT
    still = st[at.REST] > 0.0
    half_life = _SETTLING if still else _WAKING
    st[at.IDLE] += ((1.0 if still else 0.0) - st[at.IDLE]) * (1.0 - math.exp(-0.69314718056 * DT / half_life))
    st[at.BREATH] += DT * pr[at.BREATHS] * (1.0 + _QUICKER * (1.0 - st[at.IDLE]))
    st[at.BREATH] -= math.floor(st[at.BREATH])


@kernel(forceinline=True)
def _turns(st, pr, units, habit):
    """How many times a thing has been done that takes ``units`` each time; faster and slower by turns."""
    tempo = 0.8 + 0.4 * st[at.HABITS + 3]
    now = (
        st[at.AGE] * tempo / (units * math.sqrt(pr[at.HEIGHT_REAR] / _GRAVITY)) + 7.0 * st[at.HABITS + habit]
    )
    return now + 0.3 * math.sin(2.5 * now)


@kernel(forceinline=True)
def _nth(n, start, walk):
    """The ``n``-th place, -1 to 1."""
    place = start + n * walk
    return 2.0 * (place - math.floor(place)) - 1.0


@kernel
def look_about(st, pr):
    """(turn to the left, dip) [rad] of the head."""
    n = math.floor(_turns(st, pr, _LOOKS, 0))
    turn = _nth(n, st[at.HABITS + 1], _WALKS[0])
    dip = _nth(n, st[at.HABITS + 2], _WALKS[1])
    # most looks are nearly straight ahead
    return st[at.IDLE] * pr[at.LOOK] * turn * abs(turn), 0.35 * st[at.IDLE] * pr[at.LOOK] * dip


@kernel
def weight_shift(st, pr, front):
    """How far the weight is on the left legs of a pair, -1 to 1."""
    now = _turns(st, pr, _SHIFTS * (1.3 if front else 1.0), 1 if front else 2)
    n = math.floor(now)
    u = max(0.0, (now - n - 1.0 + _SHIFTING) / _SHIFTING)
    u = u * u * (3.0 - 2.0 * u)
    start = st[at.HABITS + (2 if front else 0)]
    here, there = _nth(n, start, _WALKS[0]), _nth(n + 1.0, start, _WALKS[0])
    drift = _DRIFT * math.sin(9.0 * now)
    return st[at.IDLE] * ((1.0 - _DRIFT) * (here + u * (there - here)) + drift)


@kernel
def tail_sway(st, pr):
    """[rad] to the left of the tail's root."""
    now = _turns(st, pr, _WAGS, 1)
    bout = 0.5 + 0.5 * _nth(math.floor(now / 9.0), st[at.HABITS + 2], _WALKS[1])
    return st[at.IDLE] * pr[at.WAG] * bout * math.sin(2.0 * math.pi * now)
