"""All bodies of the person from those that a simpler figure has."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.body.person import BODY_NAMES
from locomotion.characters.person_measures import person_tree
from locomotion.errors import LocomotionError

__all__ = ["whole_person"]

_NEEDED = ("pelvis", "right_thigh", "left_thigh")


def whole_person(places: NDArray[np.float64], bodies: Sequence[str]) -> NDArray[np.float64]:
    """Places (n, 20, 7) of all of `BODY_NAMES` from those (n, k, 7) of ``bodies``.

    A body that the figure lacks keeps its neutral place on the body that it hangs on; a waist without which
    pelvis and chest are turned is halfway between them. Raises `LocomotionError` if ``bodies`` have no pelvis
    or no thighs, as those of animals.
    """
    given = _numbers(tuple(bodies))
    if given == tuple(range(len(BODY_NAMES))):
        return places
    whole = np.empty((len(places), len(BODY_NAMES), 7))
    own = [b for b, k in enumerate(given) if k >= 0]
    whole[:, own] = places[:, [given[b] for b in own]]
    for name, (parent, offset) in person_tree().items():
        body, above = BODY_NAMES.index(name), BODY_NAMES.index(parent)
        if given[body] >= 0:
            continue
        turn = Rotation.from_quat(whole[:, above, 3:], scalar_first=True)
        whole[:, body, :3] = whole[:, above, :3] + turn.apply(offset)
        whole[:, body, 3:] = whole[:, above, 3:]
        if name == "waist" and given[BODY_NAMES.index("chest")] >= 0:
            chest = whole[:, BODY_NAMES.index("chest"), 3:]
            same = np.sum(chest * whole[:, above, 3:], axis=1, keepdims=True) >= 0.0
            half = whole[:, above, 3:] + np.where(same, chest, -chest)
            whole[:, body, 3:] = half / np.linalg.norm(half, axis=1, keepdims=True)
    return whole


@lru_cache(maxsize=64)
def _numbers(bodies: tuple[str, ...]) -> tuple[int, ...]:
    """Where each of `BODY_NAMES` is in ``bodies``, -1 if nowhere."""
    missing = [name for name in _NEEDED if name not in bodies]
    if missing:
        raise LocomotionError(
            f"a character shows persons; this body has no {', '.join(missing)}, but {', '.join(bodies)}"
        )
    return tuple(bodies.index(name) if name in bodies else -1 for name in BODY_NAMES)
