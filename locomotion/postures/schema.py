"""Format of a posture file; times in s, angles in degrees."""

from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, StrictBool, field_validator, model_validator

__all__ = [
    "ArcEntry", "GaitEntry", "KeyEntry", "ObjectEntry", "PostureEntry", "PostureFile", "ShapeEntry",
    "StateEntry",
]  # fmt: skip

_Degrees = Annotated[float, Field(ge=-180.0, le=180.0)]
_Metres = Annotated[float, Field(ge=-10.0, le=10.0)]
_Share = Annotated[float, Field(ge=0.0, le=1.0)]
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


class Joints(_Strict):
    """Joints by name that differ; both: of both sides at once."""

    joints: dict[str, _Degrees] = {}
    both: dict[str, _Degrees] = {}


class StateEntry(Joints):
    """What a figure does with an object: joints that differ from its posture's, such as the arms'.
    seconds: how long it takes to get there from the state before. in: the postures in which it can, each with
    the joints that differ there once more."""

    seconds: _Seconds
    in_: Annotated[dict[str, Joints], Field(alias="in", min_length=1)]


class ShapeEntry(_Strict):
    """A capsule between two points [m] of a thing's frame: its origin is where the right hand has it, x
    points to where the left one has it, z up. radius: [m]. colour: red, green, blue, 0 to 1."""

    from_: Annotated[tuple[_Metres, _Metres, _Metres], Field(alias="from")]
    to: tuple[_Metres, _Metres, _Metres]
    radius: Annotated[float, Field(gt=0.0, le=1.0)]
    colour: tuple[_Share, _Share, _Share] = (0.3, 0.3, 0.3)


class ObjectEntry(_Strict):
    """Something to hold. states: what can be done with it, in this order; before the first it is stowed.
    shapes: what it looks like, while it is not stowed."""

    shapes: Annotated[list[ShapeEntry], Field(max_length=64)] = []
    states: Annotated[dict[str, StateEntry], Field(min_length=1)]

    @field_validator("states")
    @classmethod
    def _are_not_stowed(cls, states: dict[str, StateEntry]) -> dict[str, StateEntry]:
        if "stowed" in states:
            raise ValueError("every object has the state 'stowed', with the arms as in the posture")
        return states


class GaitEntry(_Strict):
    """A way to move. posture: where it begins and ends. slowest, fastest: [m/s] between which it is gone on
    with. steps: of a cycle, in their order. backwards: whether it moves backwards."""

    posture: str
    slowest: Annotated[float, Field(ge=0.0, le=20.0)] = 0.0
    fastest: Annotated[float, Field(gt=0.0, le=20.0)]
    steps: Annotated[tuple[str, ...], Field(min_length=1, max_length=8)] = ("left", "right")
    backwards: StrictBool = False

    @model_validator(mode="after")
    def _has_speeds(self) -> Self:
        if self.slowest >= self.fastest:
            raise ValueError("slowest must be below fastest")
        return self


class PostureFile(_Strict):
    """postures: nodes by name. fatal: the posture that there is a way to from anywhere, at once, and how
    many seconds that takes. arcs: the motions between them. objects: what figures hold. gaits: how they move,
    in the order in which they are looked through for one that is fast enough."""

    name: str | None = None
    postures: dict[str, PostureEntry]
    fatal: str | None = None
    fatal_seconds: _Seconds = 0.8
    arcs: list[ArcEntry] = []
    objects: dict[str, ObjectEntry] = {}
    gaits: dict[str, GaitEntry] = {}

    @field_validator("postures")
    @classmethod
    def _are_some(cls, postures: dict[str, PostureEntry]) -> dict[str, PostureEntry]:
        if not postures:
            raise ValueError("a graph has at least one posture")
        if named := [name for name in postures if "/" in name]:
            raise ValueError(f"{named[0]!r}: a posture's name has no /, which comes before what is held")
        return postures
