"""Captured motion of any skeleton, from BVH files."""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.clips.bvh_file import BvhFile, read_bvh_file
from locomotion.errors import LocomotionError

__all__ = ["UNITS", "Capture", "read_bvh"]

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}
"""Metres per unit of length."""
_TO_Z_UP = {
    "z": np.eye(3),
    "y": np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]]),
    "x": np.array([[0.0, 0, -1], [0, 1, 0], [1, 0, 0]]),
}
_TALLEST, _SMALLEST = 3.0, 0.5  # [m] of a figure
_FLAT = 0.05  # of its height: no figure is flatter


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

    def places(self) -> NDArray[np.float64]:
        """Places of the joints in each frame, (n, j, 3) [m]."""
        world = self.orientations()
        places = np.empty((len(self.root), *self.offsets.shape))
        for j, parent in enumerate(self.parents):
            if parent >= 0:
                places[:, j] = places[:, parent] + world[:, parent] @ self.offsets[j]
            else:
                places[:, j] = self.root
        return places

    def height(self) -> float:
        """How tall [m] the figure is, by the lengths of its bones: what its rest pose looks like does not
        matter. From a foot to a hand, the longest chain of a person, it is as much longer as one thigh."""
        lengths = np.linalg.norm(self.offsets, axis=1)
        reach, longest = np.zeros((len(lengths), 2)), 0.0  # of what hangs on each joint: length, longest bone
        for j in range(len(lengths) - 1, 0, -1):
            parent = self.parents[j]
            down = np.array([reach[j, 0] + lengths[j], max(reach[j, 1], lengths[j])])
            longest = max(longest, reach[parent, 0] + down[0] - max(reach[parent, 1], down[1]))
            if down[0] > reach[parent, 0]:
                reach[parent] = down
        return float(longest)

    def orientations(self) -> NDArray[np.float64]:
        """Rotations of the joints in the world, (n, j, 3, 3)."""
        world = self.turns.copy()
        for j, parent in enumerate(self.parents):
            if parent >= 0:
                world[:, j] = world[:, parent] @ self.turns[:, j]
        return world


def read_bvh(path: str | os.PathLike[str], units: str = "cm", up: str = "y") -> Capture:
    """Read a BVH file whose lengths are in ``units`` (one of `UNITS`) and whose axis ``up`` points up.

    Raises `LocomotionError` for a file that is missing or that `bvh_file.read_bvh_file` refuses, naming the
    line, and for a figure of an impossible size (wrong units) or one that is flat in all frames (wrong axis).
    """
    if units not in UNITS or up not in _TO_Z_UP:
        raise LocomotionError(
            f"units are one of {', '.join(UNITS)} and up is x, y or z, not {units!r} and {up!r}"
        )
    source = Path(path)
    if not source.is_file():
        raise LocomotionError(f"{source}: there is no such file")
    capture = _capture(source.stem, read_bvh_file(source), UNITS[units], _TO_Z_UP[up])
    tall = capture.height()
    if not _SMALLEST < tall < _TALLEST:
        raise LocomotionError(
            f"{source}: the figure would be {tall:.3g} m tall by the lengths of its bones; name other units"
        )
    if np.ptp(capture.places()[:, :, 2], axis=1).max() < _FLAT * tall:
        raise LocomotionError(
            f"{source}: the figure is flat in every frame; name another axis that points up"
        )
    return capture


def _capture(name: str, file: BvhFile, scale: float, axes: NDArray[np.float64]) -> Capture:
    """What a ``file`` holds, turned by ``axes`` (3, 3) and scaled."""
    root = np.tile(np.array(file.offsets[0]), (len(file.frames), 1))
    turns = np.empty((len(file.frames), len(file.names), 3, 3))
    column = 0
    for j, channels in enumerate(file.channels):
        values = file.frames[:, column : column + len(channels)]
        column += len(channels)
        about = [k for k, channel in enumerate(channels) if channel.endswith("rotation")]
        turn = Rotation.identity(len(values))
        if about:
            order = "".join(channels[k][0] for k in about)  # upper case: about axes that turn along
            turn = Rotation.from_euler(order, values[:, about], degrees=True)
        turns[:, j] = axes @ turn.as_matrix() @ axes.T
        if j == 0:
            for k, channel in enumerate(channels):
                if channel.endswith("position"):
                    root[:, "XYZ".index(channel[0])] = values[:, k]
    return Capture(
        name,
        1.0 / file.frame_time,
        tuple(file.names),
        np.array(file.parents, dtype=np.int64),
        scale * np.array(file.offsets) @ axes.T,
        scale * root @ axes.T,
        turns,
    )
