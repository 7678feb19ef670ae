"""What figures of other simulators look like: people, our animals, and everything else as a grey lump."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from locomotion import PERSON_RULES, Ground
from locomotion.body.models import figure
from locomotion.quadruped import BODY_NAMES, Herd, load_body
from runtime.bodies.animal_figure import animal_figure
from runtime.bodies.figure import Figure, Shapes, rotate, turn
from runtime.dis.enumerations import CATEGORY_MAMMAL
from runtime.errors import RuntimeInputError

__all__ = ["PERSON", "THING", "Look", "animal_of", "look_of"]

PERSON, THING = "human", "thing"
_THING = np.array([2.0, 1.0, 0.8])  # [m] half axes
_GREY = (0.5, 0.5, 0.55)
_PLANE = 50.0  # [m]


@dataclass(frozen=True, eq=False)
class Look:
    """``name``: `PERSON`, one of our animals, or `THING`. ``radius`` [m] that others keep away. ``stands``:
    of others than people the (b, 7) places of its bodies, at the origin, facing +x."""

    name: str
    radius: float
    figure: Figure
    stands: np.ndarray

    @property
    def is_person(self) -> bool:
        return self.name == PERSON

    def posed(self, row: np.ndarray) -> np.ndarray:
        """(b, 7): where its bodies are; ``row`` as `runtime.bodies.remote_figures.REMOTE`."""
        half = 0.5 * float(row["heading"])
        heading = np.array([np.cos(half), 0.0, 0.0, np.sin(half)])
        placed = np.empty_like(self.stands)
        placed[:, :3] = row["place"] + rotate(heading, self.stands[:, :3])
        placed[:, 3:] = turn(heading, self.stands[:, 3:])
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
    corners = [(-_PLANE, -_PLANE, 0.0), (_PLANE, -_PLANE, 0.0), (_PLANE, _PLANE, 0.0), (-_PLANE, _PLANE, 0.0)]
    herd = Herd(Ground.from_arrays(corners, [(0, 1, 2), (0, 2, 3)]))
    herd.add(body, (0.0, 0.0, 0.0), 0.0)
    stands = herd.pose(0)
    stands[:, :2] -= herd.front(0)
    return Look(name, body.radius, animal_figure(body), stands)
