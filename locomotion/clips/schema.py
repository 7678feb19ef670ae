"""Format of a keyframe file: its keys, and the units and ranges of its numbers.

The ranges are wide for motions but narrow enough to catch wrong units, such as milliseconds or centimetres.
"""

from typing import Annotated

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StrictBool

__all__ = ["ClipFile"]


def _within(low: float, high: float, unit: str) -> BeforeValidator:
    """Accepts numbers from ``low`` to ``high``, also those that YAML reads as text, such as 1e-3."""

    def check(value: object) -> float:
        try:
            number = float(value) if isinstance(value, int | float | str) else None
        except (ValueError, OverflowError):
            number = None
        if number is None or isinstance(value, bool) or not low <= number <= high:
            raise ValueError(f"must be a number from {low:g} to {high:g} {unit}")
        return number

    return BeforeValidator(check)


def _listed(value: object) -> object:
    if not isinstance(value, list):
        raise ValueError("must be a pair [share of the duration, degrees]")
    return value


_Share = Annotated[float, _within(0.0, 1.0, "(share of the duration)")]
_Angle = Annotated[float, _within(-360.0, 360.0, "degrees")]
_Keyframe = Annotated[tuple[_Share, _Angle], BeforeValidator(_listed)]


class _Root(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)

    height: Annotated[float, _within(0.0, 3.0, "m")]
    pitch: Annotated[float, _within(-180.0, 180.0, "degrees")]


class ClipFile(BaseModel):
    """A keyframe file; durations in s, angles in degrees.

    name: None means the file's name. duration: of one pass or cycle. speed: forward [m/s]. root: its mean
    height [m] and forward lean. channels: keyframes per joint of `locomotion.body.person.JOINT_NAMES`, pairs
    of a share of the duration and an angle.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, coerce_numbers_to_str=True)

    name: str | None = None
    cyclic: StrictBool = False
    mirrored: StrictBool = False
    duration: Annotated[float, _within(0.001, 120.0, "s")]
    speed: Annotated[float, _within(0.0, 20.0, "m/s")]
    root: _Root
    channels: Annotated[dict[str, list[_Keyframe]], Field(min_length=1)]
