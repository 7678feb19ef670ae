"""An agent: a body in a world that is told where to go."""

import hashlib
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from locomotion import MOVING, Ground, Human, LocomotionError
from locomotion import body_events as bodily
from locomotion.avoidance.yielding import Course
from locomotion.quadruped import Animal
from locomotion.skills.registry import CLEARING, skill_kind
from runtime.bodies.figure import Figure
from runtime.bodies.pose import Pose
from runtime.bodies.protocol import Driver
from runtime.errors import RuntimeInputError
from runtime.events import (
    Blocked,
    Departed,
    Event,
    Fell,
    GotUp,
    Hindered,
    Lost,
    Waiting,
)
from runtime.planning.beyond import Beyond, loaded_part
from runtime.planning.planning import NotLoaded, NoWay, Plan
from runtime.traffic.waiting_and_deadlock import Headway
from runtime.world.agent_services import Host
from runtime.world.agent_state import AgentState, Errand
from runtime.world.arguments import checked_number, checked_points
from runtime.world.level_of_detail import AUTO, PHYSICS, checked_detail
from runtime.world.news import news_of
from surefoot.numeric import as_point

__all__ = ["Agent", "Pose"]

_POSTURED = "full"  # the level of a simulated person while it takes a posture
_FATAL = "dead"  # the posture that is taken at once
_CARRIED_OFF = 0.5  # [m] beside its path from which a person that has got up takes another one
_ATTEMPTS = 3  # of a person that is stuck or lost to find another way to its goals
_SHORTEST_PUSH, _LONGEST_PUSH = 0.01, 10.0  # [s]
_TURNINGS = 6  # times that it goes back before the same obstacle, until it is stuck
_Kind = TypeVar("_Kind")
_AT_REST = "standing", "arrived"
_HELPLESS = bodily.GotStuck, bodily.StrayedFromPath, bodily.MissedGoal


class Agent:
    """One figure in a world; made by `World.spawn`.

    ``name`` is unique in its world, ``body`` is what `World.spawn` was given; ``news`` are its
    body's events that the world has not been told of; ``has_levels``: whether it can be drawn in more or
    less detail; ``waits_for_level``: whether its level may differ from a `detail` that was asked for, as that
    of "auto" always may;
    ``arrival``: a number, greater than of all bodies that came before its own;
    ``changed``: the world's time [s] when it got its body or its level of detail
    last, -inf if that was before the world was restored.
    """

    def __init__(self, host: Host, name: str, body: str, driver: Driver) -> None:
        self.name = name
        self.body = body
        self._bravery: float | None = None
        self._style: dict[str, float] = {}
        self._host = host
        self.take(driver)
        self.changed = host.clock.time
        self._blocked = False
        self._born = host.clock.time - driver.time
        self._goal = _triple(driver.position)
        self._errand = Errand()
        self._headway = Headway()
        self._detail = driver.detail
        self.has_levels = len(host.levels(body)) > 1
        self.waits_for_level = False

    def __repr__(self) -> str:
        if self._body is None:
            return f"<Agent {self.name!r}: a {self.body}, removed from its world>"
        return f"<Agent {self.name!r}: a {self.body}, {self.status} at {self.position.round(2).tolist()}>"

    @property
    def figure(self) -> Figure:
        """Its bodies and what they look like; of one that was removed as it was last."""
        return self._figure if self._body is None else self._body.figure

    @property
    def human(self) -> Human:
        """The simulated person. Raises `RuntimeInputError` for other bodies."""
        return self.simulated(Human)

    @property
    def animal(self) -> Animal:
        """The quadruped. Raises `RuntimeInputError` for other bodies."""
        return self.simulated(Animal)

    def simulated(self, kind: type[_Kind]) -> _Kind:
        """What simulates its body, which has to be a ``kind``: `locomotion.Human`,
        `locomotion.quadruped.Animal`, `locomotion.crowd.Walker`, or of a body of your own what its driver
        says. Raises `RuntimeInputError` for another kind."""
        found = self._driver.simulated
        if not isinstance(found, kind) and self.level != PHYSICS:
            raise RuntimeInputError(
                f"{self.name} plays recorded motion ({self.level}), it is no {kind.__name__}; "
                "its detail would have to be 'physics'"
            )
        if not isinstance(found, kind):
            raise RuntimeInputError(f"{self.name} is a {self.body}, not a {kind.__name__}")
        return found

    @property
    def plans(self) -> list[Plan]:
        """The last paths that it was given or made, the present one at the end."""
        return list(self._driver.plans)

    @property
    def way(self) -> Plan | None:
        """The path that it is on, or that a person is still planning; None while it is not on its way."""
        return self._driver.plans[-1] if self.moving and self._driver.plans else None

    @property
    def status(self) -> str:
        """What it does: "standing", "walking", "running" (of a quadruped: on its way), "arrived", "lost",
        "stuck", of a human also "jumping", "vaulting", "dropping", "leaping", "scrambling", "getting
        up" and "fallen"; or "blocked": the last goal cannot be reached; or "waiting": it stands until more of
        an open world is loaded on its way."""
        if self._blocked:
            return "blocked"
        status = self._driver.status
        return "waiting" if self._errand.waits and status in _AT_REST else status

    @property
    def moving(self) -> bool:
        """Whether it is on its way: walking, running or clearing an obstacle."""
        return self._driver.status in MOVING

    @property
    def told_to(self) -> tuple[float, float, float] | None:
        """(3,) [m] Where what is loaded ends of a way that it is on in an open world; None for other ways."""
        beyond = self._errand.beyond
        return None if beyond is None or not beyond.told else beyond.told[-1]

    @property
    def waits_for(self) -> tuple[float, float, float] | None:
        """(3,) [m] The place in an open world that has to be loaded before it can go on; None while it does
        not wait."""
        errand = self._errand
        return errand.beyond.towards if errand.waits and errand.beyond is not None else None

    @property
    def position(self) -> np.ndarray:
        """(3,) float64 [m]: of a human the point of the ground under its centre of mass, of a quadruped the
        middle between its front feet."""
        return self._driver.position

    @property
    def facing(self) -> float:
        """[rad, -π to π] counter-clockwise from the X axis."""
        return self._driver.facing

    @property
    def radius(self) -> float:
        """[m] that the graph's queries keep free around it."""
        return self._driver.radius

    @property
    def progress(self) -> float:
        """Share of its path that is behind it, 0 to 1; of one that leads through what is not loaded of an
        open world, as far as that is known."""
        errand = self._errand
        if errand.length == 0.0:
            return self._driver.progress
        waits = self.status == "waiting"
        left = (0.0 if waits else self._driver.left) + (errand.beyond.length if errand.beyond else 0.0)
        return min(max(1.0 - left / errand.length, 0.0), 1.0)

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]:
        """For each affordance that it can clear the least and the greatest height (of a gap: width) [m], as
        `NodeGraph.find_path` takes them."""
        return self._driver.skills

    @property
    def ground(self) -> Ground | None:
        """The level as a person stands on it, which `locomotion.Rig.pose` wants; None for other bodies."""
        return self._driver.ground

    @property
    def time(self) -> float:
        """The time [s] of the world's last tick, at which `pose` is."""
        return self._host.clock.time

    @property
    def pose(self) -> Pose:
        """Where its skeleton is, at the last tick."""
        return Pose(self.figure.bodies, self.figure.parents, self._driver.transforms())

    @property
    def blended_pose(self) -> Pose:
        """Where to draw its skeleton: `World.blend` of the way from the last tick but one to the last. Moves
        evenly at any frame rate, one tick behind `pose`."""
        transforms = self._driver.transforms_between(self._host.clock.blend)
        return Pose(self.figure.bodies, self.figure.parents, transforms)

    # --- odds
    @property
    def bravery(self) -> float | None:
        """Of a person in a world without rehearsals: from 0 to 1, it takes off where its odds are at least 1
        less this, and turns away elsewhere (`TurnedAway`). None: it does not ask. With rehearsals this
        changes nothing. Can be set; raises `RuntimeInputError` for another value, and for bodies without
        odds. Takes constant time."""
        return self._bravery

    @bravery.setter
    def bravery(self, bravery: float | None) -> None:
        self._heed(bravery)

    def _heed(self, bravery: float | None) -> None:
        self._driver.heed(bravery)
        self._bravery = bravery

    def odds(self, obstacle: int | str) -> float:
        """Chance, 0 to 1, that its bare skill, without rehearsals, clears an obstacle of the level from where
        it is: an index into `NodeGraph.obstacles`, or a tag. In the run-up to that obstacle it goes by how it
        moves; elsewhere by the obstacle and the way before it. 0 for a size that none of its skills clears.

        Takes constant time. Raises `RuntimeInputError` for an unknown obstacle, a skill of one's own, of
        which no odds are known, or a body without odds.
        """
        return self._driver.odds(obstacle)

    def push(self, force: ArrayLike, seconds: float = 0.1) -> None:
        """Push a person that is simulated: with ``force`` (3,) [N] at its waist, for so many ``seconds`` of
        the world from now on, 0.01 to 10, instead of what pushes it now. It gives way, takes steps, goes on,
        or falls and gets up. A hard shove is 200 N for 0.1 s. Takes constant time.

        Raises `RuntimeInputError` if ``force`` is not three finite numbers, ``seconds`` are out of range, or
        the body is not a simulated person.
        """
        newtons = as_point(force)
        if newtons is None:
            raise RuntimeInputError(f"force must be three finite numbers [N], not {force!r}")
        seconds = checked_number(seconds, "seconds", "s")
        if not _SHORTEST_PUSH <= seconds <= _LONGEST_PUSH:
            raise RuntimeInputError(
                f"seconds must be from {_SHORTEST_PUSH:g} to {_LONGEST_PUSH:g}, not {seconds!r}"
            )
        self._driver.push(newtons, seconds)

    # --- detail and postures
    @property
    def detail(self) -> str:
        """In how much detail it was asked to be: "physics" (simulated), or of recorded motion "full",
        "medium" or "low", or "auto": as the world's `viewers` and `budget` have it. It can be set; then
        `level` changes as soon as it can without a jump. Raises `RuntimeInputError` for a detail that its
        body cannot have."""
        return self._detail

    @detail.setter
    def detail(self, detail: str) -> None:
        asked = checked_detail(detail, self._host.levels(self.body), self.body)
        self._detail, self.waits_for_level = asked, True
        if detail not in (AUTO, self.level):
            self.change_level(detail)

    @property
    def level(self) -> str:
        """What moves it now: "physics", or recorded motion that is "full", "medium" or "low"."""
        return self._driver.detail

    @property
    def posture(self) -> str:
        """The posture that it is in or on its way to, such as "kneel"; on its way somewhere: "stand"."""
        return self._driver.posture

    @property
    def held(self) -> tuple[str, str]:
        """What its hands hold and in which state, such as ("rifle", "deployed"); ("", "stowed") with free
        hands."""
        return self._driver.held

    def take_posture(self, posture: str) -> None:
        """Take a posture: "stand", "crouch", "kneel", "all-fours", "prone", "sit" or "dead". It first comes
        to a stand, except to be dead; what its hands cannot hold in that posture they stow. `PostureReached`
        tells when it is in it.

        Postures are recorded motion: a simulated person plays it meanwhile, and is simulated again once it
        stands. Raises `RuntimeInputError` for a posture that it does not have or cannot get to, while a
        simulated person clears an obstacle or lies on the ground (but "dead"), and for bodies that have none.
        """
        self._take(posture, *self._driver.held_in(posture))

    def set_style(self, /, **traits: float) -> None:
        """Let a person differ from others in these traits: its ``phase``, ``pace``, ``width`` of step, swing
        of the ``arms``, ``lean``, ``head`` and ``size``, as of `locomotion.body.traits.TRAITS`. Those that
        are not named stay as they are. A person begins with traits by chance, from the world's seed and its
        place, and with the size 1, which is 1.76 m.

        While it is simulated they show on its next level ways without obstacles, but for the phase, and
        within `locomotion.gaits.policy.style.WORN`: beyond that it would fall. Another size shows at once,
        but while it is simulated it can change only where it stands, in steps of 1 %; the first of a size
        takes load time. Recordings and clients take the size that one has when they begin or it appears.
        Raises `RuntimeInputError` for an unknown trait, a value out of its range, a size that cannot change
        now, and any other body.
        """
        self._driver.set_style(traits)
        self._style |= traits

    def hold(self, held: str, state: str = "deployed") -> None:
        """Have an object in its hands, such as "rifle", in a state: "deployed", "in use", or "stowed" again.
        Raises `RuntimeInputError` for an object or a state that there is not, or not in its posture."""
        self._take(self.posture, held, state)

    def _take(self, posture: str, held: str, state: str) -> None:
        self._driver.check_posture(posture, held, state)
        if self.level == PHYSICS and (posture, state) != ("stand", "stowed"):
            if not self.change_level(_POSTURED, at_once=posture == _FATAL):
                raise RuntimeInputError(f"{self.name} is {self.status}; it takes a posture once it stands")
        self._errand, self._blocked = Errand(), False
        self._driver.take(posture, held, state)

    def change_level(self, level: str, at_once: bool = False) -> bool:
        """Be moved at another level of detail from now on, if that can be now, or ``at_once`` in any case; it
        goes on with what it does. The world calls this."""
        self.notice()
        going, goals = self.moving, self._points_left if self._errand.goals else None
        driver = self._host.at_level(self, level, at_once)
        self.waits_for_level = driver is None or driver.detail != self._detail
        if driver is None:
            return False
        self.changed = self._host.clock.time
        if driver is not self._driver:
            self.take(driver)
            self._born = self._host.clock.time - driver.time
            if going and goals is not None:
                self._goes_on(goals)
        return True

    def _goes_on(self, goals: np.ndarray) -> None:
        """Let a body that has just taken over follow the way to ``goals``."""
        errand = self._errand
        try:
            self._driver.go_to(goals, errand.speed, None if self.level == PHYSICS else errand.facing)
        except (NoWay, RuntimeInputError, LocomotionError) as error:
            self._report_blocked(goals[0], str(error))
            self._driver.stop()

    def plan(self, point: ArrayLike) -> Plan:
        """The way that `go_to` would take, not taken; in an open world as far as it is loaded. Raises
        `runtime.planning.planning.NoWay`, `NotLoaded` where nothing of it is, and `RuntimeInputError` as
        `go_to` does."""
        goals = checked_points(point, "point")
        beyond, plan = self._ways(goals, lambda points, _: self._driver.plan(points))
        if plan is None:
            assert beyond is not None
            raise NotLoaded(beyond.full, "what comes first of the way is not loaded yet")
        return plan

    def go_to(self, point: ArrayLike, speed: float = 3.5, facing: float | None = None) -> str:
        """Set out for ``point`` (3,) [m], or through several (k, 3) in order, at up to ``speed`` [m/s]; a
        quadruped and a walker can be told the ``facing`` [rad] in which to end. The route is found at once. A
        person's path is planned in the ticks that follow, in slices: until then it stands, or goes on as it
        did, and `way` is the shortest line with sharp corners. For other bodies it is planned at once, in
        time in proportion to the way.

        In an open world the goals need not be loaded. Whether they can be reached is known at once; the agent
        goes as far as its way is loaded, and farther as more of it is. Where nothing more is it stands, with
        `Waiting`, and goes on by itself.

        Returns the status: "walking", "running", "waiting" for what is not loaded of an open world, or
        "blocked" when there is no way (an event says why; the agent then keeps doing what it did). Raises
        `RuntimeInputError` for a point that is not finite numbers, a speed that is not above 0, or an agent
        that has fallen or was removed.
        """
        goals, speed = checked_points(point, "point"), checked_number(speed, "speed", "m/s")
        if speed <= 0.0:
            raise RuntimeInputError(f"speed must be above 0 m/s, not {speed!r}")
        facing = None if facing is None else checked_number(facing, "facing", "rad")
        if len(goals) == 1 and not self.moving and self._has_come(goals[0]):
            self._goal, self._blocked = _triple(goals[0]), False
            self._errand = replace(self._errand, beyond=None, length=0.0, waits=False)
            return self.status
        follower = None if self._driver.plans_in_slices else self._driver.follower
        former = None if follower is None else follower.course()
        try:
            beyond, plan = self._ways(goals, self._teller(speed, facing))
        except NoWay as error:
            self._report_blocked(goals[error.goal], error.reason)
            return self.status
        errand = Errand(tuple(_triple(each) for each in goals), speed, facing, beyond=beyond)
        if beyond is not None:
            errand = replace(errand, length=beyond.length + (0.0 if plan is None else plan.length))
        self._errand = errand
        if plan is None:
            self._wait()
        else:
            self._depart(plan, former)
        return self.status

    def _teller(self, speed: float, facing: float | None) -> Callable[[np.ndarray, bool], Plan]:
        """What tells its driver to go: at the end of a way it takes the ``facing``, before that none."""
        return lambda points, whole: self._driver.go_to(points, speed, facing if whole else None)

    def _ways(
        self, goals: np.ndarray, tell: Callable[[np.ndarray, bool], Plan]
    ) -> tuple[Beyond | None, Plan | None]:
        """What is not loaded yet of the way through ``goals`` (k, 3), None if all is; and the plan for the
        rest, which ``tell`` gives for points (n, 3), and whether they are the whole way: None where nothing
        is loaded to go on. Raises `NoWay`."""
        world = self._host.open_world()
        if world is None:
            return None, tell(goals, True)
        if world.is_loaded(goals).all():
            try:
                return None, tell(goals, True)
            except NoWay:
                if len(world.loaded) == len(world.chunks):
                    raise
        beyond = loaded_part(world, self.position, goals, self.radius, self.skills)
        if beyond is None:
            return None, tell(goals, True)
        return beyond, tell(np.array(beyond.told), False) if beyond.told else None

    def _has_come(self, goal: np.ndarray) -> bool:
        """Whether one at rest that gives way by its path is as near to ``goal`` (3,) as those who stand there
        let it, see `locomotion.avoidance.goal_occupancy`: it has then arrived."""
        follower = self._driver.follower
        if follower is None or self.status == "fallen" or not self._host.traffic.has_come(follower, goal):
            return False
        follower.end_in(0.0)
        return True

    def stop(self) -> None:
        """Give up its way and come to a stand, as soon as it can without falling; an obstacle that it is
        clearing is cleared first. Without a way it stays as it is. Takes constant time."""
        if self.moving:
            self._driver.stop()
        self._errand, self._blocked = Errand(), False

    def _wait(self) -> None:
        """Stand until more of its way is loaded."""
        if self.moving:
            self._driver.stop()
        self._blocked, self._errand = False, replace(self._errand, waits=True)
        here, goal = _triple(self.position), self._errand.goals[-1]
        self._tell(Waiting(self._host.clock.time, self.name, here, goal))

    def _come_to_the_end(self, beyond: Beyond) -> None:
        """It is where what was loaded of its way ended: go on if more is, or wait."""
        goals = self._errand.goals[beyond.full :]
        if not self._goes_farther(np.array(goals)):
            self._errand = replace(self._errand, goals=goals, beyond=replace(beyond, told=(), full=0))
            self._wait()

    def _goes_farther(self, goals: np.ndarray) -> bool:
        """Whether more is loaded now of a way through ``goals`` (k, 3) that was not loaded as a whole: it
        then takes it, or stops if it turns out that there is none for it."""
        errand, world = self._errand, self._host.open_world()
        if errand.beyond is None or world is None or not world.is_loaded(errand.beyond.towards)[0]:
            return False
        follower = None if self._driver.plans_in_slices else self._driver.follower
        former = None if follower is None else follower.course()
        try:
            beyond, plan = self._ways(goals, self._teller(errand.speed, errand.facing))
        except (NoWay, RuntimeInputError, LocomotionError) as error:
            at, reason = (error.goal, error.reason) if isinstance(error, NoWay) else (0, str(error))
            self.stop()
            self._report_blocked(goals[at], reason)
            return True
        if plan is None:
            return False
        left = tuple(_triple(each) for each in goals)
        self._errand = replace(errand, goals=left, beyond=beyond, waits=False)
        self._depart(plan, former, told=errand.waits)
        return True

    def _depart(self, plan: Plan, former: Course | None = None, told: bool = True) -> None:
        """Report that it has taken the way of ``plan``, if that is to be ``told``; ``former`` is the course
        that it was on."""
        self._blocked = False
        here, goal, beyond = _triple(self.position), self._errand.goals[-1], self._errand.beyond
        self._goal = _triple(plan.points[-1])
        follower = self._driver.follower
        if follower is not None and not self._driver.plans_in_slices:
            self._host.traffic.look_out(follower, former)
        now = self._host.clock.time
        self._headway = Headway(since=now, tried=now)
        if told:
            skills = tuple(skill_kind(each).skill for each in plan.skills)
            length = plan.length + (0.0 if beyond is None else beyond.length)
            self._tell(Departed(now, self.name, here, goal, length, skills))

    def _report_blocked(self, goal: np.ndarray, reason: str) -> None:
        self._blocked = True
        here = _triple(self.position)
        self._tell(Blocked(self._host.clock.time, self.name, here, _triple(goal), reason))

    def _tell(self, event: Event) -> None:
        self._headway = replace(self._headway, told=self._host.clock.time)
        self._host.log.report(event)

    def watch(self) -> None:
        """Say so if it is on its way and gets nowhere, and do something else after a while; `World.step`
        calls this every half second."""
        driver = self._driver
        if driver.status not in MOVING:
            return
        now = self._host.clock.time
        self._headway = self._headway.seen(driver.left, now)
        if self._headway.late(now):
            self._hindered(driver.hindrance)
        if driver.tries_other_ways and self._headway.desperate(now):
            self._headway = replace(self._headway, tried=now)
            if driver.can_turn and not self._tries_again():
                driver.give_up()

    def _hindered(self, reason: str) -> None:
        self._tell(Hindered(self._host.clock.time, self.name, _triple(self.position), reason))

    def look_at_way(self) -> None:
        """After a change of the level: go on where the way holds, look for another one where it does not, and
        stop where there is none. One that is clearing an obstacle first does that. In an open world go
        farther if more of the way is loaded."""
        if self.status in CLEARING.values():
            self._errand = replace(self._errand, doubtful=True)
            return
        self._errand = replace(self._errand, doubtful=False)
        if (self.moving or self.status == "waiting") and self._goes_farther(self._goals_left):
            return
        if not self.moving or self._driver.way_holds():
            return
        goals = self._goals_left
        try:
            status = self.go_to(goals, self._errand.speed, self._errand.facing)
        except (RuntimeInputError, LocomotionError) as error:  # a ground that the graph does not tell of
            self._report_blocked(goals[0], str(error))
            status = self.status
        if status == "blocked":
            self._driver.stop()

    @property
    def _goals_left(self) -> np.ndarray:
        """(k, 3) [m]: the goals that are still before it."""
        errand, beyond = self._errand, self._errand.beyond
        if errand.waits or beyond is None:
            return np.array(errand.goals if errand.waits else errand.goals[-self._driver.goals_left :])
        return np.array(errand.goals[min(len(beyond.told) - self._driver.goals_left, beyond.full) :])

    @property
    def _points_left(self) -> np.ndarray:
        """(k, 3) [m]: what its body was told of them, as far as that is loaded."""
        beyond = self._errand.beyond
        return np.array((self._errand.goals if beyond is None else beyond.told)[-self._driver.goals_left :])

    def _goes_another_way(self, round_it: bool = False) -> bool:
        """Whether a person finds another way to its goals from where it is, and takes it; ``round_it``: over
        no obstacle, or at least not over the next one, if there is such a way."""
        if not self._errand.goals or not self._driver.tries_other_ways:
            return False
        goals, speed, closed = self._points_left, self._errand.speed, self._errand.closed
        try:
            if round_it:
                plan, closed = self._driver.go_round(goals, speed, closed)
            else:
                plan = self._driver.go_without(goals, speed, closed)
        except (NoWay, RuntimeInputError, LocomotionError):
            return False
        self._errand = replace(self._errand, closed=closed)
        self._depart(plan)
        return True

    def _tries_again(self) -> bool:
        """Whether one that is stuck or lost takes another way, if it can round what it has not cleared."""
        attempts = self._errand.attempts + 1
        self._errand = replace(self._errand, attempts=attempts)
        return attempts <= _ATTEMPTS and self._goes_another_way(round_it=True)

    def _balks(self, event: bodily.WentBack) -> None:
        """A person goes back for another run-up: the second time it goes another way if there is one, or else
        straight to the beginning of a run-up of its own."""
        obstacle = f"the {event.affordance} of {event.size:.2f} m"
        self._hindered(f"it goes back {event.distance:.1f} m for another run-up to {obstacle}")
        tag = self._driver.tag_ahead
        self._errand = replace(self._errand, balked=(*self._errand.balked, tag))
        times = self._errand.balked.count(tag)
        if times >= _TURNINGS:
            self._driver.give_up(f"it has gone back {times} times and finds no run-up to {obstacle}")
        elif times % 2 == 0:
            self._goes_another_way(round_it=times == 2)

    def _close_way(self) -> None:
        """Have no way lead over the obstacle ahead any more: its odds there will be the same again."""
        closed = (*self._errand.closed, self._driver.tag_ahead)
        self._errand = replace(self._errand, closed=closed)

    @property
    def _carried_off(self) -> bool:
        """Whether one on its way is so far beside its path that it should not go back there."""
        return self.moving and self._driver.beside_path > _CARRIED_OFF

    def notice(self) -> None:
        """Report what has happened to the body; `World.step` calls this after every tick in which there is
        `news`."""
        self._driver.take_note()
        follower, left = self._driver.follower, self._driver.sets_out()
        if follower is not None and left is not None:
            self._host.traffic.look_out(follower, *left)
        for event in map(self._driver.in_world, self.news):
            if isinstance(event, bodily.Arrived) and self._errand.beyond is not None:
                self._come_to_the_end(self._errand.beyond)
                continue
            if isinstance(event, bodily.WentBack):
                self._balks(event)
                continue
            if isinstance(event, bodily.TurnedAway) and self._driver.status == "stuck":
                self._close_way()
            among_others = isinstance(event, bodily.GotStuck) and event.among_others
            if isinstance(event, _HELPLESS) and not among_others and self._tries_again():
                continue
            told = news_of(event, self.name, self._born, self._goal)
            if isinstance(told, Fell | Lost):
                self._blocked = False
            if told is not None:
                self._tell(told)
            if isinstance(told, GotUp) and self._carried_off:
                self._goes_another_way()
        self.news.clear()
        if self._errand.doubtful:
            self.look_at_way()

    @property
    def driver(self) -> Driver:
        """What moves its body. Raises `RuntimeInputError` for one that was removed from its world, as does
        everything that asks it of its body."""
        if self._body is None:
            raise RuntimeInputError(f"{self.name} has been removed from its world; spawn another")
        return self._body

    _driver = driver

    def take(self, driver: Driver) -> None:
        """Go on with another body of the same kind."""
        self._body: Driver | None = driver
        self._figure = driver.figure
        self.arrival = next(self._host.arrivals)
        self.news = driver.events
        self._heed(self._bravery)
        if self._style:
            driver.set_style(self._style)
        self._style |= driver.traits  # those by chance, too

    def leave(self) -> None:
        """Have no body any more; `World.remove` calls this."""
        self._figure = self.figure
        self._body = None

    def remove(self) -> None:
        """Take it out of its world; it cannot be used any more."""
        self._host.remove(self)

    def save(self, arrival: int) -> AgentState:
        """Everything needed to continue from here; ``arrival`` as of `AgentState`."""
        return AgentState(
            self.body, self._born, self._driver.save(), self._blocked, self._goal, self._errand,
            self._headway, self._detail, self._bravery, arrival, dict(self._style),
        )  # fmt: skip

    def fits(self, state: AgentState) -> bool:
        """Whether its body can go on from a state of this agent: one of another level of detail cannot."""
        return self._driver.fits(state.driver)

    def restore(self, state: AgentState) -> None:
        """Continue from a state of this agent."""
        self._driver.restore(state.driver)
        self._born, self._blocked, self._goal = state.born, state.blocked, state.goal
        self._errand, self._headway = state.errand, state.headway
        self._detail = checked_detail(state.detail, self._host.levels(self.body), self.body)
        self.waits_for_level, self.changed = True, -math.inf
        self._heed(state.bravery)
        self._style = dict(state.style)
        if self._style:
            self._driver.set_style(self._style)

    def state_hash(self) -> str:
        """Hexadecimal digest of everything that decides how it goes on."""
        own = self._driver.state_hash()
        if self._bravery is not None:
            own = hashlib.sha256(f"{own} {self._bravery!r}".encode()).hexdigest()
        if self._style:
            own = hashlib.sha256(f"{own} {sorted(self._style.items())!r}".encode()).hexdigest()
        if self._errand.beyond is not None:
            own = hashlib.sha256(f"{own} {self._errand!r}".encode()).hexdigest()
        return own


def _triple(point: ArrayLike) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in np.asarray(point))
    return x, y, z
