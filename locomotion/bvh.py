"""Motion capture files (BVH) read through `bvhio` into plain arrays."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.errors import LocomotionError

__all__ = ["UNITS", "Capture", "read_bvh"]

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
"""Metres per unit of length."""
_TO_Z_UP = {
    "z": np.eye(3),
    "y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "x": np.array([[0.0, 0, -1], [0, 1, 0], [1, 0, 0]]),
}
_TALLEST, _SMALLEST = 3.0, 0.5  # [m] of a figure in its rest pose


@dataclass(frozen=True, eq=False)
class Capture:
    """A captured motion of any skeleton, Z up, in metres.

    Attributes:
        name: of the file. rate: frames per second. joints: names, parents before children.
        parents: (j,) int64, -1 for the root. offsets: (j, 3) float64, from the parent in the rest pose [m].
        root: (n, 3) float64, place of the root [m].
        turns: (n, j, 3, 3) float64, each joint's rotation from its parent, in the axes of the rest pose.
    """

    name: str
    rate: float
    joints: tuple[str, ...]
    parents: NDArray[np.int64]
    offsets: NDArray[np.float64]
    root: NDArray[np.float64]
    turns: NDArray[np.float64]

    def rest_places(self) -> NDArray[np.float64]:
        """Places of the joints in the rest pose, (j, 3) [m], the root at 0."""
        places = np.zeros_like(self.offsets)
        for j, parent in enumerate(self.parents):
            if parent >= 0:
                places[j] = places[parent] + self.offsets[j]
        return places

    def orientations(self) -> NDArray[np.float64]:
        """Rotations of the joints in the world, (n, j, 3, 3)."""
        world = self.turns.copy()
        for j, parent in enumerate(self.parents):
            if parent >= 0:
                world[:, j] = world[:, parent] @ self.turns[:, j]
        return world


def read_bvh(path: str | os.PathLike[str], units: str = "cm", up: str = "y") -> Capture:
    """Read a BVH file whose lengths are in ``units`` (one of `UNITS`) and whose axis ``up`` points up.

    Raises `LocomotionError` for a file that is missing, not BVH, without frames or with numbers that are not
    finite, and for a figure of an impossible size (wrong units).
    """
    try:
        import bvhio
    except ImportError as error:
        how = "in Surefoot's folder, pip install -e '.[clips]'"
        raise LocomotionError(f"reading BVH needs bvhio: {how}") from error
    if units not in UNITS or up not in _TO_Z_UP:
        raise LocomotionError(
            f"units are one of {', '.join(UNITS)} and up is x, y or z, not {units!r} and {up!r}"
        )
    source = Path(path)
    if not source.is_file():
        raise LocomotionError(f"{source}: there is no such file")
    _check_whole(source)
    try:
        found = bvhio.readAsBvh(str(source))
        joints = [(joint, depth) for joint, _, depth in found.Root.layout()]
    except Exception as error:  # bvhio raises whatever its parser meets
        raise LocomotionError(f"{source}: not a BVH file: {error}") from error
    if found.FrameCount < 1 or not found.FrameTime > 0.0:
        raise LocomotionError(
            f"{source}: has {found.FrameCount} frames of {found.FrameTime} s; there must be one at least"
        )
    return _capture(source, found, joints, UNITS[units], _TO_Z_UP[up])


def _check_whole(source: Path) -> None:
    """Raise `LocomotionError` for a file that ends early: bvhio would wait for its next line for ever."""
    try:
        lines = [line.split() for line in source.read_text().splitlines() if line.strip()]
    except UnicodeDecodeError as error:
        raise LocomotionError(f"{source}: not a BVH file: {error}") from error
    if ["MOTION"] not in lines:
        raise LocomotionError(f"{source}: not a BVH file: it has no line MOTION")
    motion = lines.index(["MOTION"])
    words = [word for line in lines[:motion] for word in line]
    if words.count("{") == 0 or words.count("{") != words.count("}"):
        raise LocomotionError(
            f"{source}: not a BVH file: {words.count('{')} braces open before MOTION and"
            f" {words.count('}')} close"
        )
    head, rows = lines[motion + 1 : motion + 3], lines[motion + 3 :]
    if len(head) < 2 or head[0][0] != "Frames:" or not head[0][-1].isdecimal():
        raise LocomotionError(
            f"{source}: not a BVH file: after MOTION come the lines Frames: and Frame Time:"
        )
    if len(rows) < int(head[0][-1]):
        raise LocomotionError(f"{source}: has {len(rows)} of the {head[0][-1]} frames that it names")


def _capture(
    source: Path, found: Any, joints: list[tuple[Any, int]], scale: float, axes: NDArray[np.float64]
) -> Capture:
    """The arrays of what bvhio ``found``, turned by ``axes`` (3, 3) and scaled."""
    parents, last = [], {}
    for number, (_, depth) in enumerate(joints):
        parents.append(last.get(depth - 1, -1))
        last[depth] = number
    short = [joint.Name for joint, _ in joints if len(joint.Keyframes) < found.FrameCount]
    if short:
        raise LocomotionError(f"{source}: joint {short[0]!r} has fewer than {found.FrameCount} frames")
    offsets = scale * np.array([list(joint.Offset) for joint, _ in joints], dtype=np.float64) @ axes.T
    root = scale * np.array([list(key.Position) for key in joints[0][0].Keyframes], dtype=np.float64) @ axes.T
    turns = np.empty((found.FrameCount, len(joints), 3, 3))
    for j, (joint, _) in enumerate(joints):
        quaternions = np.array([[getattr(key.Rotation, axis) for axis in "xyzw"] for key in joint.Keyframes])
        if not np.isfinite(quaternions).all() or not np.isfinite(root).all():
            frame = int(np.flatnonzero(~np.isfinite(np.hstack([quaternions, root])).all(axis=1))[0])
            raise LocomotionError(f"{source}: frame {frame} of {joint.Name!r} is not finite")
        turns[:, j] = axes @ Rotation.from_quat(quaternions).as_matrix() @ axes.T
    capture = Capture(
        source.stem,
        1.0 / found.FrameTime,
        tuple(joint.Name for joint, _ in joints),
        np.array(parents, dtype=np.int64),
        offsets,
        root,
        turns,
    )
    tall = float(np.ptp(capture.rest_places()[:, 2]))
    if not _SMALLEST < tall < _TALLEST:
        raise LocomotionError(
            f"{source}: the figure would be {tall:.3g} m tall from its feet to its head; name other units or "
            "another axis that points up"
        )
    return capture
