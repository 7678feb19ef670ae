"""How a person differs from others where a policy moves it.

The policy has learned on one way to move; its targets are changed a little (`law.targets`), and it keeps the
balance all the same: within `WORN`, people walk, run, stop and take pushes as the usual one does.
"""

import math

import numpy as np
from numpy.typing import NDArray

from locomotion.body.traits import ARMS, HEAD, LEAN, PACE, WIDTH
from locomotion.gaits.policy.layout import (
    ARM_SWING,
    HEAD_BEND,
    SPREAD,
    STEP_RATE,
    STYLE,
    TRUNK_LEAN,
)

__all__ = ["WORN", "style_of"]

WORN = {"width": (-0.05, 0.04), "arms": (0.3, 2.0), "lean": (-0.04, 0.3)}
"""Traits that are worn up to these values at most: beyond them people fall, or do not come to their speed."""


def style_of(traits: NDArray[np.float64]) -> NDArray[np.float64]:
    """`layout.STYLE` of a memory, (5,) float64, from a row of `locomotion.body.traits.TRAITS` (7,): rate of
    steps and swing of the arms as shares of the usual ones, less 1; [rad] by which legs are spread, the trunk
    leans and the head is bent."""
    width, arms, lean = (
        min(max(float(traits[k]), low), high)
        for k, (low, high) in zip((WIDTH, ARMS, LEAN), WORN.values(), strict=True)
    )
    style = np.zeros(STYLE.stop - STYLE.start)
    for name, value in (
        (STEP_RATE, 1.0 / math.sqrt(traits[PACE]) - 1.0),
        (ARM_SWING, arms - 1.0),
        (SPREAD, width),
        (TRUNK_LEAN, lean),
        (HEAD_BEND, float(traits[HEAD]) - lean),
    ):
        style[name - STYLE.start] = value
    return style
