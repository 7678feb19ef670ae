"""Hands that hold on to the world: a ball joint between a hand and a fixed point.

Each hand has a body without shape or mass that marks the point ("mocap" in MuJoCo's terms) and a `connect`
constraint between the two, which is inactive until the hand holds on. Point and switch belong to MuJoCo's
data, not to its model as the constraint's own anchor would; so they are saved with the state, and persons
that share a model can hold different points.
"""

from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

__all__ = ["HAND_POINT", "add_hand_holds", "hold", "holding", "let_go", "let_go_both"]

HAND_POINT = (0.012, 0.0, -0.115)
"""The point of a hand that is held, in the hand's frame [m]: the end of its capsule."""
_SIDES = ("right", "left")


def add_hand_holds(spec: mujoco.MjSpec) -> None:
    """Add both hands' points and inactive joints to the person's description."""
    for side in _SIDES:
        point, hand = f"{side}_hold", f"{side}_hand"
        spec.worldbody.add_body(name=point, mocap=True).add_site(name=point, group=4)
        spec.body(hand).add_site(name=hand, pos=HAND_POINT, group=4)
        joint: Any = spec.add_equality(name=point, name1=point, name2=hand, active=False)
        joint.type, joint.objtype = mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtObj.mjOBJ_SITE


def _number(side: float) -> int:
    return 1 if side > 0 else 0


def hold(data: mujoco.MjData, side: float, point: NDArray[np.float64]) -> None:
    """Let the hand of ``side`` (-1 right, +1 left) hold ``point`` (3,) [m], where its `HAND_POINT` now is."""
    data.mocap_pos[_number(side)] = point
    data.eq_active[_number(side)] = 1


def let_go(data: mujoco.MjData, side: float) -> None:
    """Release the hand of ``side``."""
    data.eq_active[_number(side)] = 0


def let_go_both(data: mujoco.MjData) -> None:
    """Release both hands."""
    data.eq_active[:] = 0


def holding(data: mujoco.MjData, side: float) -> bool:
    """Whether the hand of ``side`` holds on to something."""
    return bool(data.eq_active[_number(side)])
