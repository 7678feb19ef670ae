"""From joint angles to where all bodies are, for many figures at once.

::

    low = skeleton("low")
    places = posed(low, channels, roots)          # (n, bodies, 7)

A place is x, y, z [m] and a quaternion (w, x, y, z).
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.recorded.skeletons import Skeleton
from surefoot.kernels import kernel

__all__ = ["pose_bodies", "pose_body", "posed", "posed_slowly", "whole_figures"]


def _polynomial(function, terms: int) -> tuple[float, ...]:
    """Coefficients of a function of t = x^2 for |x| up to π / 2."""
    fitted = np.polynomial.Chebyshev.interpolate(function, terms - 1, [0.0, 2.5])
    return tuple(float(c) for c in fitted.convert(kind=np.polynomial.Polynomial).coef)


# Within 1e-12 of the sine and cosine, and several times as quick.
_S0, _S1, _S2, _S3, _S4, _S5, _S6 = _polynomial(lambda t: np.sinc(np.sqrt(t) / np.pi), 7)
_C0, _C1, _C2, _C3, _C4, _C5, _C6 = _polynomial(lambda t: np.cos(np.sqrt(t)), 7)


def posed(
    skeleton: Skeleton, channels: NDArray[np.float64], roots: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Places (n, b, 7) float64 of the bodies of n figures of one level. ``channels``: (n, c) float64 [rad],
    -π to π. ``roots``: (n, 7) float64, places of the pelvises."""
    s = skeleton
    out = np.empty((len(channels), len(s.bodies), 7))
    # of another layout the kernel would be compiled once more
    channels, roots = np.ascontiguousarray(channels), np.ascontiguousarray(roots)
    pose_bodies(s.parents, s.offsets, s.first, s.axes, s.signs, channels, roots, out)
    return out


def posed_slowly(
    skeleton: Skeleton, channels: NDArray[np.float64], roots: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The same as `posed`, body by body."""
    s = skeleton
    out = np.empty((len(channels), len(s.bodies), 7))
    for figure, (angles, root) in enumerate(zip(channels, roots, strict=True)):
        frames = []
        for body, parent in enumerate(s.parents):
            if parent < 0:
                place, frame = root[:3], Rotation.from_quat(root[3:], scalar_first=True)
            else:
                place = out[figure, parent, :3] + frames[parent].apply(s.offsets[body])
                frame = frames[parent]
            for k in range(s.first[body], s.first[body + 1]):
                frame = frame * Rotation.from_euler("xyz"[s.axes[k]], s.signs[k] * angles[k])
            frames.append(frame)
            out[figure, body] = [*place, *frame.as_quat(scalar_first=True)]
    return out


def whole_figures(skeleton: Skeleton, places: NDArray[np.float64]) -> NDArray[np.float64]:
    """Places (n, 20, 7) of all `BODY_NAMES` of the person, of the ``places`` (n, b, 7) of a level's bodies:
    what its joints do not move is carried along."""
    out = places[:, skeleton.carrier]
    w, v = out[..., 3:4], out[..., 4:]
    across = np.cross(v, skeleton.carried)
    out[..., :3] += skeleton.carried + 2.0 * (w * across + np.cross(v, across))
    return out


@kernel
def pose_bodies(parents, offsets, first, axes, signs, channels, roots, out):
    """Kernel of `posed`; the first arguments are those of a `Skeleton`."""
    bones = parents, offsets, first, axes, signs
    for figure in range(channels.shape[0]):
        for k in range(7):
            out[figure, 0, k] = roots[figure, k]
        for body in range(1, parents.shape[0]):
            pose_body(bones, body, channels[figure], out[figure])


@kernel
def pose_body(bones, body, channels, places):
    """Put one body, other than the pelvis, where its joints have it: ``places`` (b, 7), in which its parent's
    place is known. ``bones``: parents, offsets, first, axes, signs of a `Skeleton`."""
    parents, offsets, first, axes, signs = bones
    parent = parents[body]
    w, x, y, z = places[parent, 3], places[parent, 4], places[parent, 5], places[parent, 6]
    dx, dy, dz = offsets[body, 0], offsets[body, 1], offsets[body, 2]
    ax, ay, az = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
    places[body, 0] = places[parent, 0] + dx + 2.0 * (w * ax + y * az - z * ay)
    places[body, 1] = places[parent, 1] + dy + 2.0 * (w * ay + z * ax - x * az)
    places[body, 2] = places[parent, 2] + dz + 2.0 * (w * az + x * ay - y * ax)
    for k in range(first[body], first[body + 1]):
        h = 0.5 * signs[k] * channels[k]
        t = h * h
        s = h * (_S0 + t * (_S1 + t * (_S2 + t * (_S3 + t * (_S4 + t * (_S5 + t * _S6))))))
        c = _C0 + t * (_C1 + t * (_C2 + t * (_C3 + t * (_C4 + t * (_C5 + t * _C6)))))
        axis = axes[k]
        if axis == 0:
            w, x, y, z = c * w - s * x, c * x + s * w, c * y + s * z, c * z - s * y
        elif axis == 1:
            w, x, y, z = c * w - s * y, c * x - s * z, c * y + s * w, c * z + s * x
        else:
            w, x, y, z = c * w - s * z, c * x + s * y, c * y - s * x, c * z + s * w
    places[body, 3], places[body, 4], places[body, 5], places[body, 6] = w, x, y, z
