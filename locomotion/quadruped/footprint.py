"""Footprint check: would head, shoulders or root touch the level during a motion?

Before a motion plays, the places of head, shoulders and root along it, each a ball, are tested against the
level's triangles. Between two samples no ball moves by more than `RESOLUTION`, so in a motion that passes,
balls may touch the level by less than half of that.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from locomotion.ground.collider.layout import (
    CORNER,
    HIGH_X,
    HIGH_Y,
    HIGH_Z,
    LOW_X,
    LOW_Y,
    LOW_Z,
    PER_METRE,
    SOUTH,
    WEST,
)
from locomotion.ground.ground import Ground
from locomotion.quadruped import layout as at
from locomotion.quadruped.body import Body
from locomotion.quadruped.body_on_path import front_of, on_trail
from locomotion.quadruped.motion import stop_place, stop_time
from locomotion.quadruped.script import Place, Script
from locomotion.quadruped.trail import Trail, kernel_ground
from surefoot.kernels import kernel

__all__ = [
    "PARTS",
    "RESOLUTION",
    "Footprint",
    "at_place",
    "check_places",
    "check_script",
    "check_trail",
    "fronts",
    "key_balls",
    "script_places",
    "stopping_distance",
    "touches",
    "trail_arcs",
    "trail_place",
    "trail_places",
]

PARTS = ("head", "shoulders", "root")
"""The parts tested, in order."""
RESOLUTION = 0.02
"""[m] greatest distance that a ball moves between two samples."""
_ASSUMED_SPEED = 2.5  # motion of a ball relative to the root's, when samples are chosen


class Footprint(NamedTuple):
    """``free``: whether nothing is touched. Else ``part`` of `PARTS` is the first to touch, or "ground" has
    none to stand on, at ``place`` (3,) [m], in sample ``index``."""

    free: bool
    part: str = ""
    index: int = -1
    place: tuple[float, float, float] = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class _Balls:
    """centres (k, 3 parts, 3) float64 [m], radii (3,) [m], of `PARTS`."""

    centres: NDArray[np.float64]
    radii: NDArray[np.float64]


def script_places(script: Script, body: Body) -> NDArray[np.float64]:
    """(k, 5) x, y, z, yaw, bend along a script, dense enough for `RESOLUTION`."""
    rows = script.rows[:, [at.SX, at.SY, at.SZ, at.SYAW, at.SBEND]]
    return _densified(rows, body)


def trail_places(trail: Trail, body: Body, start: float, end: float) -> NDArray[np.float64]:
    """(k, 5) x, y, z, yaw, bend of a body whose root goes from arc length ``start`` to ``end`` [m]."""
    return np.array([trail_place(trail, body, arc) for arc in trail_arcs(start, end).tolist()])


def trail_arcs(start: float, end: float) -> NDArray[np.float64]:
    """(k,) [m] arc lengths of `trail_places`."""
    return np.linspace(start, end, max(int(abs(end - start) * _ASSUMED_SPEED / RESOLUTION), 1) + 1)


def trail_place(trail: Trail, body: Body, arc: float) -> NDArray[np.float64]:
    """(5,) x, y, z, yaw, bend of a body whose root is at an arc length [m]."""
    spine = body.spine
    place = on_trail(
        trail.rows, 0, len(trail.rows), trail.step, arc, arc + spine.length, float(spine.bones),
        spine.bone_length, spine.flex, math.radians(spine.max_bend_deg),
    )  # fmt: skip
    return np.array(place[:5])


def _densified(rows: NDArray[np.float64], body: Body) -> NDArray[np.float64]:
    """The rows with more in between, so that no ball moves farther than `RESOLUTION` from one to the next."""
    balls = key_balls(rows, body)
    jumps = np.linalg.norm(np.diff(balls.centres[:, :, :2], axis=0), axis=2).max(axis=1)
    parts = np.maximum(np.ceil(jumps / RESOLUTION).astype(int), 1)
    whole = np.concatenate([[0], np.cumsum(parts)])
    dense = np.arange(whole[-1] + 1)
    return np.stack([np.interp(dense, whole, rows[:, k]) for k in range(5)], axis=1)


def fronts(places: NDArray[np.float64], body: Body) -> NDArray[np.float64]:
    """(k, 2) [m] the front feet's midpoint at ``places`` (k, 5)."""
    out = np.empty((len(places), 2))
    _write_fronts(np.ascontiguousarray(places), float(body.spine.bones), body.spine.bone_length, out)
    return out


def key_balls(places: NDArray[np.float64], body: Body, front_z: NDArray[np.float64] | None = None) -> _Balls:
    """The balls of `PARTS` at ``places`` (k, 5): x, y, z, yaw, bend; z is the ground's under the root [m],
    ``front_z`` (k,) that under the front feet, by default the same."""
    return _balls_at(places, body, fronts(places, body), places[:, 2] if front_z is None else front_z)


def _balls_at(
    places: NDArray[np.float64], body: Body, front: NDArray[np.float64], own_z: NDArray[np.float64]
) -> _Balls:
    """`key_balls` whose front feet are at ``front`` (k, 2), on ground at ``own_z`` (k,) [m]."""
    x, y, z, yaw, bend = places.T
    chest = yaw + body.spine.bones * bend
    rise, drop = math.radians(body.neck.rise_deg), math.radians(body.head.drop_deg)
    ahead = body.neck.length * math.cos(rise) + 0.5 * body.head.length * math.cos(drop)
    up = body.neck.length * math.sin(rise) - 0.5 * body.head.length * math.sin(drop)
    height = body.front_legs.height
    head = np.stack(
        [front[:, 0] + ahead * np.cos(chest), front[:, 1] + ahead * np.sin(chest), own_z + height + up],
        axis=1,
    )
    shoulders = np.column_stack([front, own_z + height])
    root = np.stack([x, y, z + body.rear_legs.height], axis=1)
    radii = np.array(
        [body.head.radius, min(body.trunk.chest, body.radius), min(body.trunk.loin, body.radius)]
    )
    return _Balls(np.stack([head, shoulders, root], axis=1), radii)


def check_places(places: NDArray[np.float64], body: Body, ground: Ground, margin: float = 0.0) -> Footprint:
    """Whether the body fits at all ``places`` (k, 5): x, y, z, yaw, bend, with ``margin`` [m] to spare."""
    reach = body.movement.step + body.spine.length * math.tan(math.radians(body.movement.slope_deg))
    root_z = _ground_at(ground, places[:, :2], places[:, 2], 0.5 * reach + body.movement.step)
    front = fronts(places, body)
    front_z = _ground_at(ground, front, places[:, 2], reach)
    lost = np.flatnonzero(~(np.isfinite(root_z) & np.isfinite(front_z)))
    until = int(lost[0]) if len(lost) else len(places)
    if until > 0:
        standing = np.column_stack([places[:until, :2], root_z[:until], places[:until, 3:]])
        balls = _balls_at(standing, body, front[:until], front_z[:until])
        index, part = _first_touch(
            kernel_ground(ground),
            ground.arrays.cell_range,
            balls.centres - ground.origin,
            balls.radii + margin,
        )
        if index >= 0:
            x, y, z = balls.centres[index, part]
            return Footprint(False, PARTS[part], int(index), (float(x), float(y), float(z)))
    if until < len(places):
        x, y, z = places[until, :3]
        return Footprint(False, "ground", until, (float(x), float(y), float(z)))
    return Footprint(True)


def _ground_at(
    ground: Ground, points: NDArray[np.float64], z: NDArray[np.float64], reach: float
) -> NDArray[np.float64]:
    """(k,) [m] height of the ground at ``points`` (k, 2) within ``reach`` of ``z`` (k,), or NaN."""
    found = ground.surface_below(np.column_stack([points, z + reach]))[0]
    return np.where(found >= z - reach, found, np.nan)


def check_script(script: Script, body: Body, ground: Ground, margin: float = 0.0) -> Footprint:
    """Whether a script can be played, with ``margin`` [m] to spare."""
    return check_places(script_places(script, body), body, ground, margin)


def check_trail(trail: Trail, body: Body, ground: Ground, start: float, end: float) -> Footprint:
    """Whether the body fits on a trail while its root goes from arc length ``start`` to ``end`` [m]."""
    return check_places(trail_places(trail, body, start, end), body, ground)


def stopping_distance(body: Body, speed: float) -> float:
    """[m] in which it stops from ``speed`` [m/s]: where the stop motion ends."""
    time = stop_time(speed, body.movement.braking)
    return float(stop_place(speed, 0.0, 0.5 * speed * time, time, time)[0])


def at_place(place: Place) -> NDArray[np.float64]:
    """(1, 5) for `check_places`."""
    return np.array([[place.x, place.y, place.z, place.yaw, place.bend]])


@kernel
def _write_fronts(places, bones, bone, out):
    for k in range(places.shape[0]):
        out[k] = front_of(places[k, 0], places[k, 1], places[k, 3], places[k, 4], bones, bone)


@kernel
def _distance_squared(px, py, pz, t):
    """Squared distance [m²] from a point to the triangle of corners ``t`` (9,) (Ericson, Real-Time Collision
    Detection, 5.1.5)."""
    abx, aby, abz = t[3] - t[0], t[4] - t[1], t[5] - t[2]
    acx, acy, acz = t[6] - t[0], t[7] - t[1], t[8] - t[2]
    apx, apy, apz = px - t[0], py - t[1], pz - t[2]
    d1 = abx * apx + aby * apy + abz * apz
    d2 = acx * apx + acy * apy + acz * apz
    if d1 <= 0.0 and d2 <= 0.0:
        return apx * apx + apy * apy + apz * apz
    bpx, bpy, bpz = px - t[3], py - t[4], pz - t[5]
    d3 = abx * bpx + aby * bpy + abz * bpz
    d4 = acx * bpx + acy * bpy + acz * bpz
    if d3 >= 0.0 and d4 <= d3:
        return bpx * bpx + bpy * bpy + bpz * bpz
    cpx, cpy, cpz = px - t[6], py - t[7], pz - t[8]
    d5 = abx * cpx + aby * cpy + abz * cpz
    d6 = acx * cpx + acy * cpy + acz * cpz
    if d6 >= 0.0 and d5 <= d6:
        return cpx * cpx + cpy * cpy + cpz * cpz
    vc = d1 * d4 - d3 * d2
    vb = d5 * d2 - d1 * d6
    va = d3 * d6 - d5 * d4
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        v, w = d1 / (d1 - d3), 0.0
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        v, w = 0.0, d2 / (d2 - d6)
    elif va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        v = 1.0 - w
    else:
        v, w = vb / (va + vb + vc), vc / (va + vb + vc)
    x, y, z = apx - v * abx - w * acx, apy - v * aby - w * acy, apz - v * abz - w * acz
    return x * x + y * y + z * z


@kernel
def touches(ground, cell_range, x, y, z, radius):
    """Whether a triangle comes nearer to a point than ``radius``."""
    rows, start, member, grid, shape = ground
    x0, x1 = (
        int((x - radius - grid[WEST]) * grid[PER_METRE]),
        int((x + radius - grid[WEST]) * grid[PER_METRE]),
    )
    y0, y1 = (
        int((y - radius - grid[SOUTH]) * grid[PER_METRE]),
        int((y + radius - grid[SOUTH]) * grid[PER_METRE]),
    )
    for ix in range(max(x0, 0), min(x1, shape[0] - 1) + 1):
        for iy in range(max(y0, 0), min(y1, shape[1] - 1) + 1):
            c = ix * shape[1] + iy
            if cell_range[c, 0] > z + radius or cell_range[c, 1] < z - radius:
                continue
            for k in range(start[c], start[c + 1]):
                row = rows[member[k]]
                if (
                    row[LOW_X] > x + radius or row[HIGH_X] < x - radius or row[LOW_Y] > y + radius
                    or row[HIGH_Y] < y - radius or row[LOW_Z] > z + radius or row[HIGH_Z] < z - radius
                ):  # fmt: skip
                    continue
                if _distance_squared(x, y, z, row[CORNER : CORNER + 9]) < radius * radius:
                    return True
    return False


@kernel
def _first_touch(ground, cell_range, centres, radii):
    """(sample, part) of the first touch, (-1, -1) for none."""
    for k in range(centres.shape[0]):
        for part in range(centres.shape[1]):
            x, y, z = centres[k, part]
            if touches(ground, cell_range, x, y, z, radii[part]):
                return k, part
    return -1, -1
