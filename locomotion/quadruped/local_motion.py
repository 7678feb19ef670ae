"""Local motion: short moves without path finding, from a table of the blends that lead to each place.

The body's own motions (forwards and back, sideways, around) are played together, each with a weight. Since
the turn carries the other two around while they play, where a blend leads is found by playing it. The table
is built once for a body: for every wanted place and facing on a grid the weights that lead there, found by
Newton's method on played blends. Lookups interpolate.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import RegularGridInterpolator

from locomotion.errors import LocomotionError
from locomotion.quadruped.body import Body
from locomotion.quadruped.body_on_path import wrap
from locomotion.quadruped.script import ROWS, Place, Script, make_script, smooth_shares

__all__ = ["REACH", "LocalMotion", "local_motion", "play_blends", "short_move"]

REACH = 1.25
"""[m] ahead, behind and to the sides that the table covers; every facing."""
_SHORT_MOVE = 0.8  # [m] up to which local motion replaces a path; within `REACH`
_PLACES, _FACINGS = 11, 37
_BEND = 0.5  # share of its greatest bend with which the spine leads into a quarter turn
_PEAK = 1.875  # top speed of a smooth share relative to its mean


def play_blends(body: Body, weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Play blends of ``weights`` (k, 3): metres ahead and to the left, radians around, each as if alone.
    Returns (ROWS, k, 3): x, y [m], yaw [rad] over time, from a root at the origin that faces x."""
    moves = body.local_motions
    step, side, turn = (
        smooth_shares(each.begin, each.end)[:, None] for each in (moves.step, moves.sidestep, moves.turn)
    )
    yaw = turn * weights[:, 2]
    ahead, left = np.diff(step * weights[:, 0], axis=0), np.diff(side * weights[:, 1], axis=0)
    middle = 0.5 * (yaw[1:] + yaw[:-1])
    steps = np.stack(
        [ahead * np.cos(middle) - left * np.sin(middle), ahead * np.sin(middle) + left * np.cos(middle)],
        axis=2,
    )
    places = np.concatenate([np.zeros((1, len(weights), 2)), np.cumsum(steps, axis=0)])
    return np.concatenate([places, yaw[:, :, None]], axis=2)


def _solve(body: Body, wanted: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weights (k, 3) whose blends end at ``wanted`` (k, 3), by Newton's method with measured derivatives."""
    weights = wanted.copy()
    for _ in range(6):
        miss = play_blends(body, weights)[-1] - wanted
        slopes = np.empty((len(wanted), 3, 3))
        for k in range(3):
            nudged = weights.copy()
            nudged[:, k] += 1e-5
            slopes[:, :, k] = (play_blends(body, nudged)[-1] - wanted - miss) / 1e-5
        weights -= np.linalg.solve(slopes, miss[:, :, None])[:, :, 0]
    return weights


class LocalMotion:
    """The table of one body; made by `local_motion`. ``places`` (p,) [m] and ``facings`` (f,) [rad] are the
    grid, ``weights`` (p, p, f, 3) the blend for each place (ahead, left) and facing."""

    def __init__(self, body: Body) -> None:
        self.body = body
        self.places = np.linspace(-REACH, REACH, _PLACES)
        self.facings = np.linspace(-math.pi, math.pi, _FACINGS)
        grid = np.stack(np.meshgrid(self.places, self.places, self.facings, indexing="ij"), axis=-1)
        self.weights = _solve(body, grid.reshape(-1, 3)).reshape(grid.shape)
        self._table = RegularGridInterpolator((self.places, self.places, self.facings), self.weights)

    def look_up(self, wanted: ArrayLike) -> NDArray[np.float64]:
        """Weights (3,) of the blend to a wanted (ahead [m], left [m], facing [rad]) relative to the root.
        Raises `LocomotionError` outside of `REACH`."""
        target = np.asarray(wanted, dtype=np.float64)
        if target.shape != (3,) or not np.isfinite(target).all():
            raise LocomotionError(f"a local motion needs finite (ahead, left, facing), not {wanted!r}")
        if np.abs(target[:2]).max() > REACH or abs(target[2]) > math.pi:
            raise LocomotionError(
                f"({target[0]:.2f}, {target[1]:.2f}) m, {target[2]:.2f} rad is outside of local motion's "
                f"reach of {REACH:g} m and π"
            )
        return self._table(target)[0]

    def script(self, place: Place, wanted: ArrayLike) -> Script:
        """The motion from ``place`` to ``wanted`` (as in `look_up`), at the body's own pace."""
        weights = self.look_up(wanted)
        x, y, yaw = play_blends(self.body, weights[None])[:, 0].T
        c, s = math.cos(place.yaw), math.sin(place.yaw)
        moves = self.body.local_motions
        limits = (
            (moves.step, moves.step.speed), (moves.sidestep, moves.sidestep.speed),
            (moves.turn, math.radians(moves.turn.speed_deg)),
        )  # fmt: skip
        seconds = max(
            _PEAK * abs(weight) / (speed * (move.end - move.begin))
            for weight, (move, speed) in zip(weights, limits, strict=True)
        )
        bend = _BEND * math.radians(self.body.spine.max_bend_deg) * np.tanh(weights[2] / 1.6)
        lead = np.sin(np.pi * np.linspace(0.0, 1.0, ROWS)) ** 2 * bend + place.bend * (1.0 - smooth_shares())
        return make_script(
            place.x + c * x - s * y, place.y + s * x + c * y, place.z, place.yaw + yaw, lead, seconds
        )


@lru_cache(maxsize=16)
def _table_for(body_json: str) -> LocalMotion:
    return LocalMotion(Body.model_validate_json(body_json))


def local_motion(body: Body) -> LocalMotion:
    """The table of a body, built on first use."""
    return _table_for(body.model_dump_json())


def short_move(
    body: Body, place: Place, goal: tuple[float, float, float], facing: float | None
) -> tuple[Script | None, float]:
    """The motion that brings the front feet to ``goal`` [m] and ends in ``facing`` [rad], by default that of
    ``place``, and the distance of the root [m]; None if the goal is too far or on another floor."""
    facing = place.yaw if facing is None else facing
    x, y, z = goal
    length = body.spine.length
    dx, dy = x - length * math.cos(facing) - place.x, y - length * math.sin(facing) - place.y
    distance = math.hypot(dx, dy)
    if distance > _SHORT_MOVE or abs(z - place.z) > body.movement.step:
        return None, distance
    c, s = math.cos(place.yaw), math.sin(place.yaw)
    turn = float(wrap(facing - place.yaw))
    return local_motion(body).script(place, (c * dx + s * dy, c * dy - s * dx, turn)), distance
