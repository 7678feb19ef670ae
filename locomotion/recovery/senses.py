"""What a person on hands and feet observes of its body after each physics step."""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.anatomy import TRUNK_JOINTS
from locomotion.body.contacts import contacts_of
from locomotion.body.hand_hold import HAND_POINT
from locomotion.body.observed import COM, COM_VELOCITY, CONTACT, FEET, LEFT_FOOT, OBSERVED_SIZE, RIGHT_FOOT
from locomotion.body.person import CONTROL_DT, PersonIndex
from locomotion.recovery.layout import (
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
from locomotion.recovery.limbs import BALL
from surefoot.kernels import allocating_kernel

__all__ = ["Parts", "observe_scramble", "parts_of"]

_HAND = np.array(HAND_POINT)
_RIGHT_FOOT, _LEFT_FOOT = slice(RIGHT_FOOT, LEFT_FOOT), slice(LEFT_FOOT, FEET.stop)
_FEET_FORCES = slice(SEEN_FORCES.start + 2, SEEN_FORCES.stop)


class Parts(NamedTuple):
    """The body's parts in a model.

    Attributes:
        ends: (4,) int64 bodies of right and left hand and foot.
        of_body: (nbody,) int64: number of the limb whose end a body is, -1 for pelvis, trunk and head, else
            -2.
        bodies: (ngeom,) int32: the body of each geom.
    """

    ends: NDArray[np.int64]
    of_body: NDArray[np.int64]
    bodies: NDArray[np.int32]


@allocating_kernel
def _observe(
    memory, fresh, observed, places, frames, coms, parts, anchors, axes, bias, ncon, geoms, addresses, forces
):  # fmt: skip
    for i in range(3):
        c = coms[1, i]
        before = c if fresh else memory[SEEN_COM.start + i]
        memory[SEEN_VELOCITY.start + i] = (c - before) / CONTROL_DT
        memory[SEEN_COM.start + i] = c
        memory[SEEN_BASE.start + i] = places[1, i]
    memory[SEEN_TURN] = frames[1]
    seen = memory[SEEN_LIMBS].reshape(4, 3)
    for k in range(4):
        body = parts.ends[k]
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
        part = parts.of_body[max(parts.bodies[geoms[c, 0]], parts.bodies[geoms[c, 1]])]
        if part >= 0:
            memory[SEEN_FORCES.start + part] += total
        elif part == -1:
            memory[SEEN_TRUNK] += total
    observed[COM], observed[COM_VELOCITY] = memory[SEEN_COM], memory[SEEN_VELOCITY]
    observed[_RIGHT_FOOT], observed[_LEFT_FOOT] = places[parts.ends[2]], places[parts.ends[3]]
    observed[CONTACT] = memory[_FEET_FORCES]


def parts_of(index: PersonIndex, model: mujoco.MjModel) -> Parts:
    """Where the parts are in ``model``."""
    sides = ("right", "left")
    hands, feet, toes = ([index.bodies[f"{s}_{part}"] for s in sides] for part in ("hand", "foot", "toes"))
    of_body = np.full(model.nbody, -2)
    for k in range(2):
        of_body[hands[k]] = k
        of_body[[feet[k], toes[k]]] = 2 + k
    of_body[[index.root, *(index.bodies[name] for name in TRUNK_JOINTS)]] = -1
    return Parts(np.array(hands + feet), of_body, model.geom_bodyid.copy())


def observe_scramble(
    parts: Parts, data: mujoco.MjData, memory: np.ndarray, observed: np.ndarray | None = None
) -> None:
    """Read what the controller needs of ``data`` into ``memory``, and into ``observed``
    (`locomotion.body.observed`) what everybody asks for; without it: at a pose that was put there, at
    rest."""
    pairs, addresses = contacts_of(data)
    fresh = observed is None
    if observed is None:
        observed = np.empty(OBSERVED_SIZE)
    _observe(
        memory, fresh, observed, data.xpos, data.xmat, data.subtree_com, parts, data.xanchor, data.xaxis,
        data.qfrc_bias, data.ncon, pairs, addresses, data.efc_force,
    )  # fmt: skip
