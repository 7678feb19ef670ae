"""A gait as data: when its feet fall, and how the trunk moves over them."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

import numpy as np
from annotated_types import Ge, Gt, Le, Len
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, model_validator

from locomotion.quadruped import layout as at

__all__ = ["Back", "Gait", "Length", "Share", "Strict"]

_MOST_FLEXION = 90.0  # [deg]
_LITTLE_FLEXION = 5.0  # [deg]
Length = Annotated[float, Gt(0.0), Le(20.0)]
Share = Annotated[float, Ge(0.0), Le(1.0)]
Leg = Literal["front_left", "front_right", "rear_left", "rear_right"]


class Strict(BaseModel):
    """What is read from a body's file: nothing in it is ignored."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


Range = Annotated[float, Ge(0.0), Le(45.0)]


class Back(Strict):
    """Movement of the trunk in a gait: ranges from one end to the other, over a stride."""

    flexion_deg: Annotated[list[float], Len(2, 2)] | None = None
    """Between pelvis and chest, seen from the side: a value at rest and its change per m/s, up to 90. None:
    half of what the spine bends to the sides if the hind feet land one after the other, else 5."""
    undulation_deg: Range = 4.0
    """Between pelvis and chest, seen from above, when diagonal legs move together."""
    hip_roll_deg: Range = 8.0
    shoulder_roll_deg: Range = 5.0
    nod_deg: Range = 5.0
    """Of the neck."""
    lower_deg: Annotated[float, Ge(-45.0), Le(60.0)] = 0.0
    """By which the neck is carried lower than by one that stands."""


class Gait(Strict):
    """Footfalls for a range of speeds; two numbers are a value at rest and its change per m/s."""

    up_to: Annotated[float, Gt(0.0), Le(30.0)]
    on_request: bool = False
    """Whether it is used only when requested by name."""
    frequency: Annotated[list[float], Len(2, 2)]
    """[Hz] strides per second."""
    duty_front: Annotated[list[float], Len(2, 2)]
    duty_rear: Annotated[list[float], Len(2, 2)]
    """Share of the stride during which a foot stands."""
    touchdown: dict[Leg, Share]
    """Share of the stride at which each foot comes down."""
    lift: Length
    """Height of the swing."""
    bob: Annotated[float, Ge(0.0), Le(1.0)]
    """Rise of the trunk, twice a stride, to each side of the middle, where legs of a pair alternate."""
    rock: Annotated[float, Ge(0.0), Le(1.0)]
    """Rise of hips and shoulders, once a stride, where the two legs of a pair move together."""
    back: Back = Back()

    @model_validator(mode="after")
    def _complete(self) -> Self:
        missing = [leg for leg in at.LEGS if leg not in self.touchdown]
        if missing:
            raise ValueError(f"touchdown lacks {', '.join(missing)}")
        for speed in (0.0, self.up_to):
            if not 0.2 <= self.frequency[0] + self.frequency[1] * speed <= 10.0:
                raise ValueError(f"frequency at {speed:g} m/s is outside 0.2 to 10 Hz")
            for duty in (self.duty_front, self.duty_rear):
                if not 0.1 <= duty[0] + duty[1] * speed <= 0.95:
                    raise ValueError(f"duty at {speed:g} m/s is outside 0.1 to 0.95")
            flexion = self.back.flexion_deg or [0.0, 0.0]
            if not 0.0 <= flexion[0] + flexion[1] * speed <= _MOST_FLEXION:
                raise ValueError(f"back.flexion_deg at {speed:g} m/s is outside 0 to {_MOST_FLEXION:g}")
        return self

    def flexion(self, supple_deg: float) -> tuple[float, float]:
        """[deg] and [deg per m/s], see `Back.flexion_deg`, of a spine that bends to the sides by
        ``supple_deg``."""
        if self.back.flexion_deg is not None:
            return self.back.flexion_deg[0], self.back.flexion_deg[1]
        apart = 2.0 * math.pi * (self.touchdown["rear_left"] - self.touchdown["rear_right"])
        together = 0.5 * (1.0 + math.cos(apart))
        supple = 0.5 * min(supple_deg, _MOST_FLEXION)
        return _LITTLE_FLEXION + together * max(supple - _LITTLE_FLEXION, 0.0), 0.0

    def row(self, supple_deg: float) -> NDArray[np.float64]:
        """(GAIT,) float64 for the kernels; ``supple_deg`` as for `flexion`."""
        row = np.zeros(at.GAIT)
        row[at.UP_TO] = self.up_to
        row[[at.FREQUENCY, at.FREQUENCY_SLOPE]] = self.frequency
        row[[at.DUTY_FRONT, at.DUTY_FRONT_SLOPE]] = self.duty_front
        row[[at.DUTY_REAR, at.DUTY_REAR_SLOPE]] = self.duty_rear
        row[at.TOUCHDOWN : at.TOUCHDOWN + 4] = [self.touchdown[leg] for leg in at.LEGS]
        row[[at.LIFT, at.BOB, at.ROCK]] = self.lift, self.bob, self.rock
        row[[at.FLEXION, at.FLEXION_SLOPE]] = np.radians(self.flexion(supple_deg))
        back = self.back
        row[[at.UNDULATION, at.HIP_ROLL, at.SHOULDER_ROLL, at.NOD, at.LOWER]] = np.radians(
            [back.undulation_deg, back.hip_roll_deg, back.shoulder_roll_deg, back.nod_deg, back.lower_deg]
        )
        return row
