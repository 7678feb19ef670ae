"""Where all bodies of many figures are, from what was sampled of them, in one kernel."""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from locomotion.body.person import BODY_NAMES
from locomotion.recorded.posing import pose_body
from locomotion.recorded.skeletons import skeleton
from locomotion.recorded_people.figure_tables import bodies_drawn
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["draw", "drawn"]


@cache
def _tables(level: str) -> tuple[tuple[NDArray, ...], tuple[NDArray, NDArray]]:
    bones = skeleton(level)
    return (bones.parents, bones.offsets, bones.first, bones.axes, bones.signs), bodies_drawn(bones)


def drawn(level: str, channels: NDArray[np.float64], roots: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 20, 7) places [m] and quaternions (w, x, y, z) of the bodies of n figures of a ``level``, in the
    order of the person's model, from ``channels`` (n, c) [rad] and ``roots`` (n, 7)."""
    out = np.empty((len(channels), len(BODY_NAMES), 7))
    bones, carriers = _tables(level)
    _draw_all(bones, carriers, np.ascontiguousarray(channels), np.ascontiguousarray(roots), out)
    return out


@allocating_kernel
def _draw_all(bones, carriers, channels, roots, out):
    bodies = np.empty((bones[0].shape[0], 7))
    for n in range(channels.shape[0]):
        draw(bones, bodies.shape[0], carriers, channels[n], roots[n], bodies, out[n])


@kernel
def draw(bones, count, carriers, channels, root, bodies, out):
    """Kernel of `drawn`, for one figure. ``bones`` of a `Skeleton` as of `posing.pose_body`, of which so many
    bodies count; ``carriers`` as of `figure_tables.bodies_drawn`. ``bodies`` (b, 7) is overwritten."""
    carrier, carried = carriers
    for k in range(7):
        bodies[0, k] = root[k]
    for body in range(1, count):
        pose_body(bones, body, channels, bodies)
    for k in range(carrier.shape[0]):
        place, by = out[k], bodies[carrier[k]]
        w, x, y, z = by[3], by[4], by[5], by[6]
        dx, dy, dz = carried[k, 0], carried[k, 1], carried[k, 2]
        ax, ay, az = y * dz - z * dy, z * dx - x * dz, x * dy - y * dx
        place[0] = by[0] + dx + 2.0 * (w * ax + y * az - z * ay)
        place[1] = by[1] + dy + 2.0 * (w * ay + z * ax - x * az)
        place[2] = by[2] + dz + 2.0 * (w * az + x * ay - y * ax)
        for i in range(3, 7):
            place[i] = by[i]
