"""How a captured skeleton's joints are turned against the person's, whatever its rest pose is.

A joint of a capture turns a part of the person, but its axes are those of the file's rest pose. In that the
figure may stand, lie, or be in no possible pose at all. What the axes mean for the part is read from a pose
in which the figure stands straight: there its limbs lie along the capture's bones, and all other parts are as
in the person's own rest pose. This is the file's rest pose if the figure stands along any axis of the file,
else the frame in which it stands straightest. If there is none, the axes are measured on the limbs, averaged
over the motion.
"""

from itertools import product

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.clips.bvh import Capture
from locomotion.clips.measured_axes import measured_axes
from locomotion.errors import LocomotionError

__all__ = ["LIMBS", "SIDES", "neutral_axes"]

SIDES = ("right", "left")
LIMBS = {"thigh": "shank", "shank": "foot", "upper_arm": "forearm", "forearm": "hand"}
"""Parts that are bones, and the part at the end of each."""
_STRAIGHT = np.radians(30.0)  # largest lean of trunk, thighs and shanks in a standing rest pose
_STILL = np.radians(20.0)  # the same in a frame; walking people do not pass
_AXES = tuple(
    np.array(axis) for axis in ((0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 0, -1), (0, -1, 0), (-1, 0, 0))
)
_ALIKE = 1e-3  # [rad] differences of lean below this do not count
_LEVEL = np.sin(np.radians(60.0))  # allowed height difference of the hips, relative to their distance


def neutral_axes(
    capture: Capture, places: NDArray[np.float64], source: dict[str, int]
) -> dict[str, NDArray[np.float64]]:
    """The axes of each part, (3, 3), in the axes of the joint that turns it.

    places (n, j, 3) [m]: position of the joints in each frame. source: index of the joint, by part. Raises
    `LocomotionError` if rest pose and frames stand along an axis other than the one that points up.
    """
    leaning = _leans(places, _AXES[0], source)
    rest = capture.rest_places()
    for up in _AXES:
        if _leans(rest[None], up, source)[0] < _STRAIGHT:
            if (
                leaning.min() >= _STRAIGHT
                and up is not _AXES[0]
                and _leans(places, up, source).min() < _STRAIGHT
            ):
                raise LocomotionError(
                    f"{capture.name}: its rest pose and its frames stand along another axis than the one that"
                    " is said to point up; name that"
                )
            turns = np.broadcast_to(np.eye(3), (len(rest), 3, 3))
            return _axes(rest, turns, _upright(up), source)
    frame = int(np.flatnonzero(leaning <= leaning.min() + _ALIKE)[0])
    if leaning[frame] >= _STILL:
        return measured_axes(places, capture.orientations(), source)
    return _axes(places[frame], capture.orientations()[frame], np.eye(3), source)


def _leans(
    places: NDArray[np.float64], up: NDArray[np.float64], source: dict[str, int]
) -> NDArray[np.float64]:
    """Largest lean [rad] of the trunk, a thigh or a shank in each of the poses (n, j, 3); infinite if one hip
    is above the other."""
    right, left = places[:, source["right_thigh"]], places[:, source["left_thigh"]]
    bones = [places[:, source["chest"]] - 0.5 * (right + left)]
    for side, (above, below) in product(SIDES, (("thigh", "shank"), ("shank", "foot"))):
        bones.append(places[:, source[f"{side}_{above}"]] - places[:, source[f"{side}_{below}"]])
    angles = [np.arctan2(np.linalg.norm(np.cross(up, bone), axis=1), bone @ up) for bone in bones]
    across = left - right
    level = np.abs(across @ up) <= _LEVEL * np.linalg.norm(across, axis=1)
    return np.where(level, np.max(angles, axis=0), np.inf)


def _upright(up: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotation (3, 3) that turns a coordinate axis ``up`` to z."""
    if up[2]:
        return np.diag([1.0, up[2], up[2]])
    other = np.cross(up, [0.0, 0.0, 1.0])
    return np.array([other, np.cross(up, other), up], dtype=np.float64)


def _axes(
    places: NDArray[np.float64],
    turns: NDArray[np.float64],
    upright: NDArray[np.float64],
    source: dict[str, int],
) -> dict[str, NDArray[np.float64]]:
    """`neutral_axes` from a pose that stands once turned by ``upright`` (3, 3): places (j, 3) and
    orientations (j, 3, 3) of the joints."""
    stands = places @ upright.T
    left = stands[source["left_thigh"]] - stands[source["right_thigh"]]
    ahead = Rotation.from_euler("z", -np.arctan2(-left[0], left[1])).as_matrix() @ upright
    stands = places @ ahead.T
    return {part: turns[j].T @ ahead.T @ _standing(part, stands, source) for part, j in source.items()}


def _standing(part: str, places: NDArray[np.float64], source: dict[str, int]) -> NDArray[np.float64]:
    """Orientation (3, 3) of a part of the person in a pose that stands and faces +X."""
    side, _, kind = part.partition("_")
    if kind == "hand":  # in line with the forearm
        kind, part = "forearm", f"{side}_forearm"
    child = f"{side}_{LIMBS.get(kind, '')}"
    if side not in SIDES or child not in source or part not in source:
        return np.eye(3)
    bone = places[source[child]] - places[source[part]]
    return Rotation.align_vectors(bone / np.linalg.norm(bone), [0.0, 0.0, -1.0])[0].as_matrix()
