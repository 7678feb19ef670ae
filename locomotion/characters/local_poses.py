"""Bones relative to what they hang on (a numba kernel)."""

import numpy as np

from locomotion.characters.quaternions import multiply, rotate
from surefoot.kernels import allocating_kernel

__all__ = ["local_poses"]


@allocating_kernel
def local_poses(parents, above, scales, places, out):
    """Places (n, b, 7) in the world relative to the parents' (b,), into ``out``.

    above: (b, 7) what the bones without a parent hang on. scales: (b,) metres per unit there.
    """
    back, away = np.empty(4), np.empty(3)
    for i in range(len(places)):
        for b in range(len(parents)):
            parent = above[b] if parents[b] < 0 else places[i, parents[b]]
            back[0] = parent[3]
            for k in range(3):
                back[k + 1] = -parent[k + 4]
                away[k] = (places[i, b, k] - parent[k]) / scales[b]
            rotate(back, away, out[i, b])
            multiply(back, places[i, b, 3:], out[i, b, 3:])
