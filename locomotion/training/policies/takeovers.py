"""People in the midst of a planned walk or run: states from which the learned one takes over."""

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import CONTROL_DT, JOINT_NAMES
from locomotion.errors import LocomotionError
from locomotion.gaits.policy import layout as at
from locomotion.gaits.policy.kernel import Parts, feel
from locomotion.gaits.run.layout import COM_VELOCITY, STEP_TIME
from locomotion.gaits.walk.layout import CLOCK, DOUBLE, PHASE, WALK_STEPS
from locomotion.human.human import Human
from locomotion.human.learned_tick import SLOWEST
from locomotion.human.learned_walk import memory_of, memory_of_run
from locomotion.human.state import MOVING
from locomotion.training.gaits.brake import draw_starts
from locomotion.training.gaits.gait_state import gait_state
from locomotion.training.gaits.grounds import training_ground
from locomotion.training.gaits.path_trial import straight_on
from locomotion.training.policies.figure import Figure
from locomotion.training.policies.starts import Starts

__all__ = ["out_of_runs", "takeovers"]

_SPEEDS = 0.5, 2.0  # [m/s] asked for
_ORDERS = 0.8, 3.0  # [s] between orders
_FAR, _FARTHEST, _NEAR = 0.4, math.pi, 0.6  # share of orders that turn far; [rad] they, and others, turn
_OTHER_SPEED = 0.7  # share of the orders that ask for another speed
_PUSHED, _FORCE = 0.3, 120.0  # share of the orders with a push of up to so many [N]
_PUSH_TICKS = round(0.1 / CONTROL_DT)
_ROUND, _MOST_ROUNDS = 20.0, 2000  # [s] after which a person begins anew; how often at most
_STEPS = 4.0  # that it has made
_RUNS, _SPEEDS_OF_RUNS, _RUN_TICKS = 40, (1.8, 5.0), (20, 160)  # at a time; [m/s]; ticks of each
_RUN_PUSHED, _RUN_FORCE, _KEPT = 0.6, 250.0, 0.6  # share that is pushed; [N] up to; share of the steps kept
_COLUMNS = np.array([JOINT_NAMES.index(name) for name in at.JOINTS])
_State = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]


def takeovers(count: int, seed: int) -> Starts:
    """``count`` people who walk as planned and have just put a foot down, as the learned walk has them when
    it takes over: after orders to walk and turn, some of them pushed.

    Raises `LocomotionError` if the planned walk does not get so many steps done.
    """
    rng, found = np.random.default_rng(seed), list[_State]()
    human = Human(training_ground("level"), clearing=(), rehearsals=0)
    figure, parts = Figure(False, 0.01), Parts(human.index, human.model)
    for _ in range(_MOST_ROUNDS):
        _walk_about(human, figure, parts, rng, found)
        if len(found) >= count:
            order = rng.permutation(len(found))[:count]
            return Starts(*(np.array(each)[order] for each in zip(*found, strict=True)))
    raise LocomotionError("the planned walk falls too soon: train the walk again")


def out_of_runs(count: int, seed: int) -> Starts:
    """``count`` people who run as planned at 1.8 to 5 m/s, a third of them in bends and most of them pushed,
    and have just put a foot down."""
    rng, found = np.random.default_rng([seed, 1]), list[_State]()
    human = Human(None, clearing=(), rehearsals=0)
    figure, parts = Figure(False, 0.01), Parts(human.index, human.model)
    while len(found) < count:
        for start in draw_starts(rng, _RUNS, _SPEEDS_OF_RUNS):
            human.restore_state(start)
            _run_on(human, figure, parts, rng, found)
    return Starts(*(np.array(each[:count]) for each in zip(*found, strict=True)))


def _run_on(
    human: Human, figure: Figure, parts: Parts, rng: np.random.Generator, found: list[_State]
) -> None:
    """Let a person run for a while, and add some of its states to ``found``."""
    push, ticks = human.data.xfrc_applied[human.index.chest], int(rng.integers(*_RUN_TICKS))
    begins = int(rng.integers(0, ticks)) if rng.random() < _RUN_PUSHED else ticks
    side, force = rng.uniform(0.0, 2.0 * math.pi), _RUN_FORCE * rng.random()
    for tick in range(ticks):
        on = begins <= tick < begins + _PUSH_TICKS
        push[:2] = (force * math.cos(side), force * math.sin(side)) if on else 0.0
        human.tick()
        if human.gait_now != "run" or human.status not in MOVING:
            break
        if human.control[STEP_TIME] == 0.0 and rng.random() < _KEPT:
            found.append(_state(human, memory_of_run(human.control, human.data.qvel), figure, parts))
    push[:2] = 0.0


def _walk_about(
    human: Human, figure: Figure, parts: Parts, rng: np.random.Generator, found: list[_State]
) -> None:
    """Give a person orders, and add the states to ``found``."""
    yaw, speed = float(rng.uniform(-math.pi, math.pi)), float(rng.uniform(*_SPEEDS))
    human.reset(np.zeros(3), yaw)
    human.follow(straight_on(human.position, yaw), speed)
    push = human.data.xfrc_applied[human.index.chest]
    time, due, pushed = 0.0, float(rng.uniform(*_ORDERS)), 0
    while time < _ROUND and human.status in (*MOVING, "arrived"):
        if time >= due:
            due = time + float(rng.uniform(*_ORDERS))
            most = _FARTHEST if rng.random() < _FAR else _NEAR
            if rng.random() < _OTHER_SPEED:
                speed = float(rng.uniform(*_SPEEDS))
            human.follow(straight_on(human.position, human.yaw + float(rng.uniform(-most, most))), speed)
            if rng.random() < _PUSHED:
                side, force = rng.uniform(0.0, 2.0 * math.pi), _FORCE * rng.random()
                push[:2] = force * math.cos(side), force * math.sin(side)
                pushed = _PUSH_TICKS
        human.tick()
        time, pushed = time + CONTROL_DT, pushed - 1
        if pushed <= 0:
            push[:2] = 0.0
        if human.status in MOVING and _can_be_taken_over(human):
            found.append(_state(human, memory_of(human.on_feet.walk, human.data.qvel), figure, parts))
    push[:2] = 0.0


def _can_be_taken_over(human: Human) -> bool:
    walk = human.on_feet.walk
    lands = walk[PHASE] == DOUBLE and walk[CLOCK] == 0.0 and walk[WALK_STEPS] >= _STEPS
    return bool(lands) and math.hypot(*gait_state(human)[COM_VELOCITY][:2]) >= SLOWEST


def _state(human: Human, memory: NDArray[np.float64], figure: Figure, parts: Parts) -> _State:
    """The ``memory``, physics on the ``figure`` that learns, and what is sensed, above the origin."""
    data, model, felt = human.data, figure.model, np.zeros(at.FELT_SIZE)
    feel(parts, data, felt)
    physics = np.zeros(1 + model.nq + model.nv)
    qpos, qvel = physics[1 : 1 + model.nq], physics[1 + model.nq :]
    qpos[:7], qvel[:6] = data.qpos[:7], data.qvel[:6]
    qpos[figure.angles], qvel[figure.rates] = data.qpos[7 + _COLUMNS], data.qvel[6 + _COLUMNS]
    qpos[:2] = 0.0
    felt[at.SOLES].reshape(6, 3)[:, :2] -= data.qpos[:2]
    return memory, physics, felt
