"""Turning round: on the spot if the way is clear, else after backing up along the crumbs to where there is
room."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from locomotion.ground.ground import Ground
from locomotion.quadruped import layout as at
from locomotion.quadruped.body import Body
from locomotion.quadruped.body_on_path import wrap
from locomotion.quadruped.footprint import RESOLUTION, check_script, trail_place
from locomotion.quadruped.local_motion import REACH, local_motion
from locomotion.quadruped.script import Place, Script, joined
from locomotion.quadruped.trail import Trail, lay_trail
from locomotion.quadruped.trail_planning import Planner, find_way, first_heading, turn_onto

__all__ = [
    "WayBack", "can_set_out", "has_way", "little_way_back", "step_away", "turn_script", "way_back",
]  # fmt: skip

_LOOK_BACK = 40  # candidate places with room
_PIVOTS = (0.5, 0.0, 1.0, 0.25, 0.75)  # shares of the spine from the rear on
_STEP = 0.1  # [m] between places
_AWAY = (0.5, 1.0, 1.5, 2.0)  # [body lengths] that it steps away from others to turn


class WayBack(NamedTuple):
    """Motion backwards along ``trail``, from arc length ``start`` to ``end`` [m]."""

    trail: Trail
    start: float
    end: float


def turn_script(
    body: Body,
    ground: Ground,
    place: Place,
    yaw: float,
    clear: Callable[[Script], bool] = lambda script: True,
    leads_on: Callable[[Place], bool] = lambda place: True,
) -> Script | None:
    """A turn on the spot to ``yaw`` [rad] that touches nothing, with a margin of the check's resolution, is
    ``clear`` of others, and ends where the way ``leads_on``: around the middle, the rear or the front, the
    short way, the long one, or the first half of a long one that takes more than half a turn. None if
    there is none.
    """

    def free(script: Script) -> bool:
        return clear(script) and check_script(script, body, ground, RESOLUTION).free

    def whole(script: Script) -> bool:
        return free(script) and leads_on(script.end())

    short = float(wrap(yaw - place.yaw))
    long = short - math.copysign(2.0 * math.pi, short)
    for turn in (short, long):
        if abs(turn) <= math.pi:
            for script in filter(whole, _turns(body, place, turn)):
                return script
    if abs(long) > math.pi:
        for script in filter(free, _turns(body, place, 0.5 * long)):
            if any(map(whole, _turns(body, script.end(), 0.5 * long))):
                return script
    return None


def step_away(
    body: Body, ground: Ground, place: Place, clear: Callable[[Script], bool], turns: Callable[[Place], bool]
) -> Script | None:
    """The fewest steps straight ahead or back to where it ``turns``, touching nothing and ``clear`` of
    others; None if there are none."""
    for far in _AWAY:
        for way in (far, -far):
            count = math.ceil(far * body.length / REACH)
            scripts, here = [], place
            for _ in range(count):
                scripts.append(local_motion(body).script(here, (way * body.length / count, 0.0, 0.0)))
                here = scripts[-1].end()
            script = joined(scripts)
            if clear(script) and check_script(script, body, ground, RESOLUTION).free and turns(here):
                return script
    return None


def _turns(body: Body, place: Place, turn: float) -> Iterator[Script]:
    """Turns by ``turn`` [rad], at most half a turn, around one pivot after the other."""
    for pivot in _PIVOTS:
        ahead = pivot * body.spine.length
        wanted = ahead * (1.0 - math.cos(turn)), -ahead * math.sin(turn), turn
        if max(abs(wanted[0]), abs(wanted[1])) <= REACH:  # a long body does not turn around its front
            yield local_motion(body).script(place, wanted)


def little_way_back(
    body: Body, ground: Ground, place: Place, crumbs: NDArray[np.float64], far: float
) -> WayBack | None:
    """The way back along ``crumbs`` (k, 3) [m], oldest first, from ``place`` by ``far`` [m], or as far as
    they reach; None if that is hardly anything."""
    trail, here = _trail_behind(body, ground, place, crumbs)
    if here < max(body.spine.length, _STEP):
        return None
    return WayBack(trail, here, max(here - far, 0.0))


def _trail_behind(
    body: Body, ground: Ground, place: Place, crumbs: NDArray[np.float64]
) -> tuple[Trail, float]:
    """The trail through ``crumbs`` to where it stands, and where on it its rear feet are."""
    points = np.vstack([crumbs, [place.x, place.y, place.z], [*place.front(body), place.z]])
    trail = lay_trail(points, body, ground)
    return trail, trail.length - body.spine.length


def way_back(
    planner: Planner,
    body: Body,
    ground: Ground,
    goals: Sequence[tuple[float, float, float]],
    place: Place,
    crumbs: NDArray[np.float64],
) -> WayBack | None:
    """The way back along ``crumbs`` (k, 3) [m], oldest first, from ``place`` to the nearest place with room
    for a turn towards ``goals``; None if there is none."""
    if len(crumbs) < 2:
        return None
    trail, here = _trail_behind(body, ground, place, crumbs)
    arcs = np.arange(here - _STEP, 0.0, -_STEP)
    if len(arcs) == 0:
        return None
    heights = np.interp(arcs, trail.step * np.arange(len(trail.rows)), trail.rows[:, at.PZ])
    middles = np.array([trail.point(arc + 0.5 * body.spine.length) for arc in arcs])
    roomy = arcs[planner.room_to_turn(np.column_stack([middles, heights]), body.length)]
    for arc in roomy[:_LOOK_BACK]:
        there = Place(*trail_place(trail, body, float(arc)).tolist())
        if can_set_out(planner, body, ground, goals, there):
            return WayBack(trail, here, float(arc))
    return None


def has_way(planner: Planner, goals: Sequence[tuple[float, float, float]], there: Place) -> bool:
    """Whether a way leads from ``there`` to the first of ``goals``, so that `find_way` finds one."""
    return planner.leads(np.array([there.x, there.y, there.z]), np.array(goals[0]))


def can_set_out(
    planner: Planner, body: Body, ground: Ground, goals: Sequence[tuple[float, float, float]], there: Place
) -> bool:
    """Whether it could start for ``goals`` from ``there``, at once or after a turn on the spot."""
    try:
        trail, _ = find_way(planner, body, ground, goals, there)
    except ValueError:
        return False
    if abs(turn_onto(trail, body, there)) < body.spine_reach:
        return True

    def leads_on(place: Place) -> bool:
        return has_way(planner, goals, place)

    return turn_script(body, ground, there, first_heading(trail, body), leads_on=leads_on) is not None
