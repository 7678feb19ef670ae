"""Axes of a captured skeleton's joints in its limbs, measured on a motion that is never upright.

A bone gives the direction of its part, hips and shoulders show which side is left, and the plane in which a
knee or elbow bends gives its axis. Parts without such clues (head, hands, toes, shoulders) align on average
with the part that they hang on.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from locomotion.body.anatomy import TOE_JOINT

__all__ = ["measured_axes"]

_APART = 0.03  # [m] least distance of joints that gives a direction
_BENT = 0.05  # mean sine of its angle from which a joint shows its axis
_LIKE_BEFORE = {"head": "chest", "clavicle": "chest", "hand": "forearm", "toes": "foot"}

Vectors = NDArray[np.float64]


def measured_axes(places: Vectors, turns: Vectors, source: dict[str, int]) -> dict[str, Vectors]:
    """The axes of each part, (3, 3), in the axes of the joint that turns it.

    source: index of that joint, by part. places (n, j, 3) [m], turns (n, j, 3, 3): position and orientation
    of the joints in each frame.
    """

    def at(part: str) -> Vectors:
        return places[:, source[part]]

    def within(part: str, vectors: Vectors) -> Vectors:
        """Mean of vectors (n, 3) in the frame of a part's joint."""
        return np.einsum("nji,nj->i", turns[:, source[part]], vectors) / len(vectors)

    def world(part: str) -> Vectors:
        return turns[:, source[part]] @ axes[part]

    hips = 0.5 * (at("left_thigh") + at("right_thigh"))

    def apart(part: str, point: Vectors) -> bool:
        return part in source and np.linalg.norm(at(part) - point, axis=1).mean() > _APART

    low = "waist" if apart("waist", hips) else "chest"
    axes: dict[str, Vectors] = {}
    left = _unit(at("left_thigh") - at("right_thigh"))
    axes["pelvis"] = _frame(within("pelvis", left), within("pelvis", at(low) - hips), first="y")
    if "waist" in source:
        end = "chest" if apart("chest", at("waist")) else "head"
        up = within("waist", at(end) - at("waist"))
        axes["waist"] = _frame(within("waist", world("pelvis")[:, :, 1]), up, first="z")
    ends = "clavicle" if "left_clavicle" in source and "right_clavicle" in source else "upper_arm"
    shoulders = at(f"left_{ends}"), at(f"right_{ends}")
    top = at("head") if apart("head", at("chest")) else 0.5 * (shoulders[0] + shoulders[1])
    across = within("chest", _unit(shoulders[0] - shoulders[1]))
    axes["chest"] = _frame(across, within("chest", top - at("chest")), first="y")
    for side in ("right", "left"):
        for trunk, names, sense in (
            ("pelvis", ("thigh", "shank", "foot"), 1.0),
            ("chest", ("upper_arm", "forearm", "hand"), -1.0),
        ):
            upper, lower, end = (f"{side}_{name}" for name in names)
            bones = [_unit(at(lower) - at(upper))]
            bones.append(_unit(at(end) - at(lower)) if end in source else bones[0])
            hinge = sense * np.cross(bones[0], bones[1])
            if np.linalg.norm(hinge, axis=1).mean() < _BENT:  # straight: as if swung up from hanging
                hangs = np.einsum("nji,nj->i", world(trunk), bones[0])
                swung = Rotation.align_vectors(_unit(hangs), [0.0, 0.0, -1.0])[0].as_matrix()
                hinge = world(trunk) @ swung[:, 1]
            axes[upper] = _frame(within(upper, hinge), -within(upper, bones[0]), first="z")
            if end in source:
                axes[lower] = _frame(within(lower, hinge), -within(lower, bones[1]), first="z")
            else:
                axes[lower] = _as(turns[:, source[lower]], world(upper))
        foot, toes = f"{side}_foot", f"{side}_toes"
        if apart(toes, at(foot)):
            hinge = world(f"{side}_shank")[:, :, 1]
            axes[foot] = _foot(within(foot, hinge), within(foot, at(toes) - at(foot)))
        else:
            axes[foot] = _as(turns[:, source[foot]], world(f"{side}_shank"))
    for part in source:
        side, _, kind = part.rpartition("_")
        if part not in axes:
            before = _LIKE_BEFORE[kind]
            before = before if before == "chest" else f"{side}_{before}"
            axes[part] = _as(turns[:, source[part]], world(before))
    return axes


def _unit(vectors: Vectors) -> Vectors:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def _frame(y: Vectors, z: Vectors, first: str) -> Vectors:
    """Axes (3, 3) whose y and z are as given, the ``first`` of them exactly."""
    x = _unit(np.cross(y, z))
    if first == "y":
        y = _unit(y)
        return np.stack([x, y, np.cross(x, y)], axis=1)
    z = _unit(z)
    return np.stack([x, np.cross(z, x), z], axis=1)


def _foot(y: Vectors, toes: Vectors) -> Vectors:
    """Axes of a foot whose ``toes`` are as far below the ankle as the person's."""
    ahead, below = TOE_JOINT[0], -TOE_JOINT[2]
    turned = _frame(y, np.cross(toes, y), first="y")  # x towards the toes
    slope = Rotation.from_euler("y", -np.arctan2(below, ahead)).as_matrix()
    return turned @ slope


def _as(turns: Vectors, before: Vectors) -> Vectors:
    """Axes (3, 3) of a joint that align it on average with the part ``before`` (n, 3, 3)."""
    mean = (np.swapaxes(turns, 1, 2) @ before).mean(axis=0)
    u, _, v = np.linalg.svd(mean)
    return u @ np.diag([1.0, 1.0, np.linalg.det(u @ v)]) @ v
