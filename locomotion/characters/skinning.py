"""Where the points of a character's mesh are in a pose."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.characters.character_file import Skeleton

__all__ = ["posed_points"]


def posed_points(
    skeleton: Skeleton, pose: NDArray[np.float64], which: NDArray[np.int64] | None = None
) -> NDArray[np.float64]:
    """The points (v, 3) float64 [m] of the mesh in a ``pose`` (b, 7) of `locomotion.Rig.pose`, in the world;
    ``which``: the numbers of those that are wanted, None for all."""
    mesh = skeleton.mesh
    back = Rotation.from_quat(skeleton.places[:, 3:], scalar_first=True).inv()
    moved = Rotation.from_quat(pose[:, 3:], scalar_first=True) * back
    matrix = moved.as_matrix()
    shift = pose[:, :3] - moved.apply(skeleton.places[:, :3])
    rest, bones, shares = mesh.points, mesh.bones, mesh.shares
    if which is not None:
        rest, bones, shares = rest[which], bones[which], shares[which]
    points = np.zeros_like(rest)
    for bone, share in zip(bones.T, shares.T, strict=True):
        turned = np.einsum("vij,vj->vi", matrix[bone], rest) + shift[bone]
        points += share[:, None] * turned
    return points
