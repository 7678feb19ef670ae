"""From a captured skeleton to the person: each part takes the direction of the part it is mapped to.

A mapping names, for each part of the person, the joint of the capture that turns it::

    pelvis: Hips
    right_thigh: RightUpLeg
    ...

In the capture's rest pose the limbs' parts lie along the capture's bones and all others stand as in the
person's own rest pose; from there each part turns in the world as its joint does. The hinges of a part take
of that what they can, the next part makes up for the rest. The root's way is scaled by the length of the
legs.
"""

import os
from pathlib import Path

import numpy as np
import yaml
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.anatomy import SHANK, THIGH
from locomotion.bvh import Capture
from locomotion.errors import LocomotionError
from locomotion.motion import Motion, place_on_ground
from locomotion.person import BODY_NAMES, JOINT_NAMES, person_spec

__all__ = ["load_mapping", "retarget"]

_SIDES = ("right", "left")
_LIMB_PARTS = ("thigh", "shank", "foot", "upper_arm", "forearm")
_NEEDED = ("pelvis", "chest", *(f"{side}_{part}" for side in _SIDES for part in _LIMB_PARTS))
_LIMBS = {"thigh": "shank", "shank": "foot", "upper_arm": "forearm", "forearm": "hand"}
_AXES = "XYZ"


def load_mapping(path: str | os.PathLike[str]) -> dict[str, str]:
    """Read a mapping: joints of a capture by parts of the person (YAML).

    Raises `LocomotionError` for a file that cannot be read, parts that the person does not have, and parts
    that must be mapped and are not.
    """
    source = Path(path)
    try:
        data = yaml.safe_load(source.read_text(encoding="utf-8"))
    except OSError as error:
        raise LocomotionError(f"{source}: cannot be read: {error.strerror}") from error
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise LocomotionError(f"{source}: not YAML: {error}") from error
    if not isinstance(data, dict) or not all(isinstance(v, str) for v in data.values()):
        raise LocomotionError(f"{source}: must map parts of the person to names of joints")
    unknown = [str(name) for name in data if name not in BODY_NAMES]
    if unknown:
        parts = ", ".join(BODY_NAMES)
        raise LocomotionError(f"{source}: no part is called {unknown[0]!r}; the parts are {parts}")
    missing = [name for name in _NEEDED if name not in data]
    if missing:
        raise LocomotionError(f"{source}: says no joint for {', '.join(missing)}")
    return data


def retarget(capture: Capture, mapping: dict[str, str]) -> Motion:
    """The captured motion on the person, standing on the ground z = 0 and facing +X in its rest pose.

    Raises `LocomotionError` for joints that the capture does not have.
    """
    missing = [joint for joint in mapping.values() if joint not in capture.joints]
    if missing:
        raise LocomotionError(
            f"{capture.name}: has no joint called {missing[0]!r}; its joints are {', '.join(capture.joints)}"
        )
    source = {part: capture.joints.index(joint) for part, joint in mapping.items()}
    places = capture.rest_places()
    facing = _facing(places, source)
    world = facing @ capture.orientations() @ facing.T
    places = places @ facing.T
    wanted = {part: world[:, j] @ _rest(part, places, source) for part, j in source.items()}

    model = person_spec().compile()
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
    pairs = (("thigh", "shank"), ("shank", "foot"))
    bones = [(f"{side}_{a}", f"{side}_{b}") for side in _SIDES for a, b in pairs]
    legs = sum(float(np.linalg.norm(places[source[b]] - places[source[a]])) for a, b in bones)
    hips = 0.5 * (places[source["right_thigh"]] + places[source["left_thigh"]])
    way = capture.root @ facing.T + world[:, source["pelvis"]] @ (hips - places[source["pelvis"]])
    qpos[:, :3] = 2.0 * (THIGH + SHANK) / legs * (way - [*way[0, :2], 0.0])
    return Motion(capture.name, capture.rate, place_on_ground(qpos))


def _facing(places: NDArray[np.float64], source: dict[str, int]) -> NDArray[np.float64]:
    """Rotation (3, 3) about z that turns the way the rest pose faces to +X: at right angles to its hips."""
    left = places[source["left_thigh"]] - places[source["right_thigh"]]
    return Rotation.from_euler("z", -np.arctan2(-left[0], left[1])).as_matrix()


def _rest(part: str, places: NDArray[np.float64], source: dict[str, int]) -> NDArray[np.float64]:
    """Orientation (3, 3) of a part of the person in the rest pose of the capture, facing +X."""
    side, _, kind = part.partition("_")
    if kind == "hand":  # straight on from the forearm
        kind, part = "forearm", f"{side}_forearm"
    child = f"{side}_{_LIMBS.get(kind, '')}"
    if side not in _SIDES or child not in source or part not in source:
        return np.eye(3)
    bone = places[source[child]] - places[source[part]]
    return Rotation.align_vectors(bone / np.linalg.norm(bone), [0.0, 0.0, -1.0])[0].as_matrix()


def _hinge_angles(relative: NDArray[np.float64], axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles (n, k) [rad] of k hinges, one after another about ``axes`` (k, 3) (signed coordinate axes), that
    turn a part as ``relative`` (n, 3, 3) as nearly as they can."""
    turn = Rotation.from_matrix(relative)
    if len(axes) == 1:
        x, y, z, w = turn.as_quat().T
        along = np.stack([x, y, z], axis=1) @ axes[0]
        return ((2.0 * np.arctan2(along, w) + np.pi) % (2.0 * np.pi) - np.pi)[:, None]
    which = [int(np.argmax(np.abs(axis))) for axis in axes]
    order = which + [k for k in range(3) if k not in which]
    angles = turn.as_euler("".join(_AXES[k] for k in order), suppress_warnings=True)[:, : len(axes)]
    return angles * axes[np.arange(len(axes)), which]
