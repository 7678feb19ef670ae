"""Things in a person's hands, as bodies of its figure: each lies from the right hand, which has it by its
grip, to the left one, upright."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from scipy.spatial.transform import Rotation

from locomotion.body.hand_hold import HAND_POINT
from locomotion.postures.held_objects import parts_of
from locomotion.recorded_people.people import person_postures
from runtime.bodies.figure import Figure, Shapes, rotate

__all__ = ["Looks", "figure_with", "place_between", "thing_figure", "thing_of", "things_in"]

_LEAN = 0.1
"""Share of the hand's own direction in which way is up: it counts for a thing that points straight up."""


@lru_cache(maxsize=64)
def thing_figure(name: str) -> Figure | None:
    """What a thing looks like, as a single body whose origin is its grip, x along it and z up; None for one
    of which nothing is drawn."""
    parts = person_postures().shapes.get(name, ())
    if not parts:
        return None
    place, size = np.zeros((len(parts), 7)), np.zeros((len(parts), 3))
    for k, part in enumerate(parts):
        begin, end = np.array(part.begin), np.array(part.end)
        along = end - begin
        length = float(np.linalg.norm(along))
        turn = Rotation.identity() if length == 0.0 else Rotation.align_vectors([along], [[0, 0, length]])[0]
        place[k] = *(0.5 * (begin + end)), *turn.as_quat(scalar_first=True)
        size[k, :2] = part.radius, 0.5 * length
    shapes = Shapes(place, size, np.zeros(len(parts), bool), np.array([part.colour for part in parts]))
    return Figure((name,), np.array([-1], np.int32), np.zeros(len(parts), np.int32), shapes)


def thing_of(holds: str) -> str:
    """What is held, of a thing and its state such as "rifle deployed"; "" with free hands."""
    return parts_of(f"/{holds}", person_postures().objects)[1]


def place_between(right: np.ndarray, left: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Where a thing is (..., 7) that the ``right`` and the ``left`` hand hold at points (..., 3) [m].
    ``turn`` (..., 4): the quaternion of the right hand."""
    along = left - right
    x = along / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-9)
    up = np.array([0.0, 0.0, 1.0]) + _LEAN * rotate(turn, np.array([1.0, 0.0, 0.0]))
    z = up - np.sum(up * x, axis=-1, keepdims=True) * x
    z /= np.maximum(np.linalg.norm(z, axis=-1, keepdims=True), 1e-9)
    axes = np.stack([x, np.cross(z, x), z], axis=-1)
    turned = Rotation.from_matrix(axes.reshape(-1, 3, 3)).as_quat(scalar_first=True)
    return np.concatenate([right, turned.reshape(turn.shape)], axis=-1)


def things_in(bodies: Sequence[str], poses: np.ndarray) -> np.ndarray:
    """Where a thing in the hands of a person is, (..., 7), whose ``bodies`` are at ``poses`` (..., n, 7)."""
    hands = [poses[..., bodies.index(f"{side}_hand"), :] for side in ("right", "left")]
    points = [hand[..., :3] + rotate(hand[..., 3:], np.array(HAND_POINT)) for hand in hands]
    return place_between(points[0], points[1], hands[0][..., 3:])


def figure_with(figure: Figure, things: Sequence[str]) -> Figure:
    """A person's ``figure`` with a body for each of ``things`` after its own."""
    hand, own, count = figure.bodies.index("right_hand"), figure.shapes, len(figure.bodies)
    looks = [look for look in map(thing_figure, things) if look is not None]
    more = [look.shapes for look in looks]
    return Figure(
        bodies=(*figure.bodies, *(look.bodies[0] for look in looks)),
        parents=np.concatenate([figure.parents, np.full(len(looks), hand, np.int32)]),
        owner=np.concatenate([figure.owner, *(look.owner + count + k for k, look in enumerate(looks))]),
        shapes=Shapes(
            *(
                np.concatenate([getattr(own, name), *(getattr(each, name) for each in more)])
                for name in ("place", "size", "round", "colour")
            )
        ),
    )


class Looks:
    """Figures of agents with what they hold: the same objects as long as they look the same."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[Figure, str, Figure]] = {}

    def look(self, name: str, figure: Figure, pose: np.ndarray, thing: str) -> tuple[Figure, np.ndarray]:
        """The figure and pose of the agent called ``name`` with a ``thing`` in its hands. Its own ``figure``
        is in the ``pose`` (n, 7); the pose returned is (n + 1, 7). Without a thing, or with one that looks
        like nothing, both are returned as they are."""
        if not thing or thing_figure(thing) is None:
            self._known.pop(name, None)
            return figure, pose
        known = self._known.get(name)
        if known is None or known[0] is not figure or known[1] != thing:
            known = self._known[name] = figure, thing, figure_with(figure, (thing,))
        return known[2], np.vstack([pose, things_in(figure.bodies, pose)])
