"""One simulated person in a world."""

import hashlib
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from locomotion import MOVING, PERSON_RULES, Ground, Human, HumanState, LocomotionError
from locomotion.avoidance.yielding import SPACING, Course
from locomotion.body.person import CONTROL_DT
from locomotion.body.traits import SIZE, TRAITS, by_hand
from locomotion.body_events import Arrived, Event, GotStuck, MissedGoal, PostureReached, StrayedFromPath
from locomotion.human.saved_state_check import check_person
from locomotion.human.sized_human import SizedHuman
from locomotion.preconditions.precondition import load_preconditions
from locomotion.recorded_people.nodes import can_hold, checked_node
from locomotion.recorded_people.people import person_postures
from locomotion.saved_arrays import check_number
from locomotion.skills.registry import CLEARING
from runtime.bodies.figure import Joints
from runtime.bodies.human_look import Fading, HumanLook
from runtime.bodies.human_pool import HumanPool
from runtime.bodies.joints import person_figure, person_joints
from runtime.bodies.obstacle_odds import odds_at
from runtime.bodies.person_orders import ARRIVED, Order, OrdersState, PersonOrders
from runtime.bodies.protocol import PLANS_KEPT, Driver, Follower, recall, saved_parts
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.planning.planning import NoWay, Plan, way_holds
from runtime.traffic.snapshot import foretold_on
from surefoot.numeric import is_finite

__all__ = ["HumanDriver", "SavedPerson", "simulated_size"]

_STEEP = 20.0  # [degrees] of ground that is worth mentioning
_ENDS = Arrived, GotStuck, MissedGoal, StrayedFromPath


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


def simulated_size(size: float) -> float:
    """Sizes of simulated people are in steps of 1 %: those of one share a model and the ground in their
    measure."""
    return round(size, 2)


class HumanDriver(Driver):
    """A person. ``body``: it, in the world's measure; ``look``: how it is seen.
    ``hesitates``: [s] after which it sets out from a stand: people told the same do not step as one.
    ``style``: its traits, those left out are the usual ones."""

    tries_other_ways = plans_in_slices = True

    def __init__(self, pool: HumanPool, level: Level, body: SizedHuman) -> None:
        self._pool, self._level, self.body = pool, level, body
        self.radius = PERSON_RULES["radius"]
        self.figure, self.look = person_figure(body.size), HumanLook(body)
        self.events = body.human.events
        self.plans: deque[Plan] = deque(maxlen=PLANS_KEPT)
        self.hesitates = 0.0
        self.style: dict[str, float] = {}
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
        size = simulated_size(float(row[SIZE]))
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
        self._exchange(self._pool.take(size), size)
        self.body.reset(place, facing)
        self.human.habit = habit
        self.human.ticks = self.human.ended_at = round(time / self.body.tick_seconds)

    def _exchange(self, human: Human, size: float) -> None:
        """Go on with the body of a ``human`` of another size, wherever that stands."""
        before = self.human
        human.events, before.events = before.events, []  # its agent keeps the list
        human.bravery = before.bravery
        self._pool.put_back(before, self.body.size)
        self.body.become(human, size)
        self.figure, self.look.before = person_figure(size), None

    @property
    def traits(self) -> Mapping[str, float]:
        return self.style

    def push(self, force: np.ndarray, seconds: float) -> None:
        self.body.push(force, seconds)

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

    @property
    def joints(self) -> Joints:
        return person_joints(self.body.size)

    def joint_pose(self) -> np.ndarray:
        return self.look.pose()

    def transforms(self) -> np.ndarray:
        return self.body.transforms(self.joint_pose(), len(self.figure.bodies))

    def transforms_between(self, share: float) -> np.ndarray:
        return self.body.transforms(self.look.pose_between(share), len(self.figure.bodies))

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
            self.human.save_state(), tuple(self.plans)[-1:], self.hesitates, self.look.fading,
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
            fading.check()
        human = self.human if state.size == self.body.size else self._pool.take(state.size)
        check_person(body, human)
        if human is not self.human:
            self._exchange(human, state.size)
        self.human.restore_state(body)
        self.body.become(self.human, state.size, state.owed)
        self._orders.restore(orders)
        self._former = None
        recall(self.plans, plans)
        self.hesitates, self.style = hesitates, {}
        self.look.before, self.look.fading = None, fading

    def state_hash(self) -> str:
        own, orders = self.human.state_hash(), self._orders.save()
        if self.body.size != 1.0:
            own = f"{own} {self.body.size!r} {self.body.owed!r}"
        if orders is None:
            return own
        return hashlib.sha256(own.encode() + orders.content()).hexdigest()
