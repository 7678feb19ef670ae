"""Simulated persons in a world, each with a simulation of its own."""

import hashlib
import math
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import mujoco
import numpy as np

from locomotion import MOVING, PERSON_RULES, Ground, Human, HumanState, LocomotionError, load_run_skill
from locomotion.avoidance.yielding import SPACING, Course
from locomotion.body.person import CONTROL_DT
from locomotion.body.traits import by_hand
from locomotion.body_events import Arrived, GotStuck, MissedGoal, PostureReached, StrayedFromPath
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
from locomotion.human.simulation import movements
from locomotion.postures.step_order import AT_REST
from locomotion.preconditions.precondition import load_preconditions
from locomotion.recorded_people.fading import fade_from, faded, rates
from locomotion.recorded_people.nodes import can_hold, checked_node
from locomotion.recorded_people.people import person_postures
from locomotion.recorded_people.person import RecordedPerson
from locomotion.rehearsal.choices import REHEARSALS
from locomotion.rehearsal.sharing import REHEARSAL_TICKS, allot
from locomotion.saved_arrays import check_array, check_number
from locomotion.skills.interface import ClearingSkill, skill_ranges
from locomotion.skills.library import learned_skills
from locomotion.skills.registry import CLEARING
from runtime.bodies.figure import Figure, Joints
from runtime.bodies.joints import person_joints
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

__all__ = ["HumanDriver", "People", "chance_at"]

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
    """How a person is drawn beside its simulated pose since ``tick``: see
    `locomotion.recorded_people.fading`."""

    offsets: np.ndarray
    rates: np.ndarray
    seconds: float
    tick: int


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
        self._spare: list[Human] = []
        self._unused: HumanState | None = None

    def spawn(self, body: str, place: np.ndarray, facing: float, radius: float) -> Driver:
        driver = self._make()
        driver.human.reset(place, facing)
        chance = chance_at(place, self._seed)
        driver.hesitates = round(float(chance.uniform(0.0, _HESITATES)), 2)
        driver.human.habit = float(chance.random())
        self._drivers.append(driver)
        return driver

    def revive(self, body: str, state: Any) -> Driver:
        driver = self._make()
        driver.restore(state)  # raises for one of another release, who is then not here
        self._drivers.append(driver)
        return driver

    def take_over(self, person: RecordedPerson) -> "HumanDriver | None":
        """Let physics go on from where recorded motion is; None while it cannot: with something in the hands,
        on uneven ground, or in a motion that the controllers do not know."""
        walker = person.walker
        speed, place = float(np.hypot(*walker.velocity)), person.position
        if not person.has_free_hands or walker.status == "stuck":
            return None
        pose, pose_rates = person.qpos, person.qpos_rates
        if speed <= AT_REST:
            if walker.status == "walking":
                return None  # it waits for others
            driver = self._make()
            driver.human.reset(place, walker.yaw)
        else:
            moment = moment_like(person.status == "running", speed, pose, pose_rates[6:])
            heading = math.atan2(walker.velocity[1], walker.velocity[0])
            off = abs(math.remainder(heading - walker.yaw, 2.0 * math.pi))
            if (
                moment is None
                or walker.status != "walking"
                or off > _ASKEW
                or not self._level_at(place, heading)
            ):
                return None
            driver = self._make()
            set_in_motion(driver.human, moment, pose[:2], float(place[2]), heading)
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

    def _make(self) -> "HumanDriver":
        if self._learned is None:
            self._learned = _Learned.read(self._skills, self._walk)
        run, clearing, walk, between, policy = self._learned
        if self._spare and self._unused is not None:
            human = self._spare.pop()
            human.restore_state(self._unused)
            return HumanDriver(self._level, human)
        human = Human(
            self._level.ground, run, clearing, walk, between, self._rehearsals, gets_up=True, policy=policy
        )
        human.waits = self._rehearsal_ticks is None
        human.get_ready()
        self._unused = self._unused or human.save_state()
        return HumanDriver(self._level, human)

    def retire(self, driver: Driver) -> None:
        """Have one less, whose body nobody holds any more: the next one gets it, as good as new."""
        assert isinstance(driver, HumanDriver)
        self.remove(driver)
        driver.human.bravery = None
        self._spare.append(driver.human)

    def remove(self, driver: Driver) -> None:
        self._drivers = [each for each in self._drivers if each is not driver]

    def in_the_way(self) -> np.ndarray:
        humans = [driver.human for driver in self._drivers]
        rows = np.empty((len(humans), 6))
        rows[:, :3], velocities = movements([each.simulation for each in humans])
        rows[:, 3:5] = velocities[:, :2]
        rows[[each.held for each in humans], 3:5] = 0.0
        rows[:, 5] = PERSON_RULES["radius"]
        return rows

    def followers(self) -> Sequence[Follower]:
        return self._drivers

    def remember(self) -> None:
        for driver in self._drivers:
            driver.before = driver.human.qpos, driver.human.idles_for

    def change_level(self) -> None:
        self._spare, self._unused = [], None
        for driver in self._drivers:
            driver.human.change_ground(self._level.ground)
            driver.plan_again()

    def change_zones(self) -> None:
        for driver in self._drivers:
            driver.plan_again()

    def tick(self) -> None:
        for driver in self._drivers:
            driver.go_on_planning()
        humans = [driver.human for driver in self._drivers]
        allotted = None if self._rehearsal_ticks is None else allot(humans, self._rehearsal_ticks)

        def go_on(number: int) -> None:
            humans[number].tick(since_foresees=allotted is not None)
            if allotted is not None and allotted[number]:
                humans[number].look_ahead(allotted[number])
            pause()

        self._threads.each(go_on, len(humans))


class HumanDriver(Driver):
    """A person. ``before``: its joints (46,) as they were when `People.remember` was called, and for how long
    [s] it had stood then; or None.
    ``hesitates``: [s] after which it sets out from a stand: people told the same do not step as one.
    ``style``: its traits, those left out are the usual ones."""

    tries_other_ways = plans_in_slices = True

    def __init__(self, level: Level, human: Human) -> None:
        self._level, self.human = level, human
        self.radius = PERSON_RULES["radius"]
        self.figure = Figure.from_model(human.model)
        self.events = human.events
        self.plans: deque[Plan] = deque(maxlen=PLANS_KEPT)
        self.before: tuple[np.ndarray, float] | None = None
        self.hesitates = 0.0
        self.style: dict[str, float] = {}
        self._fading: Fading | None = None
        self._orders = PersonOrders(level, human)
        self._former: tuple[Course | None] | None = None

    @property
    def simulated(self) -> Human:
        return self.human

    @property
    def follower(self) -> Follower:
        return self

    @property
    def time(self) -> float:
        return self.human.time

    @property
    def status(self) -> str:
        status = self.human.status
        if self._orders.planning is None or status in MOVING or status == "fallen":
            return status
        return "walking" if self.human.on_feet.walks or self.human.held else "running"

    @property
    def position(self) -> np.ndarray:
        return self.human.position

    @property
    def facing(self) -> float:
        return self.human.yaw

    @property
    def progress(self) -> float:
        if self._orders.planning is not None:
            return 0.0
        length = self.plans[-1].length if self.plans else 0.0
        return self.human.arc_length / length if length > 0.0 else 1.0

    @property
    def left(self) -> float:
        if self._orders.planning is not None:
            return self.plans[-1].length
        return self.plans[-1].length - self.human.arc_length if self.plans else 0.0

    def take_note(self) -> None:
        if self._orders.planning is not None:  # how the way that it is to leave ends is of no concern
            self.events[:] = [event for event in self.events if not isinstance(event, _ENDS)]

    @property
    def hindrance(self) -> str:
        human, ahead = self.human, self.human.obstacle_ahead
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
        obstacles, ahead = self._level.graph.obstacles, self.human.obstacle_ahead
        if ahead is None:
            return ""
        links = self._level.graph.links
        away = np.linalg.norm(links.edge[:, :2] - ahead.position[:2], axis=1)
        away[links.affordance != ahead.affordance] = np.inf
        return str(obstacles.tag[links.obstacle[np.argmin(away)]]) if len(away) else ""

    @property
    def beside_path(self) -> float:
        return abs(self.human.lateral_error)

    @property
    def skills(self) -> Mapping[str, tuple[float, float]]:
        return skill_ranges(self.human.clearing)

    @property
    def ground(self) -> Ground | None:
        return self.human.ground

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
        self.style |= traits
        self.human.wear(row)

    @property
    def traits(self) -> Mapping[str, float]:
        return self.style

    def odds(self, obstacle: int | str) -> float:
        try:
            return odds_at(self.human, self._level.graph, obstacle, self.tag_ahead)
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
        self.human.events.append(PostureReached(self.human.time, self.human.point, posture, ""))

    @property
    def on_its_feet(self) -> bool:
        """Whether it stands, walks or runs, and nothing else."""
        human = self.human
        return not human.fours.active and human.status not in (*CLEARING.values(), "fallen", "getting up")

    def drawn(self) -> tuple[np.ndarray, np.ndarray]:
        """The pose (46,) in which it is drawn, and how fast that changes (45,), as `fading.rates`."""
        qvel, pose = self.human.data.qvel, self.human.pose()
        turning = np.zeros(3)
        mujoco.mju_rotVecQuat(turning, qvel[3:6], pose[3:7])
        now = np.concatenate([qvel[:3], turning, qvel[6:45]])
        if self.human.held:
            now[:] = 0.0
        if self._fading is None:
            return pose, now
        before, after = self._faded(pose, -0.5 * CONTROL_DT), self._faded(pose, 0.5 * CONTROL_DT)
        return self._faded(pose, 0.0), now + rates(before, after, CONTROL_DT)

    def fade(self, pose: np.ndarray, pose_rates: np.ndarray) -> None:
        """Let it look as if it came from ``pose`` (46,), which changed by ``pose_rates`` (45,)."""
        self._fading = None
        offsets, offset_rates, seconds = fade_from(pose, pose_rates, *self.drawn())
        self._fading = Fading(offsets, offset_rates, seconds, self.human.ticks)

    def _faded(self, pose: np.ndarray, ahead: float) -> np.ndarray:
        fading = self._fading
        if fading is None:
            return pose
        elapsed = (self.human.ticks - fading.tick) * CONTROL_DT + ahead
        if elapsed >= fading.seconds:
            return pose
        return faded(pose, fading.offsets, fading.rates, fading.seconds, max(elapsed, 0.0))

    @property
    def joints(self) -> Joints:
        return person_joints()

    def joint_pose(self) -> np.ndarray:
        return self._faded(self.human.pose(), 0.0)

    def transforms(self) -> np.ndarray:
        return self._transforms_of(self.joint_pose())

    def _transforms_of(self, pose: np.ndarray) -> np.ndarray:
        joints = self.human.data.qpos
        now = joints.copy()
        joints[:] = pose
        transforms = self.human.body_transforms()[1 : 1 + len(self.figure.bodies)]
        joints[:] = now
        return transforms

    def transforms_between(self, share: float) -> np.ndarray:
        if self.before is None:
            return self.transforms()
        model, now = self.human.model, self.human.pose()
        qpos, idled_for = self.before
        pose, change = self.human.shown(qpos.copy(), idled_for), np.empty(model.nv)
        mujoco.mj_differentiatePos(model, change, 1.0, pose, now)
        mujoco.mj_integratePos(model, pose, change, share)
        return self._transforms_of(self._faded(pose, (share - 1.0) * CONTROL_DT))

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
        self._former = (self.human.course(),)
        if plan.length > ARRIVED:
            hesitates = max(self.hesitates - planning.ticks * CONTROL_DT, 0.0)
            self.human.follow(plan.points, planning.order.speed, plan.obstacles, hesitates)
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
        return max(sum(end > self.human.arc_length for end in self.plans[-1].ends), 1)

    def way_holds(self) -> bool:
        if self._orders.planning is not None:
            return True  # it was found on the present level
        return way_holds(self._level.graph, self.plans[-1], self.radius, self.human.arc_length)

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
        return self.human.course()

    def foretold(self) -> np.ndarray | None:
        course = self.human.prospect()
        return None if course is None else foretold_on(course, course.points, course.pace, 1)

    def give_way(self, pace: float, shift: np.ndarray | None) -> None:
        self.human.give_way(pace, shift)
        if shift is not None and self._orders.planning is None:
            self.plans[-1] = replace(self.plans[-1], points=self.human.path)

    @property
    def waited(self) -> float | None:
        return self.human.follower.waited if self.human.status in MOVING else None

    def way_back(self) -> np.ndarray | None:
        return self.human.way_back() if self.human.status == "walking" else None

    @property
    def backs(self) -> float:
        return self.human.follower.backs

    @property
    def length(self) -> float:
        return 0.0

    def make_room(self, far: float) -> None:
        self.human.follower.make_room(far, self.human.on_feet.walk_limits, self.human.ticks)

    def give_up(self, reason: str | None = None) -> None:
        self._orders.drop()
        if reason is None:
            self.human.give_up()
        else:
            self.human.give_up(reason)

    def end_in(self, ahead: float) -> None:
        course, count = self.human.course(), round(ahead / SPACING) + 1
        if course is None or min(count, len(course.points)) < 2:
            self.human.arrive()
            return
        points = course.points[:count]
        self.human.follow(points, float(course.speeds.max()))
        if self._orders.planning is None:
            self.plans[-1] = replace(self.plans[-1], points=points, obstacles=(), ends=(ahead,))

    def save(self) -> tuple[HumanState, tuple[Plan, ...], float, Fading | None, OrdersState | None]:
        return (
            self.human.save_state(), tuple(self.plans)[-1:], self.hesitates, self._fading, self._orders.save()
        )  # fmt: skip

    def fits(self, state: Any) -> bool:
        return isinstance(state, tuple) and any(isinstance(part, HumanState) for part in state)

    def restore(self, state: Any) -> None:
        *parts, hesitates, fading, orders = (
            state if isinstance(state, tuple) and len(state) == 5 else (math.nan, None, None)
        )
        if not (is_finite(hesitates) and hesitates >= 0.0):
            raise RuntimeInputError("expected a person's state, its plans, and how long it hesitates [s]")
        body, plans = saved_parts(tuple(parts), HumanState)
        if fading is not None:
            check_array("what fades of a person's pose", fading.offsets, 45)
            check_array("how fast a person's pose fades", fading.rates, 45)
            check_number("how long a person's pose fades", fading.seconds, 1e-3, 10.0)
        check_person(body, self.human)
        self.human.restore_state(body)
        self._orders.restore(orders)
        self._former = None
        recall(self.plans, plans)
        self.hesitates, self._fading = hesitates, fading
        self.before, self.style = None, {}

    def state_hash(self) -> str:
        own, orders = self.human.state_hash(), self._orders.save()
        if orders is None:
            return own
        return hashlib.sha256(own.encode() + orders.content()).hexdigest()
