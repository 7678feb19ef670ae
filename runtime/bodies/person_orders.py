"""What a person has been told, and its path for that, which is planned in slices.

The routes are found at once, so it is known at once whether there is a way. They are smoothed in the ticks
that follow. Meanwhile a person at rest stands, and a moving one keeps to its former way, for less than half a
metre.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from typing import NamedTuple

import numpy as np

import navmesh
from locomotion.errors import LocomotionError
from locomotion.gaits.limits import PERSON_RULES
from locomotion.human.sized_human import SizedHuman
from locomotion.human.state import CLEARING
from locomotion.paths.departures import can_begin, leads
from locomotion.paths.run_up_room import cramped_links
from locomotion.paths.table import TrackingLimits
from locomotion.saved_arrays import check_array, check_number
from runtime.bodies.obstacle_odds import link_prices
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.planning.planning import Beginning, NoWay, Plan, Way, find_way, pulled_plan, smoothing_way
from surefoot.numeric import is_whole
from surefoot.slices import Slices

__all__ = ["ARRIVED", "Order", "OrdersState", "PersonOrders", "Planning"]

ARRIVED = 1e-3
"""[m] long ways lead to where it is: one that moves has to come back there."""
_SLICE = 20_000
"""Work in a tick: iterations of the solver times waypoints, some 0.7 ms."""
_PIECE = 3_000  # work around each piece
_MOVES = 0.5  # [m/s] from which a body cannot turn at once
_PATIENCE = 20  # ticks without a path after which a new order waits for that of the one before
_ASTRAY = 1.5  # [m] from where it was told from which its path would begin too far away
_LONGEST = 10_000  # ticks of planning that a saved state may tell of


class Order(NamedTuple):
    """What a person was told, and how it moved then.

    ``goals`` (k, 3) [m]. ``speed`` [m/s]. ``skilled``: whether its way may lead over obstacles; ``closed``:
    tags of those over which it may not. ``place`` (3,) [m], ``velocity`` (2,) [m/s]; ``walks``: whether it
    walked or stood, ``clears``: whether it was over an obstacle. ``by_odds``: whether the odds of obstacles
    count, as of `Human.by_odds`.
    """

    goals: np.ndarray
    speed: float
    skilled: bool
    closed: tuple[str, ...]
    place: np.ndarray
    velocity: np.ndarray
    walks: bool
    clears: bool
    by_odds: bool

    @property
    def moves(self) -> bool:
        """Whether it moved too fast to turn at once."""
        return bool(np.linalg.norm(self.velocity) > _MOVES)

    def check(self) -> None:
        """Raises `LocomotionError` for an order that nobody can have been given."""
        check_array("the goals of an order", self.goals, None, 3, least=1)
        check_array("the place of an order", self.place, 3)
        check_array("the velocity of an order", self.velocity, 2)
        check_number("the speed of an order", self.speed, 1e-9)
        if self.speed <= 0.0:
            raise LocomotionError(f"the speed of an order is {self.speed}")


class Planning:
    """The planning of an order.

    Attributes:
      order: what is planned. pulled: the plan without smoothing, known at once. plan: the finished one, None
        before. ticks: how many slices were made.
    """

    def __init__(
        self,
        graph: navmesh.NodeGraph,
        order: Order,
        skills: Mapping[str, tuple[float, float]],
        limits: TrackingLimits,
        prices: np.ndarray | None = None,
    ) -> None:
        """``skills``, ``limits`` (of running): of the person. ``prices`` (l,) [m]: of the graph's links, on
        top of what they cost. Raises `NoWay`."""
        self.order, self.ticks = order, 0
        self.plan: Plan | None = None
        self._graph, self._limits, self._spent = graph, limits, 0
        self._find = partial(
            find_way,
            graph,
            goals=list(order.goals),
            radius=PERSON_RULES["radius"],
            skills=skills if order.skilled else {},
            link_costs=_link_costs(graph, order.closed, prices),
        )
        way: Way | NoWay
        try:
            way = self._find(Beginning(order.place, order.velocity if order.moves else None))
        except NoWay as error:
            if not order.moves:
                raise
            way = error  # it may fit where it comes to, or have to come back
        self._work = self._planned(way)
        if isinstance(way, Way):
            self.pulled = pulled_plan(way)
        else:
            self.pulled = self.finish()

    def go_on(self) -> None:
        """Plan for a tick. Raises `NoWay`."""
        self.ticks += 1
        self._spent -= _SLICE
        while self.plan is None and self._spent <= 0:
            self._advance()

    def finish(self) -> Plan:
        """Plan all that is left, and return the plan. Raises `NoWay`."""
        while self.plan is None:
            self._advance()
        return self.plan

    def _advance(self) -> None:
        try:
            self._spent += next(self._work) + _PIECE
        except StopIteration as end:
            self.plan = end.value

    def _planned(self, way: Way | NoWay) -> Slices[Plan]:
        order, plan = self.order, None
        if isinstance(way, Way):
            plan = yield from smoothing_way(way)
            if not order.moves:
                return plan
            if plan.length > ARRIVED and (
                order.walks or can_begin(plan.points, order.velocity, self._limits)
            ):
                return plan
        target = order.goals[0] if plan is None else plan.pulled[1]
        for lead, runs_on in self._leads(target):
            direction = lead[-1, :2] - lead[-2, :2] if runs_on else None
            try:
                led = yield from smoothing_way(self._find(Beginning(lead[-1], direction, lead)))
            except NoWay:
                continue
            if not runs_on or can_begin(led.points, order.velocity, self._limits):
                return led
        if isinstance(way, NoWay):
            raise way
        assert plan is not None
        return plan

    def _leads(self, target: np.ndarray) -> Iterator[tuple[np.ndarray, bool]]:
        order, radius = self.order, PERSON_RULES["radius"]
        return leads(self._graph, order.place, order.velocity, target, self._limits, radius)


def _link_costs(
    graph: navmesh.NodeGraph, closed: tuple[str, ...], prices: np.ndarray | None
) -> np.ndarray | None:
    """(l,) [m]: ``prices``, or 0; inf for links over obstacles of the tags ``closed``, and for those without
    room for a run-up. None if all are 0."""
    costs = np.zeros(len(graph.links)) if prices is None else prices.copy()
    costs[cramped_links(graph, PERSON_RULES["radius"])] = np.inf
    if closed:
        costs[np.isin(graph.obstacles.tag[graph.links.obstacle], list(closed))] = np.inf
    return costs if costs.any() else None


class OrdersState(NamedTuple):
    """``order`` and for how many ``ticks`` it has been planned; ``since``: the tick in which it had a path
    for all orders last; ``later``: the order that comes next; ``again``: whether it is planned for the second
    time."""

    order: Order
    ticks: int
    since: int
    later: Order | None
    again: bool

    def content(self) -> bytes:
        """All of it, equal for equal orders."""
        orders = [self.order] if self.later is None else [self.order, self.later]
        arrays = [array.tobytes() for each in orders for array in (each.goals, each.place, each.velocity)]
        plain = [
            (each.speed, each.skilled, each.closed, each.walks, each.clears, each.by_odds) for each in orders
        ]
        return b"".join(arrays) + repr((plain, self.ticks, self.since, self.again)).encode()


class PersonOrders:
    """The orders of the person ``body``. ``planning``: of the present one, None without one."""

    def __init__(self, level: Level, body: SizedHuman) -> None:
        self._level, self._body = level, body
        self.planning: Planning | None = None
        self._since, self._later, self._again = 0, None, False

    @property
    def goals(self) -> np.ndarray:
        """(k, 3) [m] of the last order, while it has no path for it."""
        assert self.planning is not None
        return (self._later or self.planning.order).goals

    def told(
        self, goals: np.ndarray, speed: float, skilled: bool = True, closed: Sequence[str] = ()
    ) -> Order:
        """The order to go through ``goals`` at ``speed`` [m/s], given now."""
        body, human = self._body, self._body.human
        return Order(
            goals, speed, skilled, tuple(closed), body.position, body.velocity[:2].copy(),
            human.on_feet.walks, human.status in CLEARING.values(),
            human.by_odds,
        )  # fmt: skip

    def planned(self, order: Order) -> Planning:
        """The planning of ``order``, not begun. Raises `NoWay`."""
        body, graph = self._body, self._level.graph
        prices = link_prices(body, graph) if order.by_odds else None
        return Planning(graph, order, body.ranges, body.limits, prices)

    def give(self, order: Order) -> Plan:
        """Plan ``order`` from now on, instead of what was told before; return the plan without smoothing. One
        that is told again and again gets a path all the same, if only of an order before the last. Raises
        `NoWay`, and changes nothing."""
        planning = self.planned(order)
        if self.planning is None:
            self._since = self._body.human.ticks
        if self._body.human.ticks - self._since >= _PATIENCE:
            self._later = order
        else:
            self.planning, self._later, self._again = planning, None, False
        return planning.pulled

    def go_on(self) -> Planning | None:
        """Plan for a tick. Returns the planning if it is done: its plan is to be taken now. Raises `NoWay`
        if the person has moved to a place from which there is none."""
        planning = self.planning
        if planning is None:
            return None
        planning.go_on()
        if planning.plan is None:
            return None
        if self._strayed(planning.order):
            self.planning = planning = self._anew(planning.order)
            if not self._again:
                self._again = True
                return None
            planning.finish()
        later = self._later
        self.drop()
        if later is not None:
            self.planning, self._since = self._anew(later), self._body.human.ticks
        return planning

    def drop(self) -> None:
        """Forget them."""
        self.planning, self._later, self._again = None, None, False

    def change_level(self) -> None:
        """The level has changed: plan the order again, or forget it if there is no way any more."""
        if self.planning is None:
            return
        last = self._later or self.planning.order
        self.drop()
        with suppress(NoWay):
            self.planning = self.planned(last)

    def _strayed(self, order: Order) -> bool:
        """Whether it is too far from where it was told, or has taken off since."""
        body = self._body
        takes_off = body.human.status in CLEARING.values() and not order.clears
        return takes_off or math.hypot(*(body.position - order.place)[:2]) > _ASTRAY

    def _anew(self, order: Order) -> Planning:
        return self.planned(self.told(order.goals, order.speed, order.skilled, order.closed))

    def save(self) -> OrdersState | None:
        """Everything that decides how it goes on; None if it has no orders."""
        planning = self.planning
        if planning is None:
            return None
        return OrdersState(planning.order, planning.ticks, self._since, self._later, self._again)

    def restore(self, state: OrdersState | None) -> None:
        """Go on from what `save` gave. Raises `RuntimeInputError` or another `ValueError` for anything
        else."""
        self.drop()
        if state is None:
            return
        if not isinstance(state, OrdersState):
            raise RuntimeInputError(f"a person's orders are saved as OrdersState, not {type(state).__name__}")
        state.order.check()
        if state.later is not None:
            state.later.check()
        for what, most in ((state.ticks, _LONGEST), (state.since, 2**53)):
            if not is_whole(what):
                raise RuntimeInputError(f"a person plans for whole ticks, not {what!r}")
            check_number("a tick of planning", what, 0, most)
        self.planning = self.planned(state.order)
        self._since, self._later, self._again = state.since, state.later, state.again
        for _ in range(state.ticks):
            self.planning.go_on()
