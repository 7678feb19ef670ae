"""What a figure looks like: capsules and ellipsoids on the bodies of its skeleton."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

__all__ = ["NO_JOINTS", "Figure", "Joints", "Shapes", "rotate", "turn"]


@dataclass(frozen=True)
class Shapes:
    """Shapes in one frame of reference.

    ``place`` (m, 7) float64: position [m] and quaternion wxyz of each. ``size`` (m, 3) float64 [m]: of an
    ellipsoid its half axes; of a capsule its radius, half the length of its axis (along the shape's z),
    and 0. ``round`` (m,) bool: whether it is an ellipsoid. ``colour`` (m, 3) float64, 0…1.
    """

    place: np.ndarray
    size: np.ndarray
    round: np.ndarray
    colour: np.ndarray


@dataclass(frozen=True)
class Figure:
    """A skeleton of n bodies and its m shapes.

    ``bodies`` are the bodies' names, ``parents`` (n,) int32 the index of each one's parent, -1 for the root.
    Shape k sits on body ``owner[k]`` (m,) int32; ``shapes`` are in the frames of their bodies.
    """

    bodies: tuple[str, ...]
    parents: np.ndarray
    owner: np.ndarray
    shapes: Shapes

    def posed(self, pose: np.ndarray) -> Shapes:
        """The shapes in the world for ``pose`` (n, 7): position [m] and quaternion wxyz of each body."""
        body = np.asarray(pose, dtype=np.float64)[self.owner]
        local = self.shapes.place
        place = np.empty_like(local)
        place[:, :3] = body[:, :3] + rotate(body[:, 3:], local[:, :3])
        place[:, 3:] = turn(body[:, 3:], local[:, 3:])
        return Shapes(place, self.shapes.size, self.shapes.round, self.shapes.colour)

    def scaled(self, size: float) -> "Figure":
        """The same, ``size`` times as large."""
        own = self.shapes
        place = np.hstack([size * own.place[:, :3], own.place[:, 3:]])
        return replace(self, shapes=replace(own, place=place, size=size * own.size))

    @classmethod
    def from_model(cls, model: Any) -> "Figure":
        """The capsules, spheres and ellipsoids of an ``mujoco.MjModel``; the world body is left out, and so
        are mocap bodies, which come last: they are handles, not limbs."""
        from mujoco import mjtGeom as kinds  # type: ignore[attr-defined]

        drawn = np.isin(model.geom_type, [kinds.mjGEOM_CAPSULE, kinds.mjGEOM_SPHERE, kinds.mjGEOM_ELLIPSOID])
        drawn &= model.geom_bodyid > 0
        count = 1 + int((model.body_mocapid[1:] < 0).sum())
        size = np.array(model.geom_size[drawn], dtype=np.float64)
        kind = model.geom_type[drawn]
        size[kind == kinds.mjGEOM_SPHERE, 1:] = size[kind == kinds.mjGEOM_SPHERE, :1]
        return cls(
            bodies=tuple(model.body(b).name for b in range(1, count)),
            parents=np.array(model.body_parentid[1:count], dtype=np.int32) - 1,
            owner=np.array(model.geom_bodyid[drawn], dtype=np.int32) - 1,
            shapes=Shapes(
                place=np.hstack([model.geom_pos[drawn], model.geom_quat[drawn]]),
                size=size,
                round=kind != kinds.mjGEOM_CAPSULE,
                colour=np.array(model.geom_rgba[drawn, :3], dtype=np.float64),
            ),
        )


@dataclass(frozen=True)
class Joints:
    """j hinges, in the order in which they turn their bodies.

    ``names`` (j,); ``body`` (j,) int32: number of the body that each turns; ``axes`` (j, 3) float64: the unit
    vector in that body's frame that it turns about. ``offsets`` (n, 3) float64 [m]: where each body's origin
    is in the frame of its parent; those of the root are 0. With all angles at 0, all frames are parallel.
    """

    names: tuple[str, ...]
    body: np.ndarray
    axes: np.ndarray
    offsets: np.ndarray


NO_JOINTS = Joints((), np.empty(0, np.int32), np.empty((0, 3)), np.empty((0, 3)))
"""Of a body whose pose is not told by angles."""


def rotate(quaternion: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """``vector`` (..., 3) turned by the unit ``quaternion`` (..., 4), w first; leading shapes broadcast."""
    w, axis = quaternion[..., :1], quaternion[..., 1:]
    twice = 2.0 * np.cross(axis, vector)
    return vector + w * twice + np.cross(axis, twice)


def turn(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The product of two quaternions (..., 4), w first: ``second`` applied, then ``first``."""
    product = np.empty(np.broadcast_shapes(first.shape, second.shape))
    product[..., 0] = first[..., 0] * second[..., 0] - np.sum(first[..., 1:] * second[..., 1:], axis=-1)
    product[..., 1:] = (
        first[..., :1] * second[..., 1:]
        + second[..., :1] * first[..., 1:]
        + np.cross(first[..., 1:], second[..., 1:])
    )
    return product
