"""A character's rest pose, turned to the person's: standing, facing +X, arms and legs straight down.

Every bone that shows a part of the person gets the orientation that it has when the person stands like that.
From there it turns in the world as its part does. So T-poses, A-poses and bones along any axis come to the
same. Limbs are turned by the least rotation that brings their bone to point down, feet by one about the
vertical that makes them point ahead; trunk, shoulders and head stay as they rest.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.characters.character_file import Skeleton
from locomotion.errors import LocomotionError

__all__ = ["RestPose", "hand_points", "rest_pose"]

_DOWN = np.array([0.0, 0.0, -1.0])
_LIMBS = {"thigh": "shank", "shank": "foot", "upper_arm": "forearm", "forearm": "hand"}
_STEEPEST = np.radians(60.0)  # that the legs may stand apart from straight down
_LEAST, _MOST = 0.05, 20.0  # [m] length of a leg
_SIDES = ("right", "left")
_LOWER_ARM = 0.2626 / 0.275  # a forearm relative to the upper arm, as the person's
_HAND = 0.115 / 0.2626  # a hand's point from the wrist, relative to the forearm, as the person's
_ANKLE, _HEEL, _TIP = 0.077, 0.067, 0.227  # of a foot without a mesh, relative to the leg, as the person's
_BALL = 0.66  # of a foot without toes, relative to its tip
_LOW = 0.85  # share of the ankle's height below which points are of the sole
_CORNERS = 24
"""Points of a foot's hull that are kept."""


@dataclass(frozen=True, eq=False)
class RestPose:
    """A character as it stands like the person in its neutral pose; lengths in metres, x ahead, y left, z up.

    Attributes:
        aligned: (b, 4) float64 wxyz, the bones' orientations in that pose where the parts' own are the
            identity; of bones that show no part as they rest.
        facing: (3, 3) rotation about z from the file to +X.
        middle: (3,) from the pelvis' bone to the middle between the hips.
        thigh, shank, upper_arm, forearm: (2,) lengths of the right and the left one. ankle: its height above
            the sole. half_width: half the distance of the hips.
        hands: (2, 3) from each wrist to the point of the hand that holds on; right, left.
        feet, toes: (2, k, 3) points around each foot and its toes, from the ankle and from the toes' joint.
        joint: (2, 3) from each ankle to the joint of the toes, or to the tip of a foot without toes.
        has_toes: whether the toes have bones.
    """

    aligned: NDArray[np.float64]
    facing: NDArray[np.float64]
    middle: NDArray[np.float64]
    thigh: NDArray[np.float64]
    shank: NDArray[np.float64]
    ankle: float
    half_width: float
    upper_arm: NDArray[np.float64]
    forearm: NDArray[np.float64]
    hands: NDArray[np.float64]
    feet: NDArray[np.float64]
    toes: NDArray[np.float64]
    joint: NDArray[np.float64]
    has_toes: bool


def rest_pose(skeleton: Skeleton, parts: dict[str, int]) -> RestPose:
    """Measure a character; ``parts``: the bone of each part.

    Raises `LocomotionError` for limbs without a length, a figure that does not stand upright at rest, is not
    0.05 to 20 m from hip to sole, or has its feet turned backwards, as if left and right were exchanged.
    """
    facing, at = _facing(skeleton, parts)
    length = {
        limb: np.array([_apart(skeleton, parts, at, f"{side}_{limb}") for side in _SIDES])
        for limb in ("thigh", "shank", "upper_arm")
    }
    length["forearm"] = _LOWER_ARM * length["upper_arm"]
    if all(f"{side}_hand" in parts for side in _SIDES):
        length["forearm"] = np.array([_apart(skeleton, parts, at, f"{side}_forearm") for side in _SIDES])
    leg = float((length["thigh"] + length["shank"]).mean())
    if not _LEAST <= leg <= _MOST:
        raise LocomotionError(
            f"{skeleton.path}: its legs are {leg:.3g} m long; if the file is in other units than metres, say"
            " so with scale, such as scale=0.01 for centimetres"
        )
    for side in _SIDES:
        for limb in ("thigh", "shank"):
            bone = at[parts[f"{side}_{_LIMBS[limb]}"]] - at[parts[f"{side}_{limb}"]]
            if -bone[2] < np.cos(_STEEPEST) * np.linalg.norm(bone):
                name = skeleton.names[parts[f"{side}_{limb}"]]
                raise LocomotionError(
                    f"{skeleton.path}: bone {name!r} ({side}_{limb}) does not point down at rest; export the"
                    " figure standing in a T-pose or an A-pose, with Y up as glTF has it"
                )
    _check_sides(skeleton, parts, at)
    has_toes = all(f"{side}_toes" in parts for side in _SIDES)
    turns = {part: _alignment(skeleton, parts, at, part) for part in parts}
    for side in _SIDES:
        turns[f"{side}_foot"] = turns[f"{side}_toes"] = _foot_ahead(skeleton, parts, at, side)
    aligned = Rotation.from_quat(skeleton.places[:, 3:], scalar_first=True).as_matrix()
    for part, bone in parts.items():
        aligned[bone] = turns[part] @ facing @ aligned[bone]
    feet, toes, joint, ankle = _feet(skeleton, parts, at, turns, leg)
    hips = [at[parts[f"{side}_thigh"]] for side in _SIDES]
    return RestPose(
        Rotation.from_matrix(aligned).as_quat(scalar_first=True), facing,
        0.5 * (hips[0] + hips[1]) - at[parts["pelvis"]],
        length["thigh"], length["shank"], ankle, 0.5 * float(np.linalg.norm(hips[1] - hips[0])),
        length["upper_arm"], length["forearm"], _hands(skeleton, parts, at, turns, length["forearm"]),
        feet, toes, joint, has_toes,
    )  # fmt: skip


def hand_points(skeleton: Skeleton, parts: dict[str, int], rest: RestPose) -> NDArray[np.float64]:
    """(2, 3) `RestPose.hands` in the axes of the hands' bones; NaN without a hand."""
    found = np.full((2, 3), np.nan)
    for k, side in enumerate(_SIDES):
        if f"{side}_hand" in parts:
            aligned = Rotation.from_quat(rest.aligned[parts[f"{side}_hand"]], scalar_first=True)
            found[k] = aligned.inv().apply(rest.hands[k])
    return found


def _facing(skeleton: Skeleton, parts: dict[str, int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The rotation about the vertical (3, 3) that makes the character face +X, and where its bones are (b, 3)
    then."""
    at = skeleton.places[:, :3]
    left = at[parts["left_thigh"]] - at[parts["right_thigh"]]
    if np.linalg.norm(left[:2]) < 1e-3 * max(np.ptp(at, axis=0).max(), 1e-9):
        raise LocomotionError(
            f"{skeleton.path}: its hips are not beside each other at rest, so that it faces nowhere; export"
            " it standing, with Y up as glTF has it"
        )
    facing = Rotation.from_euler("z", -np.arctan2(-left[0], left[1])).as_matrix()
    at = at @ facing.T
    return facing, at


def _check_sides(skeleton: Skeleton, parts: dict[str, int], at: NDArray[np.float64]) -> None:
    for side in _SIDES:
        toes = parts.get(f"{side}_toes")
        foot = parts[f"{side}_foot"]
        if toes is not None and at[toes, 0] < at[foot, 0]:
            raise LocomotionError(
                f"{skeleton.path}: bone {skeleton.names[toes]!r} is behind {skeleton.names[foot]!r}; left and"
                " right are exchanged in the mapping or in the names"
            )


def _apart(skeleton: Skeleton, parts: dict[str, int], at: NDArray[np.float64], part: str) -> float:
    """Length of a limb's bone [m]."""
    side, _, limb = part.partition("_")
    below = f"{side}_{_LIMBS[limb]}"
    length = float(np.linalg.norm(at[parts[below]] - at[parts[part]]))
    if length < 1e-4 * max(np.ptp(at, axis=0).max(), 1e-9):
        one, other = skeleton.names[parts[part]], skeleton.names[parts[below]]
        raise LocomotionError(f"{skeleton.path}: bones {one!r} ({part}) and {other!r} ({below}) coincide")
    return length


def _alignment(
    skeleton: Skeleton, parts: dict[str, int], at: NDArray[np.float64], part: str
) -> NDArray[np.float64]:
    """The rotation (3, 3) of a part from where it rests to where the person's is at rest."""
    side, _, limb = part.partition("_")
    if limb == "hand":  # in line with the forearm, as it rests
        limb, part = "forearm", f"{side}_forearm"
    below = f"{side}_{_LIMBS.get(limb, '')}"
    if side not in _SIDES or part not in parts or below not in parts:
        return np.eye(3)
    _apart(skeleton, parts, at, part)
    return _least_turn(at[parts[below]] - at[parts[part]], _DOWN)


def _least_turn(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    """The rotation (3, 3) by the least angle from a direction to another."""
    one = one / np.linalg.norm(one)
    axis, along = np.cross(one, other), float(one @ other)
    if along < -1.0 + 1e-9:  # straight up: turn about the axis from side to side
        return np.diag([-1.0, 1.0, -1.0])
    sine = np.linalg.norm(axis)
    if sine < 1e-12:
        return np.eye(3)
    return Rotation.from_rotvec(axis / sine * np.arctan2(sine, along)).as_matrix()


def _foot_ahead(
    skeleton: Skeleton, parts: dict[str, int], at: NDArray[np.float64], side: str
) -> NDArray[np.float64]:
    """The rotation (3, 3) about the vertical that makes a foot point ahead."""
    if f"{side}_toes" in parts:
        ahead = at[parts[f"{side}_toes"]] - at[parts[f"{side}_foot"]]
    else:
        own = _points_of(skeleton, parts, f"{side}_foot", at, None)
        ahead = own.mean(axis=0) if len(own) else np.array([1.0, 0.0, 0.0])
    if ahead[0] < 0.5 * np.linalg.norm(ahead[:2]):  # a stump, or a ball of a foot
        return np.eye(3)
    return Rotation.from_euler("z", -np.arctan2(ahead[1], ahead[0])).as_matrix()


def _points_of(
    skeleton: Skeleton, parts: dict[str, int], part: str, at: NDArray[np.float64], but: str | None
) -> NDArray[np.float64]:
    """(k, 3) the points of the mesh that hang mostly on a part's bone or on what hangs on that, but not on
    the bone of another part; from the bone."""
    bones = _below(skeleton, parts[part])
    if but is not None and but in parts:
        bones &= ~_below(skeleton, parts[but])
    mesh = skeleton.mesh
    most = mesh.bones[np.arange(len(mesh.bones)), mesh.shares.argmax(axis=1)]
    facing, _ = _facing(skeleton, parts)
    return mesh.points[bones[most]] @ facing.T - at[parts[part]]


def _below(skeleton: Skeleton, bone: int) -> NDArray[np.bool_]:
    """(b,) a bone and all that hangs on it."""
    found = np.zeros(len(skeleton.parents), bool)
    found[bone] = True
    for b in range(bone + 1, len(found)):
        found[b] |= skeleton.parents[b] >= 0 and found[skeleton.parents[b]]
    return found


def _feet(
    skeleton: Skeleton,
    parts: dict[str, int],
    at: NDArray[np.float64],
    turns: dict[str, NDArray[np.float64]],
    leg: float,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], float]:
    """Points of the feet and of the toes (2, k, 3), the toes' joints (2, 3), height of the ankles."""
    feet, toes, joints, ankles = [], [], [], []
    for side in _SIDES:
        turn = turns[f"{side}_foot"]
        foot = _points_of(skeleton, parts, f"{side}_foot", at, f"{side}_toes") @ turn.T
        has_toes = f"{side}_toes" in parts
        toe = np.empty((0, 3))
        joint = np.zeros(3)
        if has_toes:
            joint = turn @ (at[parts[f"{side}_toes"]] - at[parts[f"{side}_foot"]])
            toe = _points_of(skeleton, parts, f"{side}_toes", at, None) @ turn.T
        if len(foot) < 4:
            low = min(-_ANKLE * leg, float(joint[2]))
            end = joint[0] if has_toes else _TIP * leg
            foot = np.array([[x, y, low] for x in (-_HEEL * leg, end) for y in (-0.02 * leg, 0.02 * leg)])
        sole = float(min(foot[:, 2].min(), (toe + joint)[:, 2].min(initial=0.0)))
        if not has_toes:
            low = foot[foot[:, 2] < _LOW * sole]
            joint = np.array([low[:, 0].max(), 0.0, sole])
        if has_toes and len(toe) < 4:
            low = sole - joint[2]
            toe = np.array([[x, y, low] for x in (0.0, 0.5 * joint[0]) for y in (-0.02 * leg, 0.02 * leg)])
        feet.append(_corners(foot))
        toes.append(_corners(toe) if has_toes else np.full((_CORNERS, 3), np.nan))
        joints.append(joint)
        ankles.append(-sole)
    return np.array(feet), np.array(toes), np.array(joints), float(np.mean(ankles))


def _corners(points: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k, 3) of the points those that are outermost in k directions, mostly downwards."""
    turn = np.arange(8) * 0.25 * np.pi
    directions = [
        [np.cos(a) * np.sin(down), np.sin(a) * np.sin(down), -np.cos(down)]
        for down in (np.radians(8.0), np.radians(30.0), np.radians(60.0))
        for a in turn
    ]
    return points[np.argmax(points @ np.array(directions).T, axis=0)]


def _hands(
    skeleton: Skeleton,
    parts: dict[str, int],
    at: NDArray[np.float64],
    turns: dict[str, NDArray[np.float64]],
    forearm: NDArray[np.float64],
) -> NDArray[np.float64]:
    """(2, 3) from each wrist to the point of the hand that holds: as far as the person's, or as the hand's
    points reach."""
    found = np.outer(_HAND * forearm, _DOWN)
    for k, side in enumerate(_SIDES):
        if f"{side}_hand" in parts:
            own = _points_of(skeleton, parts, f"{side}_hand", at, None) @ turns[f"{side}_hand"].T
            if len(own):
                found[k, 2] = max(found[k, 2], 0.9 * float(own[:, 2].min()))
    return found
