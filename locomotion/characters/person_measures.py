"""What retargeting has to know of our person: its soles, what it can rest on, lengths; out of its model."""

from functools import cache
from typing import NamedTuple

import mujoco
import numpy as np

from locomotion.body.anatomy import ANKLE, SHANK, THIGH, TOE_JOINT
from locomotion.body.hand_hold import HAND_POINT
from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES

__all__ = ["PersonArrays", "person_arrays", "person_tree"]


class PersonArrays(NamedTuple):
    """The person as kernels take it; bodies by their number in `BODY_NAMES`, of pairs the right one first."""

    feet: np.ndarray
    """(2, k, 4) ends of the feet's capsules in the feet, and their radii [m]"""
    toes: np.ndarray
    """(2, k, 4) the same of the toes"""
    ends: np.ndarray
    """(e, 4) the same of all bodies"""
    owners: np.ndarray
    """(e,) int64: their bodies"""
    limbs: np.ndarray
    """(8, 2) int64: thighs, shanks, feet, toes, upper arms, forearms, hands, clavicles"""
    hand: np.ndarray
    """(3,) the hand's point from the wrist [m]"""
    ball: float
    """[m] of the toes' joint before the ankle"""
    leg: float
    """[m] from hip to sole"""
    half_width: float
    """[m] half the distance of the hips"""


_LIMBS = ("thigh", "shank", "foot", "toes", "upper_arm", "forearm", "hand", "clavicle")


@cache
def person_arrays() -> PersonArrays:
    """The measures of the person's model."""
    model = figure()
    found: dict[int, list[np.ndarray]] = {}
    for geom in range(model.ngeom):
        name = model.body(model.geom_bodyid[geom]).name
        if name not in BODY_NAMES or model.geom_type[geom] != mujoco.mjtGeom.mjGEOM_CAPSULE:  # type: ignore[attr-defined]
            continue
        matrix = np.zeros(9)
        mujoco.mju_quat2Mat(matrix, model.geom_quat[geom])
        radius, half = model.geom_size[geom, 0], model.geom_size[geom, 1]
        for sign in (-1.0, 1.0):
            end = model.geom_pos[geom] + sign * half * matrix.reshape(3, 3)[:, 2]
            found.setdefault(BODY_NAMES.index(name), []).append(np.array([*end, radius]))
    limbs = np.array([[BODY_NAMES.index(f"{side}_{limb}") for side in ("right", "left")] for limb in _LIMBS])
    return PersonArrays(
        np.array([found[b] for b in limbs[2]]), np.array([found[b] for b in limbs[3]]),
        np.concatenate([np.array(found[b]) for b in sorted(found)]),
        np.concatenate([np.full(len(found[b]), b) for b in sorted(found)]), limbs,
        np.array(HAND_POINT), TOE_JOINT[0], THIGH + SHANK + ANKLE,
        float(abs(model.body("left_thigh").pos[1])),
    )  # fmt: skip


@cache
def person_tree() -> dict[str, tuple[str, np.ndarray]]:
    """For each of the person's bodies but the pelvis, parents first, the body that it hangs on, and where
    (3,) [m]."""
    model = figure()
    names = [model.body(b).name for b in range(model.nbody)]
    return {
        name: (names[model.body_parentid[b]], model.body_pos[b].copy())
        for b, name in enumerate(names)
        if name in BODY_NAMES and name != "pelvis"
    }
