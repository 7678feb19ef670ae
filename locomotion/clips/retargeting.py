"""From a captured skeleton to the person: each part takes the direction of the part it is mapped to.

A mapping names, for each part of the person, the joint of the capture that turns it::

    pelvis: Hips
    right_thigh: RightUpLeg
    ...

A joint turns one part at most.

Where the capture stands straight, the limbs' parts lie along its bones and all others stand as in the
person's own rest pose (`locomotion.clips.neutral_pose`); from there each part turns in the world as its joint
does. The hinges of a part take of that what they can, the next part makes up for the rest. The root's way is
scaled by the length of the legs. Lengths, places and facing are those of the frames: what the file's rest
pose looks like does not matter.
"""

import os

import numpy as np
from numpy.typing import NDArray
from pydantic import RootModel
from scipy.spatial.transform import Rotation

from locomotion.body.anatomy import SHANK, THIGH
from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES, JOINT_NAMES
from locomotion.clips.bvh import Capture
from locomotion.clips.motion import Motion, place_on_ground
from locomotion.clips.neutral_pose import LIMBS, SIDES, neutral_axes
from locomotion.errors import LocomotionError
from surefoot.files.yamlfile import FileError, nearest, read_yaml

__all__ = ["NEEDED_PARTS", "load_mapping", "retarget"]

_LIMB_PARTS = ("thigh", "shank", "foot", "upper_arm", "forearm")
NEEDED_PARTS = ("pelvis", "chest", *(f"{side}_{part}" for side in SIDES for part in _LIMB_PARTS))
"""Parts of the person that every mapping names."""
_AXES = "XYZ"
_SHORTEST, _LONGEST = 1e-3, 2.0  # [m] of a limb's bone
_UNDECIDED = 1e-6  # ties between quarter turns do not depend on rounding


class _Mapping(RootModel[dict[str, str]]):
    """Joint of the capture for each part of the person."""


def load_mapping(path: str | os.PathLike[str]) -> dict[str, str]:
    """Read a mapping: joints of a capture for parts of the person (YAML).

    Raises `LocomotionError` for an unreadable file, unknown parts, missing parts that must be mapped, and
    joints mapped to two parts.
    """
    try:
        file, located = read_yaml(path, _Mapping, "mapping of parts to joints")
        mapping = file.root
        if wrong := _wrong(mapping):
            raise located.error(*wrong, at_key=True)
    except FileError as error:
        raise LocomotionError(str(error)) from None
    return mapping


def _wrong(mapping: dict[str, str]) -> tuple[list[str], str] | None:
    """The first mistake in a mapping: the part where it is, if any, and a description."""
    for part in mapping:
        if part not in BODY_NAMES:
            hint = nearest(part, BODY_NAMES)
            return [part], f"no part is called {part!r}; {hint}the parts are {', '.join(BODY_NAMES)}"
    missing = [part for part in NEEDED_PARTS if part not in mapping]
    if missing:
        return [], f"has no joint for {', '.join(missing)}"
    turned: dict[str, str] = {}
    for part, joint in mapping.items():
        other = turned.setdefault(joint, part)
        if other != part:
            free = ", ".join(name for name in BODY_NAMES if name not in NEEDED_PARTS)
            return [part], (
                f"{other} and {part} are both mapped to {joint!r}; a joint turns one part (these may be left"
                f" out: {free})"
            )
    return None


def retarget(capture: Capture, mapping: dict[str, str]) -> Motion:
    """The captured motion on the person, on the ground z = 0. It begins above the origin, and is turned by
    quarter turns so that it faces within 45 degrees of +X there.

    Raises `LocomotionError` for an invalid mapping, joints that are missing or ambiguous in the capture,
    limbs of no length or longer than 2 m, and a figure that stands along an axis that does not point up.
    """
    if wrong := _wrong(mapping):
        raise LocomotionError(f"{capture.name}: the mapping: {wrong[1]}")
    for joint in mapping.values():
        if joint not in capture.joints:
            joints = ", ".join(capture.joints)
            raise LocomotionError(f"{capture.name}: has no joint called {joint!r}; its joints are {joints}")
        if capture.joints.count(joint) > 1:
            raise LocomotionError(f"{capture.name}: has several joints called {joint!r}; name them apart")
    source = {part: capture.joints.index(joint) for part, joint in mapping.items()}
    places, turns = capture.places(), capture.orientations()
    legs = _check_lengths(capture, places, source)
    axes = neutral_axes(capture, places, source)
    facing = _facing(turns[:, source["pelvis"]] @ axes["pelvis"])
    wanted = {part: facing @ turns[:, j] @ axes[part] for part, j in source.items()}

    model = figure()
    qpos = np.zeros((len(capture.root), 7 + len(JOINT_NAMES)))
    achieved: dict[int, NDArray[np.float64]] = {}
    for body in range(1, model.nbody):
        name, parent = model.body(body).name, int(model.body_parentid[body])
        if name not in BODY_NAMES:
            continue
        if name == "pelvis":
            achieved[body] = wanted[name]
            qpos[:, 3:7] = Rotation.from_matrix(wanted[name]).as_quat(scalar_first=True)
            continue
        above, hinges = achieved[parent], np.flatnonzero(model.jnt_bodyid == body)
        if name in wanted:
            relative = np.swapaxes(above, 1, 2) @ wanted[name]
            qpos[:, model.jnt_qposadr[hinges]] = _hinge_angles(relative, model.jnt_axis[hinges])
        turned = above
        for hinge in hinges:
            angles = qpos[:, model.jnt_qposadr[hinge]]
            turned = turned @ Rotation.from_rotvec(np.outer(angles, model.jnt_axis[hinge])).as_matrix()
        achieved[body] = turned
    hinges = model.jnt_qposadr[1:]
    qpos[:, hinges] = np.unwrap(qpos[:, hinges], axis=0)
    way = 0.5 * (places[:, source["right_thigh"]] + places[:, source["left_thigh"]]) @ facing.T
    qpos[:, :3] = 2.0 * (THIGH + SHANK) / legs * (way - [*way[0, :2], 0.0])
    return Motion(capture.name, capture.rate, place_on_ground(qpos))


def _check_lengths(capture: Capture, places: NDArray[np.float64], source: dict[str, int]) -> float:
    """Length [m] of both legs together. Raises `LocomotionError` for limbs of no or impossible length, and
    for hips that coincide; ``places`` (n, j, 3) [m]: of the joints in each frame."""

    def apart(one: str, other: str) -> float:
        return float(np.linalg.norm(places[:, source[other]] - places[:, source[one]], axis=1).mean())

    bones = [(f"{side}_{a}", f"{side}_{b}") for side in SIDES for a, b in LIMBS.items()]
    legs = 0.0
    for a, b in bones:
        if b not in source:
            continue
        length = apart(a, b)
        if not _SHORTEST <= length <= _LONGEST:
            raise LocomotionError(
                f"{capture.name}: joint {capture.joints[source[b]]!r} ({b}) is {length:.3g} m from"
                f" {capture.joints[source[a]]!r} ({a}); a {a} is {_SHORTEST:g} to {_LONGEST:g} m long"
            )
        legs += length if a.endswith(("thigh", "shank")) else 0.0
    if apart("right_thigh", "left_thigh") < _SHORTEST:
        right, left = (capture.joints[source[f"{side}_thigh"]] for side in SIDES)
        raise LocomotionError(
            f"{capture.name}: the hips {right!r} and {left!r} are not beside each other, so that it faces"
            " nowhere; map other joints"
        )
    return legs


def _facing(pelvis: NDArray[np.float64]) -> NDArray[np.float64]:
    """Quarter turn (3, 3) about z that brings the direction in which the pelvis, (n, 3, 3), faces nearest to
    +X in the first frame in which its sides are more beside than above each other; without such a frame,
    the direction of its upper end in the first frame.
    """
    left = pelvis[:, :, 1]
    beside = np.flatnonzero(np.abs(left[:, 2]) < np.sqrt(0.5))
    x, y = (left[beside[0], 1], -left[beside[0], 0]) if len(beside) else pelvis[0, :2, 2]
    quarters = np.round(np.arctan2(y, x) / (0.5 * np.pi) - _UNDECIDED)
    return Rotation.from_euler("z", -90.0 * quarters, degrees=True).as_matrix().round()


def _hinge_angles(relative: NDArray[np.float64], axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles (n, k) [rad] of k hinges in series about ``axes`` (k, 3) (signed coordinate axes) that turn a
    part as nearly as ``relative`` (n, 3, 3) as they can."""
    turn = Rotation.from_matrix(relative)
    if len(axes) == 1:
        x, y, z, w = turn.as_quat().T
        along = np.stack([x, y, z], axis=1) @ axes[0]
        return ((2.0 * np.arctan2(along, w) + np.pi) % (2.0 * np.pi) - np.pi)[:, None]
    which = [int(np.argmax(np.abs(axis))) for axis in axes]
    order = which + [k for k in range(3) if k not in which]
    angles = turn.as_euler("".join(_AXES[k] for k in order), suppress_warnings=True)[:, : len(axes)]
    return angles * axes[np.arange(len(axes)), which]
