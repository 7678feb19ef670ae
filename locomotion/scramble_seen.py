"""What a person on hands and feet sees of its body after each physics step."""

import mujoco
import numpy as np
from numba import njit

from locomotion.anatomy import TRUNK_JOINTS
from locomotion.hand_hold import HAND_POINT
from locomotion.person import CONTROL_DT, PersonIndex
from locomotion.scramble_layout import (
    ANCHORS,
    AXES,
    BIAS,
    SEEN_BASE,
    SEEN_COM,
    SEEN_FORCES,
    SEEN_LIMBS,
    SEEN_TRUNK,
    SEEN_TURN,
    SEEN_VELOCITY,
)  # fmt: skip
from locomotion.scramble_limbs import BALL

__all__ = ["observe_scramble", "parts_of"]

_HAND = np.array(HAND_POINT)


@njit(cache=True)
def _observe(
    memory, fresh, places, frames, coms, hands, feet, parts, anchors, axes, bias, ncon, geoms, bodies,
    addresses, forces,
):  # fmt: skip
    for i in range(3):
        c = coms[1, i]
        memory[SEEN_VELOCITY.start + i] = 0.0 if fresh else (c - memory[SEEN_COM.start + i]) / CONTROL_DT
        memory[SEEN_COM.start + i] = c
        memory[SEEN_BASE.start + i] = places[1, i]
    memory[SEEN_TURN] = frames[1]
    seen = memory[SEEN_LIMBS].reshape(4, 3)
    for k in range(4):
        body = hands[k] if k < 2 else feet[k - 2]
        at = _HAND if k < 2 else BALL
        for i in range(3):
            seen[k, i] = places[body, i]
            for j in range(3):
                seen[k, i] += frames[body, 3 * i + j] * at[j]
    memory[BIAS] = bias[6:45]
    for j in range(39):
        for i in range(3):
            memory[ANCHORS.start + 3 * j + i] = anchors[j + 1, i]
            memory[AXES.start + 3 * j + i] = axes[j + 1, i]
    memory[SEEN_FORCES] = 0.0
    memory[SEEN_TRUNK] = 0.0
    for c in range(ncon):
        if addresses[c] < 0:
            continue
        total = 0.0
        for i in range(4):
            total += forces[addresses[c] + i]
        body = max(bodies[geoms[c, 0]], bodies[geoms[c, 1]])
        part = parts[body]
        if part >= 0:
            memory[SEEN_FORCES.start + part] += total
        elif part == -1:
            memory[SEEN_TRUNK] += total


def parts_of(index: PersonIndex, bodies: int) -> np.ndarray:
    """(bodies,) int64: number of the limb whose end a body is, -1 for pelvis, trunk and head, else -2."""
    parts = np.full(bodies, -2)
    for k, side in enumerate(("right", "left")):
        parts[index.bodies[f"{side}_hand"]] = k
        parts[index.bodies[f"{side}_foot"]] = parts[index.bodies[f"{side}_toes"]] = 2 + k
    for name in TRUNK_JOINTS:
        parts[index.bodies[name]] = -1
    parts[index.root] = -1
    return parts


def observe_scramble(
    index: PersonIndex, parts: np.ndarray, data: mujoco.MjData, memory: np.ndarray, fresh: bool = False
) -> None:
    """Read what the controller needs of ``data`` into ``memory``; ``fresh``: at a pose that was put there."""
    hands = np.array([index.bodies["right_hand"], index.bodies["left_hand"]])
    contact = data.contact
    _observe(
        memory, fresh, data.xpos, data.xmat, data.subtree_com, hands, index.feet, parts, data.xanchor,
        data.xaxis, data.qfrc_bias, data.ncon, contact.geom, data.model.geom_bodyid, contact.efc_address,
        data.efc_force,
    )  # fmt: skip
