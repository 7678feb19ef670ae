"""What a policy is rewarded for, as named terms."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.policy.law import along, pace_share
from locomotion.gaits.policy.layout import (
    ACTION,
    BODY_WEIGHT,
    FAST,
    HEADING,
    JOINTS,
    LAG_AHEAD,
    LAG_LEFT,
    POLICY_DT,
)

__all__ = ["LIKENESS", "TERMS", "WEIGHTS", "Moment", "rewards", "sway_off", "total"]

WEIGHTS: dict[str, float] = {
    "pose": 0.35,
    "rates": 0.1,
    "feet": 0.15,
    "root": 0.2,
    "speed": 0.25,
    "nears": 0.0,
    "catches": 0.0,
    "load": 0.25,
    "rise": 0.2,
    "change": -0.08,
    "effort": -0.01,
    "pace": -0.05,
    "impact": -0.2,
    "blow": 0.0,
    "slip": -0.8,
    "brush": 0.0,
}
TERMS = tuple(WEIGHTS)
"""Names of the terms. Up to 1 for being like the reference: ``pose`` (joint angles), ``rates``, ``feet``
(heels and tips from the root), ``root`` (attitude, height, spin), ``speed``, ``nears`` and ``catches`` (the
same, but also felt far off, and from anywhere), ``load`` (what each foot bears), ``rise`` (speed up and
down). At a cost: ``change`` and ``effort`` of decisions, ``pace`` other than the usual, ``impact`` of a foot
above 1.5 body weights, or 2.3 in a run, ``blow`` of both together above 1.4, ``slip``: speed of the lowest
point of a foot, toes included, that touches the ground [m/s]; ``brush``: one foot passes the other so near
that it goes through the other leg."""
_FIRM, _FIRM_RUN, _BLOW = 1.5, 2.3, 1.4  # [body weights]
_FAR_OFF, _FARTHEST = 0.15, 0.1  # shares of the error of the speed that count
_PASSES, _ASIDE = 0.2, 0.085  # [m] ahead of the other foot, and to its side, within which a foot brushes
_TOUCHES = 12.0  # per body weight: a tenth of it counts nearly as the whole
_WEIGHTED = {
    "knee_flexion": 2.0,
    "hip_abduction": 6.0,
    "toe_extension": 0.1,
    "hip_flexion": 1.0,
    "ankle_flexion": 1.5,
}
LIKENESS = np.array(
    [
        next(
            (w for part, w in _WEIGHTED.items() if name.endswith(part)),
            0.5 if "hip" in name or "ankle" in name else 0.6,
        )
        for name in JOINTS
    ]
)
"""How much each joint counts. Without the high value of hip abduction, pushes make the stance wide."""


@dataclass(frozen=True)
class Moment:
    """How n people are after a decision, and how the reference is; all float64.

    Attributes:
      angles, rates: (n, 24) off the reference's.
      feet: (n, 4, 3) heels and tips from the root, off the reference's [m].
      up: (n, 2) tilt off the reference's. yaw: (n,). spin: (n, 3). height: (n,) [m] off the reference's.
      velocity: (n, 3) ahead, left and up, off the reference's [m/s].
      forces: (n, k, 4) [N] under foot and toes, right and left, at each physics step.
      soles, soles_before: (n, 6, 3) `layout.SOLE_POINTS` [m], now and a decision ago.
      loads: (n, 2) of the reference, right and left [body weights].
      memory: (n, STATE_SIZE) now; decided_before: (n, ACTIONS) the decision before.
    """

    angles: NDArray[np.float64]
    rates: NDArray[np.float64]
    feet: NDArray[np.float64]
    up: NDArray[np.float64]
    yaw: NDArray[np.float64]
    spin: NDArray[np.float64]
    height: NDArray[np.float64]
    velocity: NDArray[np.float64]
    forces: NDArray[np.float64]
    soles: NDArray[np.float64]
    soles_before: NDArray[np.float64]
    loads: NDArray[np.float64]
    memory: NDArray[np.float64]
    decided_before: NDArray[np.float64]


def sway_off(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far a pose is off the reference, (n,); nobody above 1.5 recovers."""
    return (np.minimum(LIKENESS, 1.0) * angles**2).sum(axis=1)


def rewards(m: Moment) -> dict[str, NDArray[np.float64]]:
    """All terms, (n,) each."""
    action = m.memory[:, ACTION]
    off = 4.0 * (m.velocity[:, :2] ** 2).sum(1)
    off += 25.0 * (m.memory[:, LAG_AHEAD] ** 2 + 0.5 * m.memory[:, LAG_LEFT] ** 2)
    feet = m.feet * np.array([1.0, 4.0, 1.0])
    root = 10.0 * (m.up**2).sum(1) + 8.0 * m.yaw**2 + 120.0 * m.height**2 + 0.1 * (m.spin**2).sum(1)
    per_foot = m.forces.reshape(*m.forces.shape[:2], 2, 2).sum(3) / BODY_WEIGHT
    firm = np.where(m.memory[:, FAST] > 0.0, _FIRM_RUN, _FIRM)
    over = np.clip(per_foot.max(1) - firm[:, None], 0.0, 2.0)
    blow = np.clip(per_foot.sum(2).max(1) - _BLOW, 0.0, 2.0)
    bears = per_foot.mean(1)
    gone = np.linalg.norm(m.soles[:, :, :2] - m.soles_before[:, :, :2], axis=2) / POLICY_DT
    lowest = m.soles[:, :, 2].reshape(-1, 2, 3).argmin(axis=2)
    lowest_moved = np.take_along_axis(gone.reshape(-1, 2, 3), lowest[:, :, None], axis=2)[:, :, 0]
    apart = along(m.memory[:, HEADING], np.diff(m.soles.reshape(-1, 2, 3, 3)[:, :, :2].mean(axis=2), axis=1))
    near = np.clip(1.0 - apart[:, 0, 1] / _ASIDE, 0.0, 1.0) * (np.abs(apart[:, 0, 0]) < _PASSES)
    return {
        "pose": np.exp(-2.0 * (LIKENESS * m.angles**2).sum(1)),
        "rates": np.exp(-0.02 * (LIKENESS * m.rates**2).sum(1)),
        "feet": np.exp(-12.0 * (feet**2).sum((1, 2))),
        "root": np.exp(-root),
        "speed": np.exp(-off),
        "nears": np.exp(-_FAR_OFF * off),
        "catches": 1.0 / (1.0 + _FARTHEST * off),
        "load": np.exp(-2.0 * ((bears - m.loads) ** 2).sum(1)),
        "rise": np.exp(-10.0 * m.velocity[:, 2] ** 2),
        "change": ((action - m.decided_before) ** 2).mean(1),
        "effort": (action**2).mean(1),
        "pace": (pace_share(m.memory) - 1.0) ** 2,
        "impact": (over**2).sum(1),
        "blow": blow**2,
        "slip": (np.clip(lowest_moved, 0.0, 1.0) * np.tanh(_TOUCHES * bears)).sum(1),
        "brush": near,
    }


def total(terms: Mapping[str, NDArray[np.float64]], weights: Mapping[str, float]) -> NDArray[np.float64]:
    """The reward (n,): the weighted sum of the ``terms``; ``weights`` replace those of `WEIGHTS`."""
    return sum((({**WEIGHTS, **weights})[name] * terms[name] for name in TERMS), np.zeros(len(terms["pose"])))
