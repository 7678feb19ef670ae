"""Trials of path following on a training ground, as in a mission."""

import math
from dataclasses import dataclass, field

import numpy as np

from locomotion.body.person import CONTROL_DT
from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RunSkill
from locomotion.gaits.walk.skill import WalkSkill
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.training.gaits.gait_state import gait_state
from locomotion.training.gaits.grounds import FLIGHTS, HALF, ground_height, training_ground
from locomotion.training.gaits.rollout import Measures, Trial

__all__ = ["TURNING", "PathScenario", "draw_flight", "draw_path", "draw_turns", "follow_path", "straight_on"]

TURNING = 12.0
"""[s] during which new orders come."""
_PACE = 0.25  # [m] between a path's points
_TURN_IN = 1.0  # [m] along which a path goes over from one curvature to the next
_SLOWEST = 0.6  # share of the wanted speed that is allowed on average
_RESTS = 300  # ticks at its goal within which it must come to rest
_ASIDE = 0.3  # greatest sideways slope of a path over a flight of stairs
_MARGIN = 2.0  # [m] from the ground's border
_TURNS, _TURNED = (0.5, 2.5), 1.0  # [s] between new orders; [rad] greatest turn to either side
_ONWARD = 20.0  # [m] of path in each order


@dataclass(frozen=True)
class PathScenario:
    """A path to follow.

    ground: one of `grounds.KINDS`; points: (n, 3) float64 [m]; length: how much of it counts [m], horizontal;
    speed: wanted [m/s]; pushes: (j, 3) rows of time [s] and force x, y [N] on the chest for 0.1 s; turns: (k,
    2) rows of time [s] and angle [rad] of a new order, straight ahead. With turns, the trial ends at the last
    of them, and what counts is that the person still walks.
    """

    ground: str
    points: np.ndarray
    length: float
    speed: float
    pushes: np.ndarray
    turns: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))

    @property
    def duration(self) -> float:
        """Time [s] that the path may take at most."""
        if len(self.turns):
            return float(self.turns[-1, 0])
        return 6.0 + self.length / (_SLOWEST * min(self.speed, 2.0))


def draw_path(
    rng: np.random.Generator,
    length: tuple[float, float],
    speeds: tuple[float, float],
    radius: float,
    ground: str = "level",
    push: float = 0.0,
    beyond: float = 0.0,
) -> PathScenario:
    """A random winding path.

    length [m], speeds [m/s]: ranges to draw from; radius: of the tightest bends [m]; ground: kind; push:
    highest force [N] of pushes every 3 s; beyond: straight extension [m], so that nobody slows down before
    the part that counts ends.
    """
    counted = max(round(rng.uniform(*length) / _PACE), 8)
    count = counted + round(beyond / _PACE)
    curvature = np.empty(0)
    while len(curvature) < count:
        bend = rng.uniform(-1.0, 1.0) / radius * (rng.random() < 0.65)
        span = rng.uniform(1.0, 4.0) if bend == 0.0 else rng.uniform(0.3, 1.8) / max(abs(bend), 0.15)
        curvature = np.concatenate([curvature, np.full(max(round(span / _PACE), 2), bend)])
    window = round(_TURN_IN / _PACE)
    curvature = np.convolve(np.pad(curvature, window, mode="edge"), np.full(window, 1.0 / window), "same")
    curvature = curvature[window : window + count]
    curvature[counted:] = 0.0
    heading = rng.uniform(-np.pi, np.pi) + np.concatenate([[0.0], np.cumsum(curvature * _PACE)[:-1]])
    points = np.zeros((count + 1, 3))
    points[1:, 0], points[1:, 1] = np.cumsum(_PACE * np.cos(heading)), np.cumsum(_PACE * np.sin(heading))
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    points[:, :2] += rng.uniform(_MARGIN - HALF - low, HALF - _MARGIN - high)
    points[:, 2] = ground_height(ground, points[:, 0], points[:, 1])
    times = np.arange(rng.uniform(1.0, 3.0), 20.0, 3.0)
    angle, force = rng.uniform(0, 2 * np.pi, len(times)), push * np.sqrt(rng.random(len(times)))
    pushes = np.stack([times, force * np.cos(angle), force * np.sin(angle)], axis=1)
    pushes = pushes[: len(times) if push > 0.0 else 0]
    return PathScenario(ground, points, counted * _PACE, float(rng.uniform(*speeds)), pushes)


def draw_flight(rng: np.random.Generator, speeds: tuple[float, float]) -> PathScenario:
    """A random path up or down a flight of stairs, nearly straight, from landing to landing. speeds [m/s]:
    range to draw from."""
    first, _, _, last = FLIGHTS[rng.integers(len(FLIGHTS))]
    begin, end = first - rng.uniform(0.8, 1.2), last + rng.uniform(0.8, 1.2)
    if rng.random() < 0.5:
        begin, end = end, begin
    x = np.linspace(begin, end, round(abs(end - begin) / _PACE) + 1)
    y = rng.uniform(-30.0, 30.0) + rng.uniform(-_ASIDE, _ASIDE) * np.abs(x - begin)
    points = np.stack([x, y, ground_height("stairs", x, y)], axis=1)
    length = float(np.hypot(x[-1] - x[0], y[-1] - y[0]))
    return PathScenario("stairs", points, length, float(rng.uniform(*speeds)), np.empty((0, 3)))


def draw_turns(rng: np.random.Generator, speeds: tuple[float, float]) -> PathScenario:
    """Random new orders on level ground. speeds [m/s]: range to draw from."""
    times = np.cumsum(rng.uniform(*_TURNS, math.ceil(TURNING / _TURNS[0])))
    times = np.append(times[times < TURNING], TURNING)
    turns = np.column_stack([times, rng.uniform(-_TURNED, _TURNED, len(times))])
    points = straight_on(np.zeros(3), rng.uniform(-np.pi, np.pi))
    return PathScenario("level", points, _ONWARD, float(rng.uniform(*speeds)), np.empty((0, 3)), turns)


def straight_on(position: np.ndarray, yaw: float) -> np.ndarray:
    """A straight way (2, 3) [m] from ``position`` (3,), level."""
    return position + np.outer([0.0, _ONWARD], [math.cos(yaw), math.sin(yaw), 0.0])


def follow_path(
    scenario: PathScenario, run: RunSkill | None = None, walk: WalkSkill | None = None, rehearsals: int = 0
) -> Trial:
    """Follow the path from standing with these skills (None: built-in), with at most so many ``rehearsals``
    at a time.

    At its goal the person has to come to rest. Among the figures, ``time`` is the share of the path covered
    (0.8 to 0.99 if it arrives without resting; with new orders, of the time) times the scenario's duration;
    ``side_drift`` twice the mean distance from the path [m], at most 1 m; ``behind`` how much slower it is
    than its reference on average [m/s]; ``restless`` the share of 3 s that it took to come to rest, 1 if it
    did not.
    """
    human = Human(training_ground(scenario.ground), run, clearing=(), walk=walk, rehearsals=rehearsals)
    points = scenario.points
    yaw = math.atan2(points[1, 1] - points[0, 1], points[1, 0] - points[0, 0])
    human.reset(points[0], yaw)
    human.follow(points, scenario.speed)
    measures = Measures(human.data, human.index)
    push, state = human.data.xfrc_applied[human.index.chest], gait_state(human)
    aside, behind, ticks, turned = 0.0, 0.0, 0, 0
    while (
        human.status in MOVING
        and human.arc_length < scenario.length
        and ticks * CONTROL_DT < scenario.duration
    ):
        time = ticks * CONTROL_DT
        push[:2] = 0.0
        for start, fx, fy in scenario.pushes:
            if start <= time < start + 0.1:
                push[:2] = fx, fy
        if turned < len(scenario.turns) and time >= scenario.turns[turned, 0]:
            human.follow(straight_on(human.position, human.yaw + scenario.turns[turned, 1]), scenario.speed)
            turned += 1
        human.tick()
        ticks += 1
        aside += min(abs(human.lateral_error), 1.0)
        state = gait_state(human)
        measures.add(state)
        behind += float(state[c.SPEED]) - math.hypot(*state[c.COM_VELOCITY][:2])
    push[:2] = 0.0
    arrived, stands = human.status == "arrived", 0
    while human.status == "arrived" and not human.held and stands < _RESTS:
        human.tick()
        stands += 1
    if len(scenario.turns):
        covered = ticks * CONTROL_DT / scenario.duration
    else:
        covered = human.arc_length / scenario.length
    if arrived:
        covered = 1.0 if human.held else 0.8 + 0.19 * stands / _RESTS
    done = covered >= 1.0 and human.status in (*MOVING, "arrived")
    figures = measures.figures(state, ticks)
    figures["time"] = (1.0 if done else min(covered, 0.99)) * scenario.duration
    figures["restless"] = stands / _RESTS if human.held else 1.0
    figures["behind"] = behind / max(ticks, 1)
    figures["side_drift"] = 2.0 * aside / max(ticks, 1)
    return Trial(figures, np.concatenate([human.qpos, state]))
