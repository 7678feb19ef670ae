"""What of a person touches the level (numba kernels): hands that have to be where the person's are, and how
far its feet have sunk into the ground, as those of simulated bodies do under load, or are above it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from locomotion.body.arm_reach import HAND_RADIUS
from locomotion.body.hand_hold import HAND_POINT
from locomotion.characters.person_measures import person_arrays
from locomotion.characters.quaternions import rotate
from locomotion.ground.collider.contact import CANDIDATE, DISTANCE, MAX_CANDIDATES, capsule_contacts
from locomotion.ground.collider.layout import NX
from locomotion.ground.ground import Ground, height_below
from surefoot.kernels import allocating_kernel

__all__ = ["Contacts", "contacts_with", "no_contacts"]

_TOUCHING, _FREE = 0.02, 0.15
"""[m] from the level: nearer than the first a hand touches it, from the second on hands and feet are free."""
_DEEPEST = 0.08
"""[m] that a foot sinks in at most; what is further above it is no ground of it."""
_LEFT = 0.08
"""[m] over the ground from where on its slope does not matter to a foot."""
_POINT = np.array(HAND_POINT)
_FOOT, _TOES, _HAND = 2, 3, 6  # rows of `PersonArrays.limbs`


class Contacts(NamedTuple):
    """Of n persons, right and left."""

    hands: np.ndarray
    """(n, 2) float64, 0 to 1: how much a hand has to be where the person's is"""
    sunk: np.ndarray
    """(n, 2) float64 [m]: how deep a foot is in the ground"""
    depths: np.ndarray
    """(n, 2) float64 [m]: the same, below 0 for a foot above the ground; -0.15 at least, also if unknown"""
    near: np.ndarray
    """(n, 2) float64, 0 to 1: how near a foot is to the ground, if that is known"""
    loads: np.ndarray
    """(n, 2) float64, 0 to 1: how near it is or may be"""
    grips: np.ndarray
    """(n,) float64, 0 to 1: how much the hands hold one thing"""
    normals: np.ndarray
    """(n, 2, 3) float64: of the ground under a foot that is near it"""


def no_contacts(count: int) -> Contacts:
    """Of so many persons of whom nothing is known."""
    hands, sunk, near = (np.zeros((count, 2)) for _ in range(3))
    depths, loads = np.full((count, 2), -_FREE), np.ones((count, 2))
    return Contacts(hands, sunk, depths, near, loads, np.zeros(count), np.zeros((count, 2, 3)))


def contacts_with(ground: Ground, places: NDArray[np.float64]) -> Contacts:
    """What touches ``ground`` of persons whose bodies are at ``places`` (n, 20, 7). A hand counts fully
    within 2 cm of the level, and not at all from 15 cm on."""
    found = no_contacts(len(places))
    a = ground.arrays
    level = (
        a.rows, a.flags, a.vertex_start, a.vertex_edges, a.cell_start, a.cell_triangles, a.cell_range, a.grid,
        a.shape,
    )  # fmt: skip
    _find(level, ground.origin, person_arrays(), np.ascontiguousarray(places), found)
    return found


@allocating_kernel
def _find(level, origin, person, places, contacts):
    rows, flags, vertex_start, vertex_edges, cell_start, cell_triangles, cell_range, grid, shape = level
    point, found = np.empty(3), np.empty((MAX_CANDIDATES, CANDIDATE))
    for i in range(len(places)):
        for side in range(2):
            hand = places[i, person.limbs[_HAND, side]]
            rotate(hand[3:], _POINT, point)
            for k in range(3):
                point[k] += hand[k] - origin[k]
            x, y, z = point
            count = capsule_contacts(
                rows, flags, vertex_start, vertex_edges, cell_start, cell_triangles, cell_range, grid, shape,
                x, y, z, x, y, z, HAND_RADIUS, _FREE, found,
            )  # fmt: skip
            away = _FREE
            for c in range(count):
                away = min(away, found[c, DISTANCE])
            share = min(max((_FREE - away) / (_FREE - _TOUCHING), 0.0), 1.0)
            contacts.hands[i, side] = share * share * (3.0 - 2.0 * share)
            deep = -_FREE
            for part in range(2):
                body = places[i, person.limbs[_TOES if part else _FOOT, side]]
                ends = person.toes[side] if part else person.feet[side]
                for e in range(len(ends)):
                    rotate(body[3:], ends[e], point)
                    for k in range(3):
                        point[k] += body[k] - origin[k]
                    low = point[2] - ends[e, 3]
                    height, which = height_below(
                        rows, cell_start, cell_triangles, grid, shape, point[0], point[1], low + _DEEPEST
                    )
                    if which >= 0 and height - low > deep:
                        deep = height - low
                        contacts.normals[i, side] = rows[which, NX : NX + 3]
            contacts.sunk[i, side], contacts.depths[i, side] = max(deep, 0.0), deep
            share = min(max(deep + _LEFT, 0.0) / _LEFT, 1.0)
            contacts.near[i, side] = share * share * (3.0 - 2.0 * share)
            share = min((deep + _FREE) / _FREE, 1.0)
            contacts.loads[i, side] = share * share * (3.0 - 2.0 * share)
