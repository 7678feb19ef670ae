"""How one figure differs from the next, all of them with the same recorded motion.

A figure's traits are a row of `locomotion.body.traits`. They are applied when a motion is sampled, so that
ten who walk side by side are not in step, and none of them is like another::

    traits = np.array([by_chance(seed) for seed in seeds])            # or by_hand(size=1.05, arms=1.3)
    read, strides = pace_of(motions, gaits, speeds, traits)           # phases grow by speed / stride a second
    sample = sample_gait(motions, level, gaits, read, phases + traits[:, PHASE])
    sample = styled(skeleton(LEVELS[level]), sample, traits)
    places = scaled(posed(skeleton(LEVELS[level]), *sample), traits)  # as seen from the point on the ground

Feet do not slide for it: who takes longer strides plays the cycle of a higher speed more slowly.
"""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from locomotion.body.traits import ARMS, HEAD, LEAN, PACE, SIZE, WIDTH
from locomotion.recorded.motion_set import MotionSet
from locomotion.recorded.sampling import Sample, stride_of
from locomotion.recorded.skeletons import Skeleton
from surefoot.kernels import kernel

__all__ = ["pace_of", "scaled", "style", "styled", "styles_of"]


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
