"""Format of a posture file; times in s, angles in degrees."""

from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, StrictBool, field_validator, model_validator

__all__ = ["ArcEntry", "KeyEntry", "PostureEntry", "PostureFile"]

_Degrees = Annotated[float, Field(ge=-180.0, le=180.0)]
_Seconds = Annotated[float, Field(gt=0.0, le=60.0)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class PostureEntry(_Strict):
    """How a figure is: joints by name, the others 0; how its pelvis leans forward (pitch) and to the right
    (roll). It is put on the ground. both: joints of both sides at once, without right_ and left_."""

    pitch: _Degrees = 0.0
    roll: _Degrees = 0.0
    joints: dict[str, _Degrees] = {}
    both: dict[str, _Degrees] = {}


class KeyEntry(PostureEntry):
    """What an arc goes through at a share of its time. Joints that are not named are as they would be
    without it, if ``like`` is a posture: as in that."""

    at: Annotated[float, Field(gt=0.0, lt=1.0)]
    like: str | None = None


class ArcEntry(_Strict):
    """A motion from a posture to another.

    seconds: how long it takes. standing_on: the part of the body that stays in its place. keys: what it goes
    through. motion: a file of recorded motion, from begin to end [s]. backwards: it is its opposite played
    backwards.
    """

    from_: Annotated[str, Field(alias="from")]
    to: str
    seconds: _Seconds | None = None
    standing_on: str = "left_foot"
    keys: list[KeyEntry] = []
    motion: str | None = None
    begin: Annotated[float, Field(ge=0.0)] = 0.0
    end: _Seconds | None = None
    backwards: StrictBool = False

    @model_validator(mode="after")
    def _is_one_of_three(self) -> Self:
        if [self.seconds is not None, self.motion is not None, self.backwards].count(True) != 1:
            raise ValueError("an arc has seconds, or a motion, or is backwards: true; one of the three")
        if self.keys and self.seconds is None:
            raise ValueError("keys go with seconds")
        return self


class PostureFile(_Strict):
    """postures: nodes by name. fatal: the posture that there is a way to from anywhere, at once, and how
    many seconds that takes. arcs: the motions between them."""

    name: str | None = None
    postures: dict[str, PostureEntry]
    fatal: str | None = None
    fatal_seconds: _Seconds = 0.8
    arcs: list[ArcEntry] = []

    @field_validator("postures")
    @classmethod
    def _are_some(cls, postures: dict[str, PostureEntry]) -> dict[str, PostureEntry]:
        if not postures:
            raise ValueError("a graph has at least one posture")
        return postures
