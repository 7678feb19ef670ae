"""What figures of other simulators look like: people, our animals, and everything else as a grey lump."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from locomotion import PERSON_RULES, Ground
from locomotion.body.models import figure
from locomotion.quadruped import BODY_NAMES, Body, Herd, lay_trail, load_body
from runtime.bodies.animal_figure import animal_figure
from runtime.bodies.figure import Figure, Shapes, rotate, turn
from runtime.bodies.pose import between
from runtime.dis.enumerations import CATEGORY_MAMMAL
from runtime.errors import RuntimeInputError

__all__ = ["PERSON", "THING", "Look", "animal_of", "look_of"]

PERSON, THING = "human", "thing"
_THING = np.array([2.0, 1.0, 0.8])  # [m] half axes
_GREY = (0.5, 0.5, 0.55)
_PLANE = 50.0  # [m]
_SPEED, _STRIDES_FROM = 1.5, 0.5  # [m/s] of the recorded gait; from which it is shown in full
_SETTLES, _SHORTEST_ROUND, _LONGEST_ROUND = 400, 20, 200  # ticks of 10 ms


@dataclass(frozen=True, eq=False)
class Look:
    """``name``: `PERSON`, one of our animals, or `THING`. ``radius`` [m] that others keep away. Of others
    than people: ``stands``, the (b, 7) places of its bodies, at the origin, facing +x; ``goes`` (f, b, 7),
    the same in one round of its gait, over a way of ``stride`` [m], if it has one."""

    name: str
    radius: float
    figure: Figure
    stands: np.ndarray
    goes: np.ndarray | None = None
    stride: float = 0.0

    @property
    def is_person(self) -> bool:
        return self.name == PERSON

    def posed(self, row: np.ndarray) -> np.ndarray:
        """(b, 7): where its bodies are; ``row`` as `runtime.bodies.remote_figures.REMOTE`."""
        half = 0.5 * float(row["heading"])
        heading = np.array([np.cos(half), 0.0, 0.0, np.sin(half)])
        pose = self.stands
        if self.goes is not None:
            frame, share = divmod(float(row["phase"]) * len(self.goes), 1.0)
            before = self.goes[int(frame) % len(self.goes)]
            going = between(before, self.goes[(int(frame) + 1) % len(self.goes)], share)
            pose = between(pose, going, min(abs(float(row["pace"])) / _STRIDES_FROM, 1.0))
        placed = np.empty_like(pose)
        placed[:, :3] = row["place"] + rotate(heading, pose[:, :3])
        placed[:, 3:] = turn(heading, pose[:, 3:])
        return placed


def animal_of(category: int, extra: int) -> str | None:
    """Which of our animals a life form is drawn as, by its entity type; None for a person."""
    if category < CATEGORY_MAMMAL:
        return None
    return BODY_NAMES[extra - 1] if 1 <= extra <= len(BODY_NAMES) else BODY_NAMES[0]


@cache
def look_of(name: str) -> Look:
    """Raises `RuntimeInputError` for one that is not there."""
    if name == PERSON:
        return Look(name, PERSON_RULES["radius"], Figure.from_model(figure()), np.zeros((0, 7)))
    if name == THING:
        place = np.array([[0.0, 0.0, _THING[2], 1.0, 0.0, 0.0, 0.0]])
        shapes = Shapes(place, _THING[None], np.array([True]), np.array([_GREY]))
        lump = Figure((THING,), np.array([-1], np.int32), np.zeros(1, np.int32), shapes)
        return Look(name, float(_THING[0]), lump, np.array([[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]))
    if name not in BODY_NAMES:
        raise RuntimeInputError(f"look {name!r}: valid: {PERSON}, {', '.join(BODY_NAMES)}, {THING}")
    body = load_body(name)
    return Look(name, body.radius, animal_figure(body), *_recorded(body))


def _recorded(body: Body) -> tuple[np.ndarray, np.ndarray, float]:
    """An animal that stands, one round of its gait on a plane, and how far that takes it [m]."""
    corners = [(-_PLANE, -_PLANE, 0.0), (_PLANE, -_PLANE, 0.0), (_PLANE, _PLANE, 0.0), (-_PLANE, _PLANE, 0.0)]
    ground = Ground.from_arrays(corners, [(0, 1, 2), (0, 2, 3)])
    herd, begin = Herd(ground), (-0.5 * _PLANE, 0.0, 0.0)
    herd.add(body, begin, 0.0)
    herd.follow(0, lay_trail([begin, (0.9 * _PLANE, 0.0, 0.0)], body, ground), _SPEED)
    poses, ways = [], []
    for _ in range(_SETTLES + 2 * _LONGEST_ROUND):
        front, pose = herd.front(0).copy(), herd.pose(0)
        pose[:, :2] -= front
        poses.append(pose)
        ways.append(float(front[0]))
        herd.tick()
    settled = np.array(poses[_SETTLES:])
    rounds = range(_SHORTEST_ROUND, _LONGEST_ROUND)
    ticks = min(rounds, key=lambda each: float(np.abs(settled[each] - settled[0]).max()))
    return poses[0], settled[:ticks], ways[_SETTLES + ticks] - ways[_SETTLES]
