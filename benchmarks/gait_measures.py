"""Figures of a walk from its record, as gait laboratories measure them."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from benchmarks.gait_record import Record
from locomotion.body.person import JOINT_NAMES, MASS

__all__ = ["JOINTS", "SAMPLES", "compare_curves", "deepest_limb", "figures", "mean_cycles", "strikes"]

JOINTS = {
    "knee": "knee_flexion", "ankle": "ankle_flexion", "shoulder": "shoulder_flexion", "elbow":
    "elbow_flexion",
}  # fmt: skip
"""Joints whose curves are compared, besides the thigh's angle from the vertical."""
SAMPLES = 100
"""Equal shares of a cycle."""
_LEGS = ("thigh", "knee")
_TOUCH = 20.0  # [N] under a foot that counts as contact
_APART = 0.15  # [s] without contact before a strike
_FLIES = 0.05  # body weights under both feet, below which it flies
_WEIGHT = MASS * 9.81


def strikes(record: Record, side: int) -> NDArray[np.int64]:
    """Steps at which a foot strikes the ground."""
    on = record.forces[:, side] > _TOUCH
    apart = round(_APART / record.step)
    found, last = [], 0 if on[0] else -apart
    for k in np.flatnonzero(on):
        if k - last > apart:
            found.append(k)
        last = k
    return np.array(found, dtype=np.int64)


def mean_cycles(record: Record, side: int) -> dict[str, NDArray[np.float64]]:
    """Mean over the cycles of a side, (100,) [deg]: thigh, knee, ankle, shoulder, elbow."""
    name = ("right", "left")[side]
    values = {k: record.angles[:, JOINT_NAMES.index(f"{name}_{j}")] for k, j in JOINTS.items()}
    values["thigh"] = record.thighs[:, side]
    at, shares, found = strikes(record, side), np.arange(SAMPLES) / SAMPLES, {}
    for key, column in values.items():
        cycles = [np.interp(a + shares * (b - a), np.arange(len(column)), column) for a, b in pairwise(at)]
        found[key] = np.degrees(np.mean(cycles, axis=0))
    return found


def compare_curves(
    record: Record, people: dict[str, NDArray[np.float64]], shifted: bool = False
) -> dict[str, tuple[float, float]]:
    """Root mean square difference [deg] and correlation with curves of ``people``, each (100,) [deg] from a
    strike on; mean of both sides. ``shifted``: they begin anywhere, so that they are shifted in time until
    thighs and knees fit best."""
    sides = [mean_cycles(record, side) for side in (0, 1)]
    if shifted:
        best = min(range(SAMPLES), key=lambda k: sum(
            np.square(each[name] - np.roll(people[name], k)).sum() for each in sides for name in _LEGS
        ))  # fmt: skip
        people = {name: np.roll(curve, best) for name, curve in people.items()}
    found = {}
    for name, curve in people.items():
        off = [np.sqrt(np.mean((each[name] - curve) ** 2)) for each in sides]
        alike = [np.corrcoef(each[name], curve)[0, 1] for each in sides]
        found[name] = float(np.mean(off)), float(np.mean(alike))
    return found


def deepest_limb(record: Record) -> tuple[str, float]:
    """What was deepest in what, such as "left hand in left thigh", and how deep [m]."""
    return max(record.limbs.items(), key=lambda each: each[1], default=("nothing", 0.0))


def _aside(record: Record, a: int, b: int, side: int) -> float:
    """How far [m] a foot stands on its own side of the line along which the body goes in the stride between
    the steps ``a`` and ``b``: the middle of its sole in the middle of its stance."""
    body = record.com[a:b, :2]
    way = record.com[b, :2] - record.com[a, :2]
    left = np.array([-way[1], way[0]]) / np.linalg.norm(way)
    bears = a + np.flatnonzero(record.forces[a:b, side] > _TOUCH)
    foot = record.soles[bears[len(bears) // 2], 3 * side : 3 * side + 2, :2].mean(axis=0)
    return float(left @ (foot - body.mean(axis=0))) * (1.0 if side else -1.0)


def figures(record: Record) -> dict[str, float]:
    """Those of `human_walk.TARGETS` and `human_run.TARGETS`."""
    seconds = len(record.com) * record.step
    way = record.com[-1, :2] - record.com[0, :2]
    marks = [strikes(record, side) for side in (0, 1)]
    events = sorted((int(k), side) for side in (0, 1) for k in marks[side])
    knees = [np.degrees(record.angles[:, JOINT_NAMES.index(f"{s}_knee_flexion")]) for s in ("right", "left")]
    strides = [(a, b, side) for side in (0, 1) for a, b in pairwise(marks[side])]

    def over(values: NDArray[np.float64], a: int, b: int, low: float, high: float) -> NDArray[np.float64]:
        return values[a + int(low * (b - a)) : a + int(high * (b - a)) + 1]

    aside = {(side, a): _aside(record, a, b, side) for a, b, side in strides}
    widths = [
        aside[s, k] + aside[t, m] for (k, s), (m, t) in pairwise(events)
        if s != t and (s, k) in aside and (t, m) in aside
    ]  # fmt: skip
    heel_first = [
        record.soles[a, 3 * s, 2] < record.soles[a, 3 * s + 1 : 3 * s + 3, 2].min() - 0.005
        for a, _, s in strides
    ]
    on = record.forces > _TOUCH
    reaction = record.forces.sum(axis=1) / _WEIGHT
    peaks = [float(reaction[a:b].max()) for (a, _), (b, _) in pairwise(events)]
    sides = [mean_cycles(record, side) for side in (0, 1)]
    ranges = {k: float(np.mean([np.ptp(each[k]) for each in sides])) for k in ("shoulder", "elbow")}
    times = [
        np.mean([m - k for (k, s), (m, t) in pairwise(events) if s == side and t != side]) for side in (0, 1)
    ]
    return {
        "speed": float(np.linalg.norm(way)) / seconds,
        "cadence": len(events) / seconds,
        "step width": 1000.0 * float(np.mean(widths)),
        "crossing": 1000.0 * max(0.0, -min(aside.values())),
        "rise": 1000.0 * float(np.mean([np.ptp(record.com[a:b, 2]) for a, b, _ in strides])),
        "double support": 100.0 * float(on.all(axis=1).mean()),
        "knee at midstance": float(np.mean([over(knees[s], a, b, 0.3, 0.45).mean() for a, b, s in strides])),
        "knee when loaded": float(np.mean([over(knees[s], a, b, 0.0, 0.25).max() for a, b, s in strides])),
        "knee in swing": float(np.mean([knees[s][a:b].max() for a, b, s in strides])),
        "heel first": 100.0 * float(np.mean(heel_first)),
        "slide": 1000.0 * float(np.mean([record.slid[a:b, s].sum() for a, b, s in strides])),
        "penetration": 1000.0 * float(record.depth.max()),
        "limb in limb": 1000.0 * deepest_limb(record)[1],
        "flight": 100.0 * float((reaction < _FLIES).mean()),
        "peak reaction": float(np.mean(peaks)),
        "hardest step": max(peaks),
        "shoulder range": ranges["shoulder"],
        "elbow range": ranges["elbow"],
        "left against right": 100.0 * float(abs(times[0] - times[1]) / np.mean(times)),
    }
