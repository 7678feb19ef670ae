"""How one person differs from the next: a row of traits, by chance or by hand; 56 bytes.

Recorded motion wears them when it is sampled (`locomotion.recorded.individual`), and learned gaits as far as
that holds (`locomotion.gaits.policy.style`).
"""

from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError
from surefoot.numeric import is_finite

__all__ = [
    "ARMS", "HEAD", "LEAN", "PACE", "PHASE", "SIZE", "SPREAD", "TRAITS", "WIDTH", "by_chance", "by_hand",
    "chance_at",
]  # fmt: skip

PHASE, PACE, WIDTH, ARMS, LEAN, HEAD, SIZE = range(7)
TRAITS = MappingProxyType(
    {
        "phase": (0.0, 0.0, 1.0),
        "pace": (1.0, 0.8, 1.25),
        "width": (0.0, -0.05, 0.15),
        "arms": (1.0, 0.0, 2.0),
        "lean": (0.0, -0.2, 0.3),
        "head": (0.0, -0.3, 0.3),
        "size": (1.0, 0.8, 1.2),
    }
)
"""Traits in the order of a row: usual, least and greatest value.

phase: what is added to the phase. pace: who has more takes longer and fewer strides at the same speed; it
is the share of its speed whose strides it takes. width: what each leg is spread by [rad]. arms: how far
they swing, as a share. lean: of the trunk, ahead [rad]. head: bent ahead [rad]. size: of the whole figure,
as a share.
"""
SPREAD = (1.0, 0.05, 0.015, 0.25, 0.04, 0.06, 0.04)
"""Standard deviations of the traits by chance; the phase is spread evenly."""


def by_hand(others: NDArray[np.float64] | None = None, **traits: float) -> NDArray[np.float64]:
    """A row of `TRAITS` (7,) float64: those that are named, and the ``others`` (7,), by default the usual
    ones. Raises `LocomotionError` for an unknown trait, and for a value beyond its least and greatest."""
    row = np.array([usual for usual, _, _ in TRAITS.values()]) if others is None else others.copy()
    for name, value in traits.items():
        if name not in TRAITS:
            raise LocomotionError(f"trait {name!r}: valid: {', '.join(TRAITS)}")
        _, least, most = TRAITS[name]
        if not (is_finite(value) and least <= value <= most):
            raise LocomotionError(f"{name} is {value!r}, expected a number from {least:g} to {most:g}")
        row[list(TRAITS).index(name)] = value
    return row


def by_chance(seed: int) -> NDArray[np.float64]:
    """A row of `TRAITS` (7,) float64; the same ``seed`` gives the same row."""
    chance = np.random.default_rng((seed, 16))
    usual, least, most = np.array(list(TRAITS.values())).T
    row = (usual + np.array(SPREAD) * chance.standard_normal(len(usual))).clip(least, most)
    row[PHASE] = chance.random()
    return row


def chance_at(place: NDArray[np.float64], seed: int) -> np.random.Generator:
    """What is by chance in somebody who appears at ``place`` (3,) [m] in a world of this ``seed``."""
    millimetres = (np.round(1000.0 * place).astype(np.int64) % 2**32).tolist()
    return np.random.default_rng((seed, *millimetres))
