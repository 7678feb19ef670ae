"""What a person does once: clearing obstacles, and getting up after a fall, from its simulation."""

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import CONTROL_DT
from locomotion.body_events import Cleared, GotUp, TookOff
from locomotion.errors import LocomotionError
from locomotion.gaits.run.controller import CONTACT
from locomotion.ground.ground import Ground
from locomotion.human.human import Human
from locomotion.human.state import MOVING
from locomotion.postures.places import inverse, place_of, placed
from locomotion.recorded.motion_set import Clip
from locomotion.recorded.takes.take import RATE, Take, Told, spread
from locomotion.skills.course import make_course
from locomotion.skills.registry import skill_kinds

__all__ = ["falls_and_rises", "obstacle_takes", "take_of_ticks"]

_SPEED = 3.5  # [m/s] asked for on the way to an obstacle
_STARTS = np.arange(12.0, 20.0, 0.7)  # [m] from the start to the obstacle, until one is cleared
_BEFORE, _AFTER = 0.4, 0.6  # [s] of running before the take-off, and after the obstacle is cleared
_LONGEST = 30.0  # [s]
_PUSHES = {"forward": 520.0, "backward": -520.0}
"""Force ahead [N] on the chest that makes a person fall."""
_PUSHED = (0.2, 0.25, 0.3, 0.4)  # [s]
_BEARS = 100.0  # [N] on a foot that bears


def take_of_ticks(clip: Clip, qpos: NDArray[np.float64], forces: NDArray[np.float64]) -> Take:
    """Ticks of 10 ms (n, 46), which begin on the ground z = 0, and the forces (n, 2) under the feet [N] as a
    take; its ``clip`` gets the seconds and the travel."""
    back = inverse(place_of(qpos[0]))
    rows = np.array([placed(frame, back) for frame in qpos])
    seconds = (len(rows) - 1) * CONTROL_DT
    shares = np.linspace(0.0, 1.0, round(seconds * RATE) + 1)
    ticks = np.round(shares * (len(rows) - 1)).astype(int)
    x, y, turn = (float(value) for value in place_of(rows[-1]))
    turn = math.remainder(turn, 2.0 * math.pi)
    told = {"seconds": seconds, "travel": (x, y, turn)}
    return Take(clip.model_copy(update=told), spread(rows, shares, cyclic=False), forces[ticks] > _BEARS)


def obstacle_takes(told: Told) -> list[Take]:
    """One clip of each kind of skill, at the obstacle that is usual for it."""
    takes, kinds = [], skill_kinds()
    for k, kind in enumerate(kinds):
        told(k / len(kinds), kind.affordance)
        takes.append(_over(kind.affordance, kind.usual))
    return takes


def _over(affordance: str, size: float) -> Take:
    for start in _STARTS:
        course = make_course([(affordance, size, 0.3)], [float(start)])
        human = Human(Ground.from_arrays(course.vertices, course.faces))
        human.reset(course.path[0], 0.0)
        human.follow(course.path, _SPEED, course.obstacles)
        qpos, forces, took_off, cleared = [], [], 0, 0
        while human.status in MOVING and human.time < _LONGEST:
            human.tick()
            qpos.append(human.qpos)
            forces.append(human.control[CONTACT].copy())
            kinds = {type(event) for event in human.events}
            took_off = took_off or (len(qpos) if TookOff in kinds else 0)
            cleared = cleared or (len(qpos) if Cleared in kinds else 0)
            if cleared and len(qpos) > cleared + _AFTER / CONTROL_DT:
                break
        if not cleared or human.status == "fallen":
            continue
        first, last = took_off - round(_BEFORE / CONTROL_DT), cleared + round(_AFTER / CONTROL_DT)
        rows = np.array(qpos[first:last])
        edge = course.obstacles[0]
        clip = Clip(
            name=affordance, kind="skill", seconds=1.0,
            origin=f"simulation of {affordance} at {size:g} m, run at {_SPEED:g} m/s",
            obstacle=(float(edge.arc_length - rows[0, 0]), float(edge.height), float(edge.depth)),
        )  # fmt: skip
        return take_of_ticks(clip, rows, np.array(forces[first:last]))
    raise LocomotionError(f"{affordance} at {size:g} m: no start of {len(_STARTS)} cleared it")


def falls_and_rises(told: Told) -> list[Take]:
    """Getting up from a fall, forward and backward: the quickest of a few falls each."""
    takes = []
    for k, (way, force) in enumerate(_PUSHES.items()):
        told(k / len(_PUSHES), f"getting up after a fall {way}")
        found = [rise for lasts in _PUSHED if (rise := _rise(force, lasts)) is not None]
        if not found:
            raise LocomotionError(f"a person that fell {way} did not get up in {_LONGEST:g} s")
        qpos, forces = min(found, key=lambda rise: len(rise[0]))
        clip = Clip(
            name=f"get up after a fall {way}", kind="skill", seconds=1.0,
            origin=f"simulation of getting up, after a push of {abs(force):g} N",
        )  # fmt: skip
        takes.append(take_of_ticks(clip, qpos, forces))
    return takes


def _rise(force: float, lasts: float) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Ticks of getting up, and the forces under the feet, after a push ahead with ``force`` [N] for so long
    [s]; None for who does not fall, or does not get up."""
    human = Human(None, clearing=(), rehearsals=0, gets_up=True)
    human.reset(np.zeros(3), 0.0)
    human.follow(np.array([[0.0, 0.0, 0.0], [50.0, 0.0, 0.0]]), 1.0)
    qpos, forces, begun = [], [], 0
    while human.time < _LONGEST:
        pushed = 1.0 <= human.time < 1.0 + lasts
        human.data.xfrc_applied[human.index.chest, 0] = force if pushed else 0.0
        human.tick()
        qpos.append(human.qpos)
        forces.append(human.control[CONTACT].copy())
        begun = begun or (len(qpos) if human.status == "getting up" else 0)
        if any(isinstance(event, GotUp) for event in human.events):
            return np.array(qpos[begun:]), np.array(forces[begun:])
        if not begun and human.time > 4.0:
            break
    return None
