"""Scripts: short motions on the spot, as tables of rows.

A script is a table of the root's place, direction and the spine's bend over time. The same table is checked
against the level (`footprint`) and played (`herd`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from locomotion.quadruped import layout as at
from locomotion.quadruped.body import Body
from locomotion.quadruped.body_on_path import front_of, wrap

__all__ = ["Place", "Script", "into_flex", "joined", "make_script", "out_of_flex", "smooth_shares"]

ROWS = 65
_BEND_SPEED = math.radians(160.0)
"""[rad/s] of the chest when the spine bends on the spot."""
_SHORTEST = 0.4  # [s]
_SAMPLE = 0.02  # [s] between the rows of scripts that are joined


@dataclass(frozen=True)
class Place:
    """Where an animal stands: root ``x``, ``y``, ``z`` [m] on the ground, ``yaw`` [rad] there, ``bend`` [rad]
    between spine bones."""

    x: float
    y: float
    z: float
    yaw: float
    bend: float = 0.0

    def front(self, body: Body) -> tuple[float, float]:
        """[m] midpoint of the front feet."""
        x, y = front_of(self.x, self.y, self.yaw, self.bend, float(body.spine.bones), body.spine.bone_length)
        return float(x), float(y)

    def chest(self, body: Body) -> float:
        """[rad] direction of the chest."""
        return self.yaw + body.spine.bones * self.bend


@dataclass(frozen=True)
class Script:
    """rows (k, ROW) float64 as in `layout`, evenly spaced over ``seconds``; begins and ends at rest."""

    rows: NDArray[np.float64]
    seconds: float

    def end(self) -> Place:
        """Where it leads."""
        row = self.rows[-1]
        return Place(
            float(row[at.SX]), float(row[at.SY]), float(row[at.SZ]), float(row[at.SYAW]), float(row[at.SBEND])
        )


@lru_cache(maxsize=64)
def smooth_shares(begin: float = 0.0, end: float = 1.0) -> NDArray[np.float64]:
    """(ROWS,) from 0 to 1, moving between two shares of the time, with neither speed nor push at its ends.
    Read-only."""
    u = np.clip((np.linspace(0.0, 1.0, ROWS) - begin) / (end - begin), 0.0, 1.0)
    shares = u**3 * (10.0 + u * (6.0 * u - 15.0))
    shares.setflags(write=False)
    return shares


def make_script(
    x: NDArray[np.float64], y: NDArray[np.float64], z: float, yaw: NDArray[np.float64],
    bend: NDArray[np.float64], seconds: float,
) -> Script:  # fmt: skip
    """A script of columns (k,) each, on ground at ``z`` [m]."""
    rows = np.zeros((len(x), at.ROW))
    rows[:, at.SX], rows[:, at.SY], rows[:, at.SZ], rows[:, at.SYAW], rows[:, at.SBEND] = x, y, z, yaw, bend
    return Script(rows, max(seconds, _SHORTEST))


def into_flex(body: Body, place: Place, bend: float) -> Script:
    """Turn the front onto the path while the rear stays: to ``bend`` [rad] between the spine's bones."""
    share = smooth_shares()
    still = np.ones(ROWS)
    turn = abs(bend - place.bend) * body.spine.bones
    bends = place.bend + share * (bend - place.bend)
    seconds = 1.9 * turn / _BEND_SPEED
    return make_script(place.x * still, place.y * still, place.z, place.yaw * still, bends, seconds)


def out_of_flex(body: Body, place: Place, facing: float) -> Script:
    """Swing the rear round until the animal is straight and faces ``facing`` [rad]; the front feet's midpoint
    stays in place, so that the animal keeps looking at its target."""
    share = smooth_shares()
    front_x, front_y = place.front(body)
    bend = place.bend * (1.0 - share)
    turn = wrap(facing - place.yaw)
    yaw = place.yaw + share * turn
    turning = zip(yaw.tolist(), bend.tolist(), strict=True)
    ahead = np.array([Place(0.0, 0.0, 0.0, *each).front(body) for each in turning])
    seconds = 1.9 * max(abs(turn), abs(place.bend) * body.spine.bones) / _BEND_SPEED
    return make_script(front_x - ahead[:, 0], front_y - ahead[:, 1], place.z, yaw, bend, seconds)


def joined(scripts: list[Script]) -> Script:
    """One script that plays ``scripts`` one after the other."""
    parts, seconds = [], 0.0
    for k, script in enumerate(scripts):
        steps = max(round(script.seconds / _SAMPLE), 1)
        where = np.linspace(0.0, len(script.rows) - 1.0, steps + 1)[min(k, 1) :]
        known = np.arange(len(script.rows))
        parts.append(np.stack([np.interp(where, known, column) for column in script.rows.T], axis=1))
        seconds += steps * _SAMPLE
    return Script(np.concatenate(parts), seconds)
