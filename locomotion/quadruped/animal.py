"""One animal with goals, and the motions that take it there.

It turns its front onto the path (or the whole body, if the path begins behind it), follows the path, stops
with its front feet at the goal, and swings its rear round until it faces its target. Local motion makes short
moves. Before each of these it checks its footprint and whether others are in its way; it waits with a turn
until they clear it. Without room to turn, it backs up along its crumbs to where the graph knows room, turns,
and goes on.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.avoidance.yielding import COUNT, SPACING, Course, first_meeting
from locomotion.body_events import Arrived, BackedOut, Event, GotStuck, LostGround, MissedGoal, SetOff
from locomotion.errors import LocomotionError
from locomotion.quadruped import layout as at
from locomotion.quadruped.body_on_path import wrap
from locomotion.quadruped.course_for_others import course_back, course_on, shifted_points
from locomotion.quadruped.footprint import RESOLUTION, check_script
from locomotion.quadruped.herd import Herd
from locomotion.quadruped.local_motion import short_move
from locomotion.quadruped.manoeuvres import find_manoeuvre
from locomotion.quadruped.motion import DT, stop_length
from locomotion.quadruped.orders import AnimalMemory, Errand, Phase, Status
from locomotion.quadruped.predicted_discs import disc_radius, foretell_script, nobody
from locomotion.quadruped.script import Place, Script, into_flex, out_of_flex
from locomotion.quadruped.spine import bend_for
from locomotion.quadruped.trail import NoTrail, Trail, lay_trail
from locomotion.quadruped.trail_planning import (
    Planner,
    Way,
    find_way,
    first_heading,
    last_free_arc,
    turn_onto,
)
from locomotion.quadruped.turning import (
    WayBack,
    can_set_out,
    has_way,
    little_way_back,
    step_away,
    turn_script,
    way_back,
)

__all__ = ["SHORT_OF_GOAL", "Animal", "AnimalMemory", "Status"]

SHORT_OF_GOAL = 0.6
"""[body lengths] from the goal within which an animal has arrived: at a goal by a wall it stops early, where
its head has no room."""
_LITTLE = math.radians(3.5)  # a turn onto the path without a motion of its own: 3 cm beside it, for a dog
_EXACT = 1e-3  # [rad] facing error that is not corrected
_MOST_BACKING = 4  # times that it backs up on its way to one goal
_MOST_MANOEUVRES = 6  # manoeuvres on its way to one goal
_STANDING = 0.05  # [m/s]
_ROOM = 1.5  # [body lengths] that it backs up at least to let others pass, more each time
_MOST_ROOM = 2  # times that it does
_AGAIN, _SELDOM = 20, 100  # ticks until it checks again whether others let it turn: at first; later
_OFTEN = 20  # number of the quick checks


class Animal:
    """A quadruped in a herd. Call `tick` after the herd's.

    ``around`` returns predicted places of the discs of all others nearby, every `giving_way.STEP` from now on
    (COUNT, k, 2) [m], and their radii (k,) [m].

    Attributes:
      herd, index: its state. body: its kind. events: in order of time.
      status: "standing", "running" (on its way, in whatever motion), "arrived", "stuck" (no room to turn and
      nowhere
        to back up to) or "lost" (the ground under its path is gone).
      trail: its present or last path, or None. ways: the planner's paths it was made of.
    """

    def __init__(
        self,
        herd: Herd,
        index: int,
        planner: Planner,
        around: Callable[[], tuple[NDArray[np.float64], NDArray[np.float64]]] = nobody,
    ) -> None:
        self.herd, self.index, self.planner, self._around = herd, index, planner, around
        self.body = herd.bodies[index]
        self.status: Status = "standing"
        self.events: list[Event] = []
        self.trail: Trail | None = None
        self.ways: tuple[Way, ...] = ()
        self._phase: Phase = "resting"
        self._errand = Errand()
        self._pending = False
        self._ticks = 0
        self._stood = 0  # ticks that it has stood on its trail, giving way

    # --- where it is
    @property
    def time(self) -> float:
        """[s] since it was created."""
        return self._ticks * DT

    @property
    def position(self) -> NDArray[np.float64]:
        """(3,) [m] the ground between its rear feet."""
        return self.herd.root(self.index)[:3]

    @property
    def front(self) -> NDArray[np.float64]:
        """(3,) [m] the ground between its front feet."""
        z = self.herd.feet[self.index, :2, at.BASE].mean()
        return np.array([*self.herd.front(self.index), z])

    @property
    def yaw(self) -> float:
        """[rad, -π to π] direction of its chest."""
        return float(wrap(self.herd.state[self.index, at.CHEST]))

    @property
    def speed(self) -> float:
        """[m/s] along its trail."""
        return float(self.herd.state[self.index, at.SPEED])

    @property
    def progress(self) -> float:
        """Share of its trail that it has covered, 0 to 1."""
        st = self.herd.state[self.index]
        if self.trail is None or st[at.MODE] != at.ON_TRAIL:
            return 1.0 if self.status == "arrived" else 0.0
        return float(np.clip(st[at.FRONT_ARC] / self.trail.length, 0.0, 1.0))

    @property
    def following(self) -> bool:
        """Whether it follows its trail, or will once it has bent onto it."""
        return self._phase in ("following", "flexing")

    @property
    def goals_left(self) -> int:
        """Number of its goals still ahead."""
        left = len(self._errand.goals)
        if self._phase == "following":
            steps = [np.diff(way.points[:, :2], axis=0) for way in self.ways[:-1]]
            ends = np.cumsum([np.linalg.norm(each, axis=1).sum() for each in steps])
            left -= int((ends <= self.herd.state[self.index, at.FRONT_ARC]).sum())
        return left

    # --- what it is told
    def go_to(
        self, goals: ArrayLike, speed: float = 1.5, facing: float | None = None, gait: str | None = None
    ) -> None:
        """Go through ``goals`` (3,) or (k, 3) [m] at up to ``speed`` [m/s], until the front feet's midpoint
        is at the last; then face ``facing`` [rad], by default as it arrives.

        Raises ValueError (the planner's error, or `NoTrail` if it has no room to turn) if there is no way; it
        then continues as before. Planning takes up to about a second where there is hardly any room.
        """
        points = np.asarray(goals, dtype=np.float64)
        if points.size == 0 or points.size % 3 or points.ndim > 2 or not np.isfinite(points).all():
            raise LocomotionError(f"goals must be finite (3,) or (k, 3), not {goals!r}")
        if not (math.isfinite(speed) and speed > 0.0):
            raise LocomotionError(f"speed must be a finite number above 0 m/s, not {speed}")
        if facing is not None and not math.isfinite(facing):
            raise LocomotionError(f"facing must be a finite angle, not {facing}")
        self.body.gait_index(gait)
        rows = tuple((float(x), float(y), float(z)) for x, y, z in points.reshape(-1, 3))
        errand = Errand(rows, float(speed), facing, gait, self._errand.waited)
        if self._phase == "following":
            self._redirect(errand)
        elif self._phase == "resting":
            former = self._errand, self.trail, self.ways
            try:
                if not self._move_locally(errand):
                    self._set_out(errand)
            except ValueError:
                self._errand, self.trail, self.ways = former
                raise
        else:
            self._way(errand)
            self._errand, self._pending = errand, True
        self.status = "running" if self._phase != "resting" else self.status

    def stop(self) -> None:
        """Stop as soon as it can, and stand."""
        self._errand, self._pending = replace(self._errand, goals=()), False
        self.herd.state[self.index, at.NO_GROUND] = 0.0
        if self._phase == "following":
            self.herd.stop(self.index)
            self._phase = "halting"

    def course(self) -> Course | None:
        """What it is about to do on its trail; None if it follows none, or is stopping."""
        st = self.herd.state[self.index]
        if st[at.STOPPING] > 0.0:
            return None
        if self._phase == "backing":
            return course_back(self.herd.rows(self.index), st, self.body)
        return course_on(self.trail, st, self.body) if self._phase == "following" and self.trail else None

    def foretold(self) -> NDArray[np.float64]:
        """(COUNT, discs, 2) [m] see `Herd.foretold`."""
        return self.herd.foretold(self.index)

    def give_way(self, pace: float, shift: NDArray[np.float64] | None) -> None:
        """Move at a share of its speed; with ``shift`` (k, 2) [m] also shift its trail ahead, as its course
        describes, where there is ground."""
        self.herd.state[self.index, at.PACE] = pace
        if shift is not None and self.trail is not None:
            arc = float(self.herd.state[self.index, at.ARC])
            try:
                trail = lay_trail(shifted_points(self.trail, arc, shift), self.body, self.herd.ground)
            except LocomotionError:  # a step in the ground beside its path
                return
            end = last_free_arc(trail, self.body, self.herd.ground, self.herd.last_arc(self.index, trail))
            self.trail = trail
            self.herd.follow(
                self.index, trail, self._errand.speed, start=arc, end=max(end, arc), gait=self._errand.gait
            )

    def _stands(self) -> bool:
        st = self.herd.state[self.index]
        gives_way = self._phase in ("following", "backing") and st[at.PACE] < 1.0
        return self._phase == "waiting" or (gives_way and st[at.SPEED] < _STANDING)

    @property
    def waited(self) -> float | None:
        """[s] that it has stood giving way; None if it is not on its way."""
        return self._stood * DT if self.status == "running" else None

    @property
    def gives_way(self) -> bool:
        """Whether it slows down or waits with a turn, for others."""
        return self._phase == "waiting" or float(self.herd.state[self.index, at.PACE]) < 1.0

    def way_back(self) -> NDArray[np.float64] | None:
        """(k, 3) [m] the points of its crumbs, `giving_way.SPACING` apart, back from where it is; None if
        there are hardly any, or it has backed up often enough."""
        back = None if self._errand.backed >= _MOST_ROOM else self._little_way_back(math.inf)
        if back is None:
            return None
        arcs = np.arange(back.start, back.end, -SPACING)
        return np.array([(*back.trail.point(arc), self.position[2]) for arc in arcs])

    @property
    def backs(self) -> float:
        """[m] that it backs up at least, to let others pass."""
        return _ROOM * (1 + self._errand.backed) * self.body.length

    def make_room(self, far: float) -> None:
        """Back up ``far`` [m] along its crumbs, then start again."""
        back = self._little_way_back(far)
        if back is not None:
            self._back(back)

    def give_up(self) -> None:
        """Become stuck among others."""
        self.stop()
        self.status = "stuck"
        reason = "it and those around it wait for each other"
        self.events.append(GotStuck(self.time, self._point(), among_others=True, reason=reason))

    def _little_way_back(self, far: float) -> WayBack | None:
        place, crumbs = self.herd.place(self.index), self.herd.trail_of_crumbs(self.index)
        return little_way_back(self.body, self.herd.ground, place, crumbs, far)

    def end_in(self, ahead: float) -> None:
        """Take the place ``ahead`` [m] further on as its goal; its own place, if at rest."""
        if self._phase == "resting" or self.trail is None:
            distance = math.dist(self._errand.goals[-1][:2], self.front[:2]) if self._errand.goals else 0.0
            self._end("arrived", Arrived(self.time, self._point(), distance))
            return
        st = self.herd.state[self.index]
        arc = float(st[at.ARC])
        end = arc + max(ahead, stop_length(st[at.SPEED], self.body.movement.braking))
        self.herd.follow(
            self.index, self.trail, self._errand.speed, start=arc, end=end, gait=self._errand.gait
        )
        goals, points = list(self._errand.goals), self.trail.points
        front = min(round((end + self.body.spine.length) / self.trail.step), len(points) - 1)
        x, y, z = points[front].tolist()
        goals[len(self.ways) - 1] = x, y, z
        self._errand = replace(self._errand, goals=tuple(goals))

    # --- time
    def tick(self) -> None:
        """Notice finished motions and start the next; call it after `Herd.tick`."""
        self._ticks += 1
        self._stood = self._stood + 1 if self._stands() else 0
        if self.herd.state[self.index, at.NO_GROUND] > 0.0:
            self._lose_ground()
            return
        if self._phase == "resting" or not self.herd.resting(self.index):
            return
        if self._phase == "waiting" and self._ticks % (_AGAIN if self._errand.waited < _OFTEN else _SELDOM):
            return
        phase, self._phase = self._phase, "resting"
        done = phase in ("following", "straightening", "moving")
        if not done or self._pending or not self._errand.goals:
            self._go_on(phase)
        elif phase == "following":
            self._straighten()
        else:
            self._arrive()

    def _go_on(self, phase: Phase) -> None:
        if phase == "backing":
            x, y = self._errand.backed_from
            gone = math.hypot(self.position[0] - x, self.position[1] - y)
            self.events.append(BackedOut(self.time, self._point(), gone))
        told_anew, self._pending = self._pending, False
        if not self._errand.goals:
            self.status = "standing" if self.status == "running" else self.status
        elif phase == "flexing" and self.trail is not None and not told_anew:
            self._follow(self.trail)
        else:
            try:
                self._set_out(self._errand, flexed=phase == "flexing")
            except ValueError as error:
                self._end("stuck", GotStuck(self.time, self._point(), reason=str(error)))

    def _lose_ground(self) -> None:
        self.herd.state[self.index, at.NO_GROUND] = 0.0
        self.herd.stop(self.index)
        self._phase, self._pending = "halting", False
        self._errand = replace(self._errand, goals=())
        if self.status != "lost":
            self.status = "lost"
            self.events.append(LostGround(self.time, self._point()))

    # --- beginning
    def _way(self, errand: Errand) -> tuple[Trail, tuple[Way, ...]]:
        """The path from where it is; raises ValueError if there is none."""
        return find_way(self.planner, self.body, self.herd.ground, errand.goals, self.herd.place(self.index))

    def _set_out(self, errand: Errand, flexed: bool = False) -> None:
        """From rest: turn onto the path if needed, else follow it. ``flexed``: it has just turned its front
        onto another path, and does not repeat that; with ever new orders it would never move off."""
        place = self.herd.place(self.index)
        trail, ways = self._way(errand)
        self._errand, self.ways = errand, ways
        turn = turn_onto(trail, self.body, place)
        if abs(turn) > self.body.spine_reach:
            self._turn_around(trail, place)
        elif abs(turn) > _LITTLE and not flexed:
            bend = bend_for(turn, self.body.spine.bones)
            script = into_flex(self.body, place, float(bend))
            self.trail = trail
            if self._free(script):
                self._play(script, "flexing")
            else:
                self._follow(trail)
        else:
            self._follow(trail)

    def _redirect(self, errand: Errand) -> None:
        """On the way: change to the new path if it leads on, else stop first."""
        place = self.herd.place(self.index)
        trail, ways = self._way(errand)
        if abs(turn_onto(trail, self.body, place)) < self.body.spine_reach:
            self._errand, self.ways = errand, ways
            self._follow(trail)
        else:
            self._errand, self._pending = errand, True
            self.herd.state[self.index, at.NO_GROUND] = 0.0  # of the old path
            self.herd.stop(self.index)
            self._phase = "halting"

    def _follow(self, trail: Trail) -> None:
        end = last_free_arc(trail, self.body, self.herd.ground, self.herd.last_arc(self.index, trail))
        self.trail = trail
        if end <= 0.0:  # the goal is nearer than the body is long
            end = 0.0
        self.herd.follow(self.index, trail, self._errand.speed, end=end, gait=self._errand.gait)
        self.herd.look_at(self.index, None)
        self._phase = "following"
        goal = tuple(float(value) for value in trail.points[-1])
        self.events.append(SetOff(self.time, self._point(), goal, trail.length))  # type: ignore[arg-type]

    def _free(self, script: Script) -> bool:
        """Whether a script touches nothing and nobody, with a margin of the check's resolution."""
        clear = self._look_around()
        return clear(script) and check_script(script, self.body, self.herd.ground, RESOLUTION).free

    def _look_around(self) -> Callable[[Script], bool]:
        """Function that tells whether a script started now would meet nobody."""
        return self._clear_of(*self._around())

    def _clear_of(self, there: NDArray[np.float64], radii: NDArray[np.float64]) -> Callable[[Script], bool]:
        """The same, with the others ``there`` (COUNT, k, 2) [m], of ``radii`` (k,) [m]."""

        def clear(script: Script) -> bool:
            own = foretell_script(script, self.body)
            return first_meeting(own, disc_radius(self.body), there, radii, 0.0)[0] == COUNT

        return clear

    def _play(self, script: Script, phase: Phase) -> None:
        self.herd.play(self.index, script)
        self._phase = phase

    # --- turning around
    def _turn_around(self, trail: Trail, place: Place) -> None:
        yaw, ground = first_heading(trail, self.body), self.herd.ground

        def leads_on(there: Place) -> bool:
            return has_way(self.planner, self._errand.goals, there)

        script = turn_script(self.body, ground, place, yaw, self._look_around(), leads_on)
        if script is None:
            script = turn_script(self.body, ground, place, yaw, leads_on=leads_on)
            if script is not None:
                self._wait(place, yaw, leads_on)
                return
        self._errand = replace(self._errand, waited=0)
        if script is not None:
            self.herd.forget_crumbs(self.index)
            self._play(script, "turning")
        elif self._errand.backed >= _MOST_BACKING or not self._back_out():
            self._manoeuvre(trail, place)

    def _wait(self, place: Place, yaw: float, leads_on: Callable[[Place], bool]) -> None:
        """Others block a turn to ``yaw``: wait for them, and after a while step away from them to turn
        there."""
        self._errand = replace(self._errand, waited=self._errand.waited + 1)
        self._phase = "waiting"
        if self._errand.waited < _OFTEN:
            return
        there, radii = self._around()
        at_last = np.repeat(there[-1:], COUNT, axis=0)
        ground = self.herd.ground

        def turns(stands: Place) -> bool:
            clear = self._clear_of(at_last, radii)
            return turn_script(self.body, ground, stands, yaw, clear, leads_on) is not None

        script = step_away(self.body, ground, place, self._clear_of(there, radii), turns)
        if script is not None:
            self._play(script, "turning")

    def _manoeuvre(self, trail: Trail, place: Place) -> None:
        """Get onto the trail by several short moves. Raises `NoTrail` if there is no room for any."""
        most = self._errand.manoeuvres >= _MOST_MANOEUVRES
        goals, ground = self._errand.goals, self.herd.ground

        # it plans no way around others, who may leave before it gets there
        alone = len(self._around()[1]) == 0

        def leads_on(there: Place) -> bool:
            return can_set_out(self.planner, self.body, ground, goals, there)

        script = None if most or not alone else find_manoeuvre(self.body, ground, place, trail, leads_on)
        if script is None:
            raise NoTrail(
                f"at ({place.x:.2f}, {place.y:.2f}) a {self.body.name} has no room to turn towards its path, "
                "nor can it back out"
            )
        self._errand = replace(self._errand, manoeuvres=self._errand.manoeuvres + 1)
        self._play(script, "turning")

    def _back_out(self) -> bool:
        """Back up along the crumbs to the nearest place with room for a turn; False if there is none."""
        place, crumbs = self.herd.place(self.index), self.herd.trail_of_crumbs(self.index)
        back = way_back(self.planner, self.body, self.herd.ground, self._errand.goals, place, crumbs)
        if back is None:
            return False
        self._back(back)
        return True

    def _back(self, way: WayBack) -> None:
        x, y = self.position[:2].tolist()
        self._errand = replace(self._errand, backed=self._errand.backed + 1, backed_from=(x, y))
        self.herd.state[self.index, at.PACE] = 1.0
        speed = self.body.movement.back_speed
        self.herd.follow(self.index, way.trail, speed, start=way.start, end=way.end, backwards=True)
        self._phase = "backing"

    # --- short moves
    def _move_locally(self, errand: Errand) -> bool:
        """Make a short move by local motion, if the goal is near and the way clear."""
        if len(errand.goals) != 1:
            return False
        script, length = short_move(self.body, self.herd.place(self.index), errand.goals[0], errand.facing)
        if script is None or not self._free(script):
            return False
        self._errand = errand
        self._play(script, "moving")
        self.events.append(SetOff(self.time, self._point(), errand.goals[0], length))
        return True

    # --- the end
    def _straighten(self) -> None:
        """Swing the rear round; stay as it is if there is no room."""
        if len(self.ways) < len(self._errand.goals):
            self._next_goal()
            return
        place = self.herd.place(self.index)
        facing = self._errand.facing
        facing = place.chest(self.body) if facing is None else facing
        if abs(place.bend) > _EXACT or abs(wrap(facing - place.yaw)) > _EXACT:
            script = out_of_flex(self.body, place, float(facing))
            if self._free(script):
                self._play(script, "straightening")
                return
        self._arrive()

    def _next_goal(self) -> None:
        """At a goal from which the path turns back: start towards those that are left."""
        self._errand = replace(self._errand, goals=self._errand.goals[len(self.ways) :], backed=0)
        self._go_on("halting")

    def _arrive(self) -> None:
        goal = np.array(self._errand.goals[-1])
        distance = float(np.linalg.norm(goal[:2] - self.front[:2]))
        if distance <= SHORT_OF_GOAL * self.body.length:
            self._end("arrived", Arrived(self.time, self._point(), distance))
        else:
            self._end("lost", MissedGoal(self.time, self._point(), distance))

    def _end(self, status: Status, event: Event) -> None:
        self.status, self._phase = status, "resting"
        self.events.append(event)

    def _point(self) -> tuple[float, float, float]:
        x, y, z = self.position.tolist()
        return x, y, z

    # --- saving
    def save(self) -> AnimalMemory:
        """Everything needed to continue from here."""
        return AnimalMemory(
            self.herd.save(self.index), self._phase, self.status, self._errand, self._pending, self.trail,
            self.ways, self._ticks, self._stood, tuple(self.events),
        )  # fmt: skip

    def restore(self, memory: AnimalMemory) -> None:
        """Restore a state of this animal."""
        self.herd.restore(self.index, memory.herd)
        self._phase, self.status, self._errand = memory.phase, memory.status, memory.errand
        self._pending, self.trail, self.ways = memory.pending, memory.trail, memory.ways
        self._ticks, self._stood = memory.ticks, memory.stood
        self.events[:] = memory.events

    def state_hash(self) -> str:
        """Hex digest of everything that decides its future."""
        mind = repr((self._phase, self.status, self._errand, self._pending, self._stood))
        return f"{self.herd.state_hash(self.index)}{hashlib.sha256(mind.encode()).hexdigest()[:8]}"
