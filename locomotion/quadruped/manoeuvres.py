"""Manoeuvres: series of short moves that bring a body onto its path where one turn on the spot has no room.

A* over places and directions combines steps forwards, back and sideways, turns around rear, middle and front,
and arcs, quickest first. Each is checked by its footprint as it would play. The result is one script.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from locomotion.ground.ground import Ground
from locomotion.quadruped import layout as at
from locomotion.quadruped.body import Body
from locomotion.quadruped.footfalls import find_ground
from locomotion.quadruped.footprint import RESOLUTION, check_script, key_balls, script_places, touches
from locomotion.quadruped.local_motion import REACH, local_motion
from locomotion.quadruped.script import Place, Script, joined
from locomotion.quadruped.trail import Trail, kernel_ground
from surefoot.kernels import kernel

__all__ = ["find_manoeuvre", "prepare_moves"]

_CELLS = 8  # places in a body's length
_HEADINGS = 16  # in a full turn
_PIVOTS = (0.0, 0.5, 1.0)  # shares of the spine from the rear on
_MOST_PLACES = 1500  # that are looked at
_MOST_ASKED = 40  # of them, whether the way leads on from there
_PAUSE = 0.3  # [s] that one move less is worth
_AHEAD = 2.5  # [body lengths] of the path within which it is joined
_ALIGNED = 0.8  # share of the spine's reach within which the path's direction is met


class _Moves(NamedTuple):
    """The moves of one body: ``wanted`` (m, 3) as `LocalMotion.look_up` takes them, the ``seconds`` (m,)
    that they take, and of all of them, one after the other from ``first`` (m + 1,) on, ``samples`` (k, 6): x,
    y [m] of root, front and head from where the root was, in its direction."""

    wanted: NDArray[np.float64]
    seconds: NDArray[np.float64]
    first: NDArray[np.int64]
    samples: NDArray[np.float64]


@lru_cache(maxsize=16)
def _moves_for(body_json: str) -> _Moves:
    body = Body.model_validate_json(body_json)
    cell, angle = body.length / _CELLS, 2.0 * math.pi / _HEADINGS
    wanted = [(cell * k, 0.0, 0.0) for k in (1, 2, -1, -2)] + [(0.0, cell, 0.0), (0.0, -cell, 0.0)]
    for turn in (angle, -angle, 2.0 * angle, -2.0 * angle):
        for pivot in _PIVOTS:
            ahead = pivot * body.spine.length
            wanted.append((ahead * (1.0 - math.cos(turn)), -ahead * math.sin(turn), turn))
    for turn in (angle, -angle):
        for way in (2.0 * cell, -2.0 * cell):
            wanted.append((way * math.cos(0.5 * turn), way * math.sin(0.5 * turn), turn))
    moves = np.clip(wanted, -REACH, REACH)
    stand = Place(0.0, 0.0, 0.0, 0.0)
    scripts = [local_motion(body).script(stand, each) for each in moves]
    samples = []
    for script in scripts:
        balls = key_balls(script_places(script, body), body).centres
        samples.append(balls[:, [2, 1, 0], :2].reshape(-1, 6))
    first = np.concatenate([[0], np.cumsum([len(each) for each in samples])])
    seconds = np.array([script.seconds for script in scripts])
    return _Moves(moves, seconds, first, np.concatenate(samples))


def prepare_moves(body: Body) -> None:
    """Make what turns and manoeuvres of ``body`` look up. It takes a second for each kind, once in a process,
    which its first turn would have to wait for."""
    _moves_for(body.model_dump_json())


class _Reached(NamedTuple):
    """A place that was reached: by ``move`` from the one of index ``parent``, after ``seconds``."""

    x: float
    y: float
    yaw: float
    z: float
    seconds: float
    parent: int
    move: int


def find_manoeuvre(
    body: Body, ground: Ground, place: Place, trail: Trail, leads_on: Callable[[Place], bool]
) -> Script | None:
    """The script that brings a body from ``place`` to where it can start along ``trail``, touching nothing,
    and from where the way ``leads_on``; None if none is found among `_MOST_PLACES` places. Takes up to
    about a second.
    """
    moves, goals = _moves_for(body.model_dump_json()), _goals(body, trail)
    cell, angle = body.length / _CELLS, 2.0 * math.pi / _HEADINGS
    turning = math.radians(body.local_motions.turn.speed_deg)

    def key(at_: _Reached) -> tuple[int, int, int]:
        turn = round((at_.yaw - place.yaw) / angle) % _HEADINGS
        return round((at_.x - place.x) / cell), round((at_.y - place.y) / cell), turn

    def left(x: float, y: float, yaw: float) -> float:
        """[s] needed from there at least; 0 if it is there."""
        off = np.maximum(np.hypot(goals[:, 0] - x, goals[:, 1] - y) - cell, 0.0)
        turn = np.maximum(np.abs(_wrapped(goals[:, 2] - yaw)) - _ALIGNED * body.spine_reach, 0.0)
        return float((off / body.local_motions.step.speed + turn / turning).min())

    check = _Checked(body, ground, moves)
    found = [_Reached(place.x, place.y, place.yaw, place.z, 0.0, -1, -1)]
    queue = [(left(place.x, place.y, place.yaw), 0)]
    closed: set[tuple[int, int, int]] = set()
    asked = 0
    while queue and len(closed) < _MOST_PLACES and asked < _MOST_ASKED:
        _, index = heapq.heappop(queue)
        here = found[index]
        if key(here) in closed:
            continue
        closed.add(key(here))
        if index and left(here.x, here.y, here.yaw) == 0.0:
            asked += 1
            script = _script_of(body, place, moves, found, index)
            if check_script(script, body, ground, 0.5 * RESOLUTION).free and leads_on(script.end()):
                return script
        c, s = math.cos(here.yaw), math.sin(here.yaw)
        for move in np.flatnonzero(check(here)).tolist():
            ahead, beside, turn = moves.wanted[move].tolist()
            x, y = here.x + c * ahead - s * beside, here.y + s * ahead + c * beside
            spent = here.seconds + float(moves.seconds[move]) + _PAUSE
            there = _Reached(x, y, here.yaw + turn, float(check.height[move]), spent, index, move)
            if key(there) not in closed:
                heapq.heappush(queue, (spent + left(x, y, there.yaw), len(found)))
                found.append(there)
    return None


def _wrapped(angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same angles [rad] between -π and π."""
    return angles - 2.0 * math.pi * np.floor((angles + math.pi) / (2.0 * math.pi))


def _goals(body: Body, trail: Trail) -> NDArray[np.float64]:
    """(k, 3) roots on the path's beginning and the direction from there to where the front would be."""
    arcs = np.arange(0.0, min(_AHEAD * body.length, trail.length) + 1e-9, body.length / _CELLS)
    points = np.array([trail.point(arc) for arc in arcs])
    on = np.array([trail.point(arc + body.spine.length) for arc in arcs]) - points
    return np.column_stack([points, np.arctan2(on[:, 1], on[:, 0])])


def _script_of(body: Body, place: Place, moves: _Moves, found: list[_Reached], index: int) -> Script:
    """The moves that lead to the place of ``index``, as one script from ``place``."""
    chosen: list[_Reached] = []
    while found[index].parent >= 0:
        chosen.append(found[index])
        index = found[index].parent
    scripts, here = [], place
    for each in reversed(chosen):
        script = local_motion(body).script(here, moves.wanted[each.move])
        script.rows[:, at.SZ] = np.linspace(here.z, each.z, len(script.rows))
        scripts.append(script)
        here = script.end()
    return joined(scripts)


class _Checked:
    """Which moves are free from a place; ``height`` (m,) [m] is the ground at the end of each."""

    def __init__(self, body: Body, ground: Ground, moves: _Moves) -> None:
        rise, drop = math.radians(body.neck.rise_deg), math.radians(body.head.drop_deg)
        up = body.neck.length * math.sin(rise) - 0.5 * body.head.length * math.sin(drop)
        heights = body.rear_legs.height, body.front_legs.height, body.front_legs.height + up
        radii = min(body.trunk.loin, body.radius), min(body.trunk.chest, body.radius), body.head.radius
        step = body.movement.step
        reach = step + body.spine.length * math.tan(math.radians(body.movement.slope_deg))
        self._ground, self._moves = ground, moves
        self._heights, self._radii = np.array(heights), np.array(radii) + RESOLUTION
        self._reach = np.array([step, reach])
        self.height = np.zeros(len(moves.wanted))

    def __call__(self, here: _Reached) -> NDArray[np.bool_]:
        free, ground = np.zeros(len(self._moves.wanted), np.bool_), self._ground
        _free_moves(
            kernel_ground(ground), ground.arrays.cell_range, ground.origin, here.x, here.y, here.z, here.yaw,
            self._moves.first, self._moves.samples, self._heights, self._radii, self._reach, free,
            self.height,
        )  # fmt: skip
        return free


@kernel
def _free_moves(ground, cell_range, origin, x, y, z, yaw, first, samples, heights, radii, reach, free, ends):
    """Write which moves touch nothing on their way, and the ground's height [m] at their ends."""
    c, s = math.cos(yaw), math.sin(yaw)
    for move in range(len(free)):
        root_z, front_z = z, z
        ok = True
        for k in range(first[move], first[move + 1]):
            for part in range(3):
                ax, ay = samples[k, 2 * part], samples[k, 2 * part + 1]
                px, py = x + c * ax - s * ay, y + s * ax + c * ay
                if part == 0:
                    root_z = find_ground(ground, origin, px, py, root_z, reach[0])
                    below = root_z
                elif part == 1:
                    front_z = find_ground(ground, origin, px, py, root_z, reach[1])
                    below = front_z
                else:
                    below = front_z
                bx, by, bz = px - origin[0], py - origin[1], below + heights[part] - origin[2]
                if math.isnan(below) or touches(ground, cell_range, bx, by, bz, radii[part]):
                    ok = False
                    break
            if not ok:
                break
        free[move], ends[move] = ok, root_z
