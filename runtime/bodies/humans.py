"""Simulated persons in a world, each with a simulation of its own."""

import hashlib
import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from locomotion import MOVING, PERSON_RULES, Ground, Human, HumanState, LocomotionError, load_run_skill
from locomotion.avoidance.yielding import SPACING, Course
from locomotion.body.person import CONTROL_DT
from locomotion.body.traits import SIZE, TRAITS, by_hand
from locomotion.body_events import Arrived, Event, GotStuck, MissedGoal, PostureReached, StrayedFromPath
from locomotion.gaits.brake import load_brake_skill
from locomotion.gaits.policy.skill import PolicySkill, load_policy
from locomotion.gaits.residual.skill import load_brake_residual, load_landing_residual
from locomotion.gaits.run.skill import RunSkill
from locomotion.gaits.slow_down import load_slow_down_skill
from locomotion.gaits.speed_up import load_speed_up_skill
from locomotion.gaits.walk.skill import WalkSkill, load_walk_skill
from locomotion.human.human import BetweenGaits
from locomotion.human.motion_start import moment_like, set_in_motion
from locomotion.human.saved_state_check import check_person
from locomotion.human.sized_human import Glimpse, SizedHuman, movements_of
from locomotion.postures.step_order import AT_REST
from locomotion.preconditions.precondition import load_preconditions
from locomotion.recorded_people import layout as at
from locomotion.recorded_people.fading import fade_from, faded, rates
from locomotion.recorded_people.nodes import can_hold, checked_node
from locomotion.recorded_people.people import person_postures
from locomotion.recorded_people.person import RecordedPerson
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.rehearsal.sharing import REHEARSAL_TICKS, allot
from locomotion.saved_arrays import check_array, check_number
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.library import learned_skills
from locomotion.skills.registry import CLEARING
from runtime.bodies.figure import Joints
from runtime.bodies.joints import person_figure, person_joints
from runtime.bodies.obstacle_odds import odds_at
from runtime.bodies.person_orders import ARRIVED, Order, OrdersState, PersonOrders
from runtime.bodies.protocol import PLANS_KEPT, Driver, Follower, Population, recall, saved_parts
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.planning.planning import NoWay, Plan, way_holds
from runtime.traffic.snapshot import foretold_on
from surefoot.numeric import is_finite
from surefoot.pausing import pause
from surefoot.workers.threads import Threads

__all__ = ["HumanDriver", "People", "SavedPerson", "chance_at"]

_ASKEW = 0.4  # [rad] that a body which physics takes over may face off its way
_SPOTS, _BESIDE = np.array([-0.4, 0.0, 0.4, 0.8, 1.2]), 0.15  # [m] along its way and beside it,
_UNEVEN = 0.02  # where the ground is no more than this [m] higher or lower
_STEEP = 20.0  # [degrees] of ground that is worth mentioning
_HESITATES = 0.4  # [s] at most, from a stand: less than half a step
_ENDS = Arrived, GotStuck, MissedGoal, StrayedFromPath


class _Learned(NamedTuple):
    """What people have learned, read once for all of a world."""

    run: RunSkill
    clearing: tuple[ClearingSkill, ...]
    walk: WalkSkill
    between: BetweenGaits
    policy: PolicySkill | None

    @classmethod
    def read(cls, skills: Sequence[Path], walk: str) -> "_Learned":
        run = load_run_skill()
        between = BetweenGaits(
            load_slow_down_skill(),
            load_speed_up_skill(),
            load_brake_skill(),
            load_brake_residual(),
            load_landing_residual(),
        )
        policy = load_policy() if walk == "learned" else None
        return cls(run, tuple(learned_skills(run, skills)), load_walk_skill(), between, policy)


@dataclass(frozen=True)
class Fading:
    """How a person is drawn beside its simulated pose ``since`` [s] it was made: see
    `locomotion.recorded_people.fading`."""

    offsets: np.ndarray
    rates: np.ndarray
    seconds: float
    since: float


def chance_at(place: np.ndarray, seed: int) -> np.random.Generator:
    """What is by chance in somebody who appears at ``place`` (3,) [m] in a world of this ``seed``."""
    millimetres = (np.round(1000.0 * place).astype(np.int64) % 2**32).tolist()
    return np.random.default_rng((seed, *millimetres))


class People(Population):
    """Simulated persons. ``skills``: descriptions of those of one's own that they have besides the
    package's; ``rehearsals``: as of `Human`; ``seed`` decides how long each of them hesitates; ``walk``: one
    of `runtime.bodies.kinds.kind.WALKS`; ``rehearsal_ticks``, ``threads``: as of `runtime.World`."""

    def __init__(
        self,
        level: Level,
        skills: Sequence[Path] = (),
        rehearsals: int = REHEARSALS,
        seed: int = 0,
        walk: str = "learned",
        rehearsal_ticks: int | None = REHEARSAL_TICKS,
        threads: int = 1,
    ) -> None:
        self._level, self._skills = level, skills
        self._rehearsals = 0 if rehearsal_ticks == 0 else rehearsals
        self._seed, self._walk, self._rehearsal_ticks = seed, walk, rehearsal_ticks
        self._threads = Threads(threads)
        self._drivers: list[HumanDriver] = []
        self._learned: _Learned | None = None  # shared by all
        self._spare: dict[float, list[Human]] = {}
        self._unused: dict[float, HumanState] = {}

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        driver = self._make(1.0)
        driver.body.reset(place, facing)
        chance = chance_at(place, self._seed)
        driver.hesitates = round(float(chance.uniform(0.0, _HESITATES)), 2)
        driver.human.habit = float(chance.random())
        self._drivers.append(driver)
        return driver

    def revive(self, body: str, state: Any) -> Driver:
        driver = self._make(1.0)
        driver.restore(state)  # raises for one of another release, who is then not here
        self._drivers.append(driver)
        return driver

    def take_over(self, person: RecordedPerson) -> "HumanDriver | None":
        """Let physics go on from where recorded motion is; None while it cannot: with something in the hands,
        on uneven ground, or in a motion that the controllers do not know."""
        walker = person.walker
        speed, place = float(np.hypot(*walker.velocity)), person.position
        size = _simulated_size(float(person.row[at.TRAITS][SIZE]))
        root = math.sqrt(size)
        if not person.has_free_hands or walker.status == "stuck":
            return None
        pose, pose_rates = person.qpos, person.qpos_rates
        if speed <= AT_REST:
            if walker.status == "walking":
                return None  # it waits for others
            driver = self._make(size)
            driver.body.reset(place, walker.yaw)
        else:
            moment = moment_like(person.status == "running", speed / root, pose, root * pose_rates[6:])
            heading = math.atan2(walker.velocity[1], walker.velocity[0])
            off = abs(math.remainder(heading - walker.yaw, 2.0 * math.pi))
            if (
                moment is None
                or walker.status != "walking"
                or off > _ASKEW
                or not self._level_at(place, heading)
            ):
                return None
            driver = self._make(size)
            set_in_motion(driver.human, moment, pose[:2] / size, float(place[2]) / size, heading)
        driver.human.habit = float(chance_at(place, self._seed).random())
        driver.fade(pose, pose_rates)
        self._drivers.append(driver)
        return driver

    def _level_at(self, place: np.ndarray, heading: float) -> bool:
        """Whether the ground is level around ``place`` (3,) and on the first steps towards ``heading``."""
        ahead = np.array([math.cos(heading), math.sin(heading)])
        spots = place + np.zeros((_SPOTS.size * 3, 3))
        across = np.array([-ahead[1], ahead[0]])
        spots[:, :2] += (
            _SPOTS[:, None, None] * ahead + np.array([-_BESIDE, 0.0, _BESIDE])[:, None] * across
        ).reshape(-1, 2)
        spots[:, 2] += 0.5
        heights = self._level.ground.surface_below(spots)[0]
        return bool((np.abs(heights - place[2]) <= _UNEVEN).all())

    def _make(self, size: float) -> "HumanDriver":
        return HumanDriver(self, self._level, SizedHuman(self.human(size), size))

    def human(self, size: float) -> Human:
        """One of a ``size``, as good as new, who stands somewhere."""
        if self._learned is None:
            self._learned = _Learned.read(self._skills, self._walk)
        if self._spare.get(size):
            human = self._spare[size].pop()
            human.restore_state(self._unused[size])
            return human
        run, clearing, walk, between, policy = self._learned
        human = Human(
            self._level.ground_for(size), run, clearing, walk, between, self._rehearsals, gets_up=True,
            policy=policy,
        )  # fmt: skip
        human.waits = self._rehearsal_ticks is None
        human.get_ready()
        self._unused.setdefault(size, human.save_state())
        return human

    def retire(self, driver: Driver) -> None:
        """Have one less, whose body nobody holds any more: the next one gets it, as good as new."""
        assert isinstance(driver, HumanDriver)
        self.remove(driver)
        self.put_back(driver.human, driver.body.size)

    def put_back(self, human: Human, size: float) -> None:
        """Keep who is not needed any more for `human`."""
        human.bravery = None
        self._spare.setdefault(size, []).append(human)

    def remove(self, driver: Driver) -> None:
        self._drivers = [each for each in self._drivers if each is not driver]

    def in_the_way(self) -> np.ndarray:
        humans = [driver.human for driver in self._drivers]
        rows = np.empty((len(humans), 6))
        rows[:, :3], velocities = movements_of([driver.body for driver in self._drivers])
        rows[:, 3:5] = velocities[:, :2]
        rows[[each.held for each in humans], 3:5] = 0.0
        rows[:, 5] = PERSON_RULES["radius"]
        return rows

    def followers(self) -> Sequence[Follower]:
        return self._drivers

    def remember(self) -> None:
        for driver in self._drivers:
            driver.before = driver.body.glimpse()

    def change_level(self) -> None:
        self._spare, self._unused = {}, {}
        for driver in self._drivers:
            driver.human.change_ground(self._level.ground_for(driver.body.size))
            driver.plan_again()

    def change_zones(self) -> None:
        for driver in self._drivers:
            driver.plan_again()

    def tick(self) -> None:
        for driver in self._drivers:
            driver.go_on_planning()
        bodies = [driver.body for driver in self._drivers]
        humans = [body.human for body in bodies]
        allotted = None if self._rehearsal_ticks is None else allot(humans, self._rehearsal_ticks)

        def go_on(number: int) -> None:
            bodies[number].tick(since_foresees=allotted is not None)
            if allotted is not None and allotted[number]:
                humans[number].look_ahead(allotted[number])
            pause()

        self._threads.each(go_on, len(humans))


class SavedPerson(NamedTuple):
    """What is saved of a person: in its own measure, but for plans and orders; ``owed`` as of
    `SizedHuman`."""

    body: HumanState
    plans: tuple[Plan, ...]
    hesitates: float
    fading: Fading | None
    orders: OrdersState | None
    size: float
    owed: float


def _simulated_size(size: float) -> float:
    """Sizes of simulated people are in steps of 1 %: those of one share a model and the ground in their
    measure."""
    return round(size, 2)


class HumanDriver(Driver):
    """A person. ``before``: what it looked like when `People.remember` was called, or None.
    ``hesitates``: [s] after which it sets out from a stand: people told the same do not step as one.
    ``style``: its traits, those left out are the usual ones."""

    tries_other_ways = plans_in_slices = True

    def __init__(self, population: People, level: Level, body: SizedHuman) -> None:
        self._population, self._level, self.body = population, level, body
        self.radius = PERSON_RULES["radius"]
        self.figure = person_figure(body.size)
        self.events = body.human.events
        self.plans: deque[Plan] = deque(maxlen=PLANS_KEPT)
        self.before: Glimpse | None = None
        self.hesitates = 0.0
        self.style: dict[str, float] = {}
        self._fading: Fading | None = None
        self._orders = PersonOrders(level, body)
        self._former: tuple[Course | None] | None = None

    @property
    def human(self) -> Human:
        """It, in its own measure."""
        return self.body.human

    @property
    def simulated(self) -> Human:
        return self.human

    @property
    def follower(self) -> Follower:
        return self

    @property
    def time(self) -> float:
        return self.body.time

    def in_world(self, event: Event) -> Event:
        return self.body.in_world(event)

    @property
    def status(self) -> str:
        status = self.human.status
        if self._orders.planning is None or status in MOVING or status == "fallen":
            return status
        return "walking" if self.human.on_feet.walks or self.human.held else "running"

    @property
    def position(self) -> np.ndarray:
        return self.body.position

    @property
    def facing(self) -> float:
        return self.human.yaw

    @property
    def progress(self) -> float:
        if self._orders.planning is not None:
            return 0.0
        length = self.plans[-1].length if self.plans else 0.0
        return self.body.arc_length / length if length > 0.0 else 1.0

    @property
    def left(self) -> float:
        if self._orders.planning is not None:
            return self.plans[-1].length
        return self.plans[-1].length - self.body.arc_length if self.plans else 0.0

    def take_note(self) -> None:
        if self._orders.planning is not None:  # how the way that it is to leave ends is of no concern
            self.events[:] = [event for event in self.events if not isinstance(event, _ENDS)]

    @property
    def hindrance(self) -> str:
        human, ahead = self.human, self.body.obstacle_ahead
        if human.status == "getting up":
            return f"it has not got up again{self._lie}"
        if human.status == "scrambling":
            return f"it finds no hold{self._lie}"
        if human.pace < 1.0:
            return "others are in its way"
        if human.follower.interrupted is not None:
            return "it goes back for another run-up" if ahead else "it goes back to let others by"
        if ahead is not None:
            return f"it finds no run-up to the {ahead.affordance} of {ahead.size:.2f} m"
        return f"it makes no headway{self._lie}"

    @property
    def _lie(self) -> str:
        """Where the ground under it is steep, how steep it is."""
        degrees = np.degrees(np.arctan(self.human.slope_here))
        return f" on ground of {degrees:.0f} degrees" if degrees >= _STEEP else ""

    @property
    def can_turn(self) -> bool:
        """Not one that waits for others, or lies on the ground."""
        return self.human.pace >= 1.0 and self.human.status in ("walking", "running", "scrambling")

    @property
    def tag_ahead(self) -> str:
        obstacles, ahead = self._level.graph.obstacles, self.body.obstacle_ahead
        if ahead is None:
            return ""
        links = self._level.graph.links
        away = np.linalg.norm(links.edge[:, :2] - ahead.position[:2], axis=1)
        away[links.affordance != ahead.affordance] = np.inf
        return str(obstacles.tag[links.obstacle[np.argmin(away)]]) if len(away) else ""

    @property
    def beside_path(self) -> float:
        return abs(self.body.lateral_error)

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]:
        return self.body.ranges

    @property
    def ground(self) -> Ground | None:
        return self._level.ground

    def heed(self, bravery: float | None) -> None:
        try:
            if bravery is not None:
                load_preconditions()  # here, lest a tick has to, or finds them out of date
            self.human.bravery = bravery
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None

    def set_style(self, traits: Mapping[str, float]) -> None:
        try:
            row = by_hand(None, **{**self.style, **traits})
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None
        size = _simulated_size(float(row[SIZE]))
        if size != self.body.size:
            self._resize(size)
        self.style |= traits
        self.human.wear(row)

    def _resize(self, size: float) -> None:
        """Go on as a person of another size. Raises `RuntimeInputError` unless it stands."""
        if self.status in MOVING or not self.on_its_feet:
            raise RuntimeInputError(
                f"it is {self.status}; while it is simulated its size can change only where it stands"
            )
        place, facing, time, habit = self.position, self.facing, self.time, self.human.habit
        self._exchange(size)
        self.body.reset(place, facing)
        self.human.habit = habit
        self.human.ticks = self.human.ended_at = round(time / self.body.tick_seconds)

    def _exchange(self, size: float) -> None:
        """Go on with the body of a person of another size, wherever that stands."""
        before = self.human
        human = self._population.human(size)
        human.events, before.events = before.events, []  # its agent keeps the list
        human.bravery = before.bravery
        self._population.put_back(before, self.body.size)
        self.body.become(human, size)
        self.figure, self.before = person_figure(size), None

    @property
    def traits(self) -> Mapping[str, float]:
        return self.style

    def odds(self, obstacle: int | str) -> float:
        try:
            return odds_at(self.body, self._level.graph, obstacle, self.tag_ahead)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None

    def held_in(self, posture: str) -> tuple[str, str]:
        return can_hold(person_postures(), posture, self.held)

    def check_posture(self, posture: str, held: str, state: str) -> None:
        try:
            checked_node(person_postures(), posture, held, state)
        except LocomotionError as error:
            raise RuntimeInputError(str(error)) from None

    def take(self, posture: str, held: str, state: str) -> None:
        self.human.stop()
        self.events.append(PostureReached(self.human.time, self.human.point, posture, ""))

    @property
    def on_its_feet(self) -> bool:
        """Whether it stands, walks or runs, and nothing else."""
        human = self.human
        return not human.fours.active and human.status not in (*CLEARING.values(), "fallen", "getting up")

    def drawn(self) -> tuple[np.ndarray, np.ndarray]:
        """The pose (46,) in which it is drawn, and how fast that changes (45,), as `fading.rates`."""
        pose, now = self.body.pose(), self.body.rates()
        if self._fading is None:
            return pose, now
        before, after = self._faded(pose, -0.5 * CONTROL_DT), self._faded(pose, 0.5 * CONTROL_DT)
        return self._faded(pose, 0.0), now + rates(before, after, CONTROL_DT)

    def fade(self, pose: np.ndarray, pose_rates: np.ndarray) -> None:
        """Let it look as if it came from ``pose`` (46,), which changed by ``pose_rates`` (45,)."""
        self._fading = None
        offsets, offset_rates, seconds = fade_from(pose, pose_rates, *self.drawn())
        self._fading = Fading(offsets, offset_rates, seconds, self.time)

    def _faded(self, pose: np.ndarray, ahead: float) -> np.ndarray:
        fading = self._fading
        if fading is None:
            return pose
        elapsed = self.time - fading.since + ahead
        if elapsed >= fading.seconds:
            return pose
        return faded(pose, fading.offsets, fading.rates, fading.seconds, max(elapsed, 0.0))

    @property
    def joints(self) -> Joints:
        return person_joints(self.body.size)

    def joint_pose(self) -> np.ndarray:
        return self._faded(self.body.pose(), 0.0)

    def transforms(self) -> np.ndarray:
        return self.body.transforms(self.joint_pose(), len(self.figure.bodies))

    def transforms_between(self, share: float) -> np.ndarray:
        if self.before is None:
            return self.transforms()
        pose = self.body.mixed(self.body.pose(self.before), self.body.pose(), share)
        return self.body.transforms(self._faded(pose, (share - 1.0) * CONTROL_DT), len(self.figure.bodies))

    def plan(self, goals: np.ndarray) -> Plan:
        return self._orders.planned(self._orders.told(goals, 1.0)).finish()

    def go_to(self, goals: np.ndarray, speed: float, facing: float | None) -> Plan:
        if facing is not None:
            raise RuntimeInputError("a human cannot turn to a facing at its goal yet; leave it out")
        if self.human.status == "fallen":
            raise RuntimeInputError("it has fallen and cannot go anywhere")
        return self._begin(self._orders.told(goals, speed))

    def go_without(self, goals: np.ndarray, speed: float, closed: Sequence[str]) -> Plan:
        return self._begin(self._orders.told(goals, speed, closed=closed))

    def go_round(
        self, goals: np.ndarray, speed: float, closed: tuple[str, ...]
    ) -> tuple[Plan, tuple[str, ...]]:
        ahead = self.tag_ahead
        choices = [(False, closed), (True, closed)]
        if ahead:
            choices.insert(1, (True, (*closed, ahead)))
        for number, (skilled, tags) in enumerate(choices, start=1):
            try:
                return self._begin(self._orders.told(goals, speed, skilled, tags)), tags
            except NoWay:
                if number == len(choices):
                    raise
        raise AssertionError

    def _begin(self, order: Order) -> Plan:
        """Begin to plan ``order`` in the next tick; return the plan without smoothing."""
        plan = self._orders.give(order)
        self.plans.append(plan)
        if plan.length <= ARRIVED and not order.moves:
            self._orders.drop()
            self.human.arrive()
        return plan

    def go_on_planning(self) -> None:
        """Before each tick: plan what it has been told, and take the path if it is there."""
        try:
            planning = self._orders.go_on()
        except NoWay as error:
            self._orders.drop()
            self.human.give_up(error.reason)
            return
        if planning is None:
            return
        if self.human.status == "fallen":
            self._orders.drop()
            return
        plan = planning.finish()
        self._former = (self.body.course(),)
        if plan.length > ARRIVED:
            hesitates = max(self.hesitates - planning.ticks * CONTROL_DT, 0.0)
            self.body.follow(plan.points, planning.order.speed, plan.obstacles, hesitates)
        else:
            self.human.arrive()
        if self._orders.planning is None:
            self.plans[-1] = plan

    def plan_again(self) -> None:
        """Plan its order again: the level has changed."""
        self._orders.change_level()

    def sets_out(self) -> tuple[Course | None] | None:
        former, self._former = self._former, None
        return former

    @property
    def goals_left(self) -> int:
        if self._orders.planning is not None:
            return len(self._orders.goals)
        return max(sum(end > self.body.arc_length for end in self.plans[-1].ends), 1)

    def way_holds(self) -> bool:
        if self._orders.planning is not None:
            return True  # it was found on the present level
        return way_holds(self._level.graph, self.plans[-1], self.radius, self.body.arc_length)

    def stop(self) -> None:
        self._orders.drop()
        self.human.stop()

    @property
    def pace(self) -> float:
        return self.human.pace

    @property
    def reach(self) -> float:
        return 0.0

    def course(self) -> Course | None:
        return self.body.course()

    def foretold(self) -> np.ndarray | None:
        course = self.body.prospect()
        return None if course is None else foretold_on(course, course.points, course.pace, 1)

    def give_way(self, pace: float, shift: np.ndarray | None) -> None:
        self.body.give_way(pace, shift)
        if shift is not None and self._orders.planning is None:
            self.plans[-1] = replace(self.plans[-1], points=self.body.path)

    @property
    def waited(self) -> float | None:
        return self.body.waited if self.human.status in MOVING else None

    def way_back(self) -> np.ndarray | None:
        return self.body.way_back() if self.human.status == "walking" else None

    @property
    def backs(self) -> float:
        return self.body.backs

    @property
    def length(self) -> float:
        return 0.0

    def make_room(self, far: float) -> None:
        self.body.make_room(far)

    def give_up(self, reason: str | None = None) -> None:
        self._orders.drop()
        if reason is None:
            self.human.give_up()
        else:
            self.human.give_up(reason)

    def end_in(self, ahead: float) -> None:
        course, count = self.body.course(), round(ahead / SPACING) + 1
        if course is None or min(count, len(course.points)) < 2:
            self.human.arrive()
            return
        points = course.points[:count]
        self.body.follow(points, float(course.speeds.max()))
        if self._orders.planning is None:
            self.plans[-1] = replace(self.plans[-1], points=points, obstacles=(), ends=(ahead,))

    def save(self) -> SavedPerson:
        return SavedPerson(
            self.human.save_state(), tuple(self.plans)[-1:], self.hesitates, self._fading,
            self._orders.save(), self.body.size, self.body.owed,
        )  # fmt: skip

    def fits(self, state: Any) -> bool:
        return isinstance(state, SavedPerson)

    def restore(self, state: Any) -> None:
        if not isinstance(state, SavedPerson):
            raise RuntimeInputError("no person's state is saved")
        hesitates, fading, orders = state.hesitates, state.fading, state.orders
        if not (is_finite(hesitates) and hesitates >= 0.0):
            raise RuntimeInputError(f"a person hesitates for some seconds, not {hesitates!r}")
        body, plans = saved_parts((state.body, state.plans), HumanState)
        _, least, most = TRAITS["size"]
        check_number("the size of a person", state.size, least, most)
        check_number("what a person is behind its world", state.owed, 0.0, 1.0)
        if fading is not None:
            check_array("what fades of a person's pose", fading.offsets, 45)
            check_array("how fast a person's pose fades", fading.rates, 45)
            check_number("how long a person's pose fades", fading.seconds, 1e-3, 10.0)
        if state.size != self.body.size:
            self._exchange(state.size)
        check_person(body, self.human)
        self.human.restore_state(body)
        self.body.become(self.human, state.size, state.owed)
        self._orders.restore(orders)
        self._former = None
        recall(self.plans, plans)
        self.hesitates, self._fading = hesitates, fading
        self.before, self.style = None, {}

    def state_hash(self) -> str:
        own, orders = self.human.state_hash(), self._orders.save()
        if self.body.size != 1.0:
            own = f"{own} {self.body.size!r} {self.body.owed!r}"
        if orders is None:
            return own
        return hashlib.sha256(own.encode() + orders.content()).hexdigest()
