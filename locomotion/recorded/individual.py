"""How one figure differs from the next, all of them with the same recorded motion.

A figure's traits are a row of `TRAITS`, by chance or by hand; 56 bytes. They are applied when a motion is
sampled, so that ten who walk side by side are not in step, and none of them is like another::

    traits = np.array([by_chance(seed) for seed in seeds])            # or by_hand(size=1.05, arms=1.3)
    read, strides = pace_of(motions, gaits, speeds, traits)           # phases grow by speed / stride a second
    sample = sample_gait(motions, level, gaits, read, phases + traits[:, PHASE])
    sample = styled(skeleton(LEVELS[level]), sample, traits)
    places = scaled(posed(skeleton(LEVELS[level]), *sample), traits)  # as seen from the point on the ground

Feet do not slide for it: who takes longer strides plays the cycle of a higher speed more slowly.
"""

import math
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.errors import LocomotionError
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded.sampling import Sample, stride_of
from locomotion.recorded.skeletons import Skeleton
from surefoot.kernels import kernel
from surefoot.numeric import is_finite

__all__ = [
    "ARMS", "LEAN", "PACE", "PHASE", "SIZE", "SPREAD", "TRAITS", "WIDTH", "by_chance", "by_hand", "pace_of",
    "scaled", "style", "styled", "styles_of",
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


def pace_of(
    motions: MotionSet, gaits: ArrayLike, speeds: ArrayLike, traits: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The speeds (n,) at which the gaits of n figures are to be sampled, which go at ``speeds`` (n,) [m/s],
    and the strides (n,) [m] that they take. Tall figures move like smaller ones that are slower by the root
    of their size, as pendulums do."""
    size = traits[:, SIZE]
    read = np.asarray(speeds, np.float64) * traits[:, PACE] / np.sqrt(size)
    return read, size * stride_of(motions, gaits, read)


def styled(skeleton: Skeleton, sample: Sample, traits: NDArray[np.float64]) -> Sample:
    """A sample with the traits of its figures (n, 7)."""
    channels, styles = sample[0].copy(), styles_of(skeleton)
    for row, own in zip(channels, traits, strict=True):
        style(styles, own, row)
    return channels, sample[1]


def styles_of(skeleton: Skeleton) -> NDArray[np.int64]:
    """(c,) what traits do to each channel, as `style` knows it."""
    joints = [name.removeprefix("right_").removeprefix("left_") for name in skeleton.channels]
    return np.array([_STYLES.get(joint, _AS_IS) for joint in joints], np.int64)


_AS_IS, _SHOULDER, _ELBOW, _SPREADS, _LEANS, _BENDS = range(6)
_STYLES = {
    "shoulder_flexion": _SHOULDER, "elbow_flexion": _ELBOW, "hip_abduction": _SPREADS,
    "ankle_inversion": _SPREADS, "waist_pitch": _LEANS, "neck_pitch": _BENDS,
}  # fmt: skip
_SHOULDER_RESTS, _ELBOW_RESTS = math.radians(-5.0), math.radians(25.0)  # about which arms swing


@kernel
def style(styles, traits, channels):
    """Kernel of `styled`, for one figure: ``channels`` (c,) are changed."""
    for k in range(channels.shape[0]):
        what = styles[k]
        if what == _SHOULDER:
            channels[k] = _SHOULDER_RESTS + traits[ARMS] * (channels[k] - _SHOULDER_RESTS)
        elif what == _ELBOW:
            channels[k] = _ELBOW_RESTS + traits[ARMS] * (channels[k] - _ELBOW_RESTS)
        elif what == _SPREADS:
            channels[k] += traits[WIDTH]
        elif what == _LEANS:
            channels[k] += traits[LEAN]
        elif what == _BENDS:
            channels[k] += traits[HEAD] - traits[LEAN]


def scaled(places: NDArray[np.float64], traits: NDArray[np.float64]) -> NDArray[np.float64]:
    """Places (n, b, 7), told from the point of the ground under each figure, of figures of their own size."""
    out = places.copy()
    out[..., :3] *= traits[:, SIZE, None, None]
    return out
