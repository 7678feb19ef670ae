"""Where all bodies of many figures are, from what was sampled of them, in one kernel."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES
from locomotion.recorded.posing import pose_bodies
from locomotion.recorded.skeletons import skeleton
from surefoot.kernels import allocating_kernel

__all__ = ["drawn"]


@cache
def _tables(level: str) -> tuple[NDArray, ...]:
    """What the kernel needs of a skeleton, its bodies in the order of the person's model."""
    bones, model = skeleton(level), figure()
    order = np.argsort([model.body(name).id for name in BODY_NAMES])
    return (
        bones.parents, bones.offsets, bones.first, bones.axes, bones.signs, bones.carrier[order],
        bones.carried[order],
    )  # fmt: skip


def drawn(level: str, channels: NDArray[np.float64], roots: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 20, 7) places [m] and quaternions (w, x, y, z) of the bodies of n figures of a ``level``, in the
    order of the person's model, from ``channels`` (n, c) [rad] and ``roots`` (n, 7)."""
    out = np.empty((len(channels), len(BODY_NAMES), 7))
    _draw(_tables(level), np.ascontiguousarray(channels), np.ascontiguousarray(roots), out)
    return out


@allocating_kernel
def _draw(tables, channels, roots, out):
    parents, offsets, first, axes, signs, carrier, carried = tables
    bodies = np.empty((channels.shape[0], parents.shape[0], 7))
    pose_bodies(parents, offsets, first, axes, signs, channels, roots, bodies)
    for n in range(channels.shape[0]):
        for k in range(carrier.shape[0]):
            place, by = out[n, k], bodies[n, carrier[k]]
            w, x, y, z = by[3], by[4], by[5], by[6]
            dx, dy, dz = carried[k, 0], carried[k, 1], carried[k, 2]
            ax, ay, az = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
            place[0] = by[0] + dx + 2.0 * (w * ax + y * az - z * ay)
            place[1] = by[1] + dy + 2.0 * (w * ay + z * ax - x * az)
            place[2] = by[2] + dz + 2.0 * (w * az + x * ay - y * ax)
            for i in range(3, 7):
                place[i] = by[i]
