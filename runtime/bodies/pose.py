"""Poses: where the bodies of a figure are, as arrays that an engine's skeleton takes."""

from dataclasses import dataclass

import numpy as np

from runtime.bodies.figure import rotate, turn

__all__ = ["Pose", "between"]


@dataclass(frozen=True)
class Pose:
    """Where the n bodies of a skeleton are.

    ``names``; ``parents`` (n,) int32, -1 for the root, a parent before its children; ``transforms`` (n, 7)
    float64 in the world: position [m] and unit quaternion (w, x, y, z).
    """

    names: tuple[str, ...]
    parents: np.ndarray
    transforms: np.ndarray

    def __repr__(self) -> str:
        root = self.transforms[0, :3].round(2).tolist()
        return f"<Pose of {len(self.names)} bodies, {self.names[0]} at {root}>"

    @property
    def local(self) -> np.ndarray:
        """(n, 7) float64: each body's position [m] and quaternion in its parent's frame; the root's in the
        world."""
        child = self.parents >= 0
        parent = self.transforms[self.parents[child]]
        back = parent[:, 3:] * _CONJUGATE
        local = self.transforms.copy()
        local[child, :3] = rotate(back, self.transforms[child, :3] - parent[:, :3])
        local[child, 3:] = turn(back, self.transforms[child, 3:])
        return local


_CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])


def between(before: np.ndarray, after: np.ndarray, share: float) -> np.ndarray:
    """Transforms (n, 7) a ``share`` (0 to 1) of the way from ``before`` to ``after``, each (n, 7), that are
    not far apart: straight lines, and quaternions along the chord of the shorter arc."""
    mixed = before + share * (after - before)
    same_side = np.sum(before[:, 3:] * after[:, 3:], axis=1, keepdims=True) >= 0.0
    near = np.where(same_side, after[:, 3:], -after[:, 3:])
    mixed[:, 3:] = before[:, 3:] + share * (near - before[:, 3:])
    mixed[:, 3:] /= np.linalg.norm(mixed[:, 3:], axis=1, keepdims=True)
    return mixed
