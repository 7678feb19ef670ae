"""Which bones of a character follow which bodies of the person, as arrays for `locomotion.characters.posing`.

A bone follows one body, or stands between two: spines between pelvis, waist and chest, necks between chest
and head, bones along a forearm between the forearm as the elbow leaves it and as it is twisted. Bones that
show nothing keep their rest rotation relative to their parent; those that do not hang on the pelvis stay as
they rest, below, above or beside it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.body.person import BODY_NAMES
from locomotion.characters.character_file import Skeleton
from locomotion.characters.person_measures import person_arrays
from locomotion.characters.rest_pose import RestPose

__all__ = ["BESIDE", "DRIVEN", "RESTING", "SOURCES", "RigArrays", "rig_arrays"]

SOURCES = (*BODY_NAMES, "right_forearm untwisted", "left_forearm untwisted")
"""What bones follow: the person's bodies, and its forearms without their twist."""
RESTING, DRIVEN, BESIDE = 0, 1, 2
"""Bones that keep their rest rotation relative to the parent; that follow; that do not hang on the pelvis."""
_HALF_TWISTED = 0.5  # share of the twist of a forearm's only bone: the rest is left to the wrist
_SIDES = ("right", "left")
_TWISTS = ("twist", "roll")


class RigArrays(NamedTuple):
    """A character as kernels take it; of pairs the right one is first."""

    parents: np.ndarray
    """(b,) int64, -1 for none"""
    rest: np.ndarray
    """(b, 7) position [m] and quaternion wxyz relative to the parent; of `BESIDE` relative to the pelvis'
    bone, unturned"""
    kinds: np.ndarray
    """(b,) int64"""
    sources: np.ndarray
    """(b, 2) int64 into `SOURCES`"""
    shares: np.ndarray
    """(b,) of the second source"""
    aligned: np.ndarray
    """(b, 4) orientation where the sources are the identity"""
    pelvis: int
    limbs: np.ndarray
    """(2, 2) int64: the bones of the thighs, then of the upper arms"""
    lengths: np.ndarray
    """(4, 2) [m]: thighs, shanks, upper arms, forearms"""
    middle: np.ndarray
    """(3,) [m] from the pelvis' bone to the middle between the hips"""
    scale: float
    """of the leg to the person's"""
    beside: float
    """[m] how much further out than the person's the feet stand"""
    feet: np.ndarray
    """(2, k, 3) [m] points around the foot from the ankle"""
    toes: np.ndarray
    """(2, k, 3) [m] points around the toes from their joint; (2, 0, 3) without toes"""
    joints: np.ndarray
    """(2, 3) [m] from the ankle to the joint of the toes, or to the tip of a foot without toes"""
    hands: np.ndarray
    """(2, 3) [m] from the wrist to the hand's point"""


def rig_arrays(skeleton: Skeleton, parts: dict[str, int], rest: RestPose) -> RigArrays:
    """The arrays of a character with the bones ``parts``."""
    person = person_arrays()
    count = len(skeleton.names)
    kinds = np.full(count, RESTING)
    sources, shares = np.zeros((count, 2), np.int64), np.zeros(count)
    aligned = rest.aligned.copy()
    hips = parts["pelvis"]
    below = _hanging(skeleton.parents, hips)
    kinds[~below] = BESIDE

    def follow(bone: int, one: str, other: str, share: float) -> None:
        kinds[bone], shares[bone] = DRIVEN, share
        sources[bone] = SOURCES.index(one), SOURCES.index(other)

    def turned(bone: int, turn: NDArray[np.float64]) -> None:
        own = Rotation.from_quat(skeleton.places[bone, 3:], scalar_first=True)
        aligned[bone] = (Rotation.from_matrix(turn @ rest.facing) * own).as_quat(scalar_first=True)

    for part, bone in parts.items():
        follow(bone, part, part, 0.0)
    spine = _between(skeleton.parents, parts["chest"], hips)
    for k, bone in enumerate(spine):
        share = 2.0 * (k + 1) / (len(spine) + 1)
        first, second = ("pelvis", "waist") if share < 1.0 else ("waist", "chest")
        follow(bone, first, second, share % 1.0)
        turned(bone, np.eye(3))
    if "head" in parts:
        neck = _between(skeleton.parents, parts["head"], parts["chest"])
        for k, bone in enumerate(neck):
            follow(bone, "chest", "head", (k + 1) / (len(neck) + 1))
            turned(bone, np.eye(3))
    for side in _SIDES:
        forearm = f"{side}_forearm"
        twists = _twists(skeleton, parts, side)
        follow(parts[forearm], f"{forearm} untwisted", forearm, 0.0 if twists else _HALF_TWISTED)
        own = Rotation.from_quat(skeleton.places[parts[forearm], 3:], scalar_first=True).as_matrix()
        target = Rotation.from_quat(aligned[parts[forearm]], scalar_first=True).as_matrix()
        for bone, share in twists.items():
            follow(bone, f"{forearm} untwisted", forearm, share)
            turned(bone, target @ own.T @ rest.facing.T)
    return RigArrays(
        skeleton.parents.astype(np.int64), _relative(skeleton, kinds, hips), kinds, sources, shares, aligned,
        hips,
        np.array([[parts[f"{side}_{limb}"] for side in _SIDES] for limb in ("thigh", "upper_arm")]),
        np.array([rest.thigh, rest.shank, rest.upper_arm, rest.forearm]), rest.middle,
        float(rest.thigh.mean() + rest.shank.mean() + rest.ankle) / person.leg,
        rest.half_width - person.half_width, rest.feet, rest.toes[:, : len(rest.toes[0]) * rest.has_toes],
        rest.joint, rest.hands,
    )  # fmt: skip


def _hanging(parents: NDArray[np.int64], bone: int) -> NDArray[np.bool_]:
    """(b,) a bone and all that hangs on it."""
    found = np.zeros(len(parents), bool)
    found[bone] = True
    for b in range(bone + 1, len(found)):
        found[b] |= parents[b] >= 0 and found[parents[b]]
    return found


def _between(parents: NDArray[np.int64], bone: int, above: int) -> list[int]:
    """The bones from below ``above`` to above ``bone``, in this order."""
    found: list[int] = []
    at = int(parents[bone])
    while at != above:
        found.append(at)
        at = int(parents[at])
    return found[::-1]


def _twists(skeleton: Skeleton, parts: dict[str, int], side: str) -> dict[int, float]:
    """The bones along a forearm that share its twist, and which share of it each has: as far as it is from
    the elbow."""
    elbow, hand = parts[f"{side}_forearm"], parts.get(f"{side}_hand")
    if hand is None:
        return {}
    at = skeleton.places[:, :3]
    along = at[hand] - at[elbow]
    other = _hanging(skeleton.parents, hand)
    return {
        int(b): float(np.clip((at[b] - at[elbow]) @ along / (along @ along), 0.0, 1.0))
        for b in np.flatnonzero(_hanging(skeleton.parents, elbow) & ~other)
        if b != elbow and any(word in skeleton.names[b].lower() for word in _TWISTS)
    }


def _relative(skeleton: Skeleton, kinds: NDArray[np.int64], hips: int) -> NDArray[np.float64]:
    """(b, 7) what `RigArrays.rest` says."""
    found = skeleton.places.copy()
    beside = kinds == BESIDE
    found[beside, :3] -= skeleton.places[hips, :3]
    child = ~beside & (skeleton.parents >= 0)
    parent = skeleton.places[skeleton.parents[child]]
    back = Rotation.from_quat(parent[:, 3:], scalar_first=True).inv()
    found[child, :3] = back.apply(skeleton.places[child, :3] - parent[:, :3])
    turn = back * Rotation.from_quat(skeleton.places[child, 3:], scalar_first=True)
    found[child, 3:] = turn.as_quat(scalar_first=True)
    return found
