"""What a mission file may say, as pydantic models: the source of its checks and of its JSON schema."""

import re
from itertools import chain
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from annotated_types import Ge, Gt, Le, Len
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    model_validator,
)

from locomotion.postures.held_objects import STOWED
from locomotion.recorded_people.people import person_postures
from locomotion.skills.registry import CLEARING, skill_called, skill_words
from runtime.bodies.registry import USUAL, body_names, is_body_file
from runtime.world.level_of_detail import AUTO, LEVELS, PHYSICS
from surefoot.files.choices import OneOf

__all__ = [
    "AgentSpec", "Distance", "Entering", "Expectation", "Follow", "Hold", "LevelSpec", "Mission", "Order",
    "Patrol", "Place", "Places", "Region", "RulesSpec", "Step", "Trigger", "Use", "Using", "ViewerSpec",
    "When",
]  # fmt: skip

MAX_COORDINATE = 1e6


def _near(value: float) -> float:
    if not -MAX_COORDINATE <= value <= MAX_COORDINATE:
        raise ValueError(f"a coordinate is within ±{MAX_COORDINATE:g} m")
    return value


_NAME = re.compile(r"^[A-Za-z_][A-Za-z0-9_-]{0,39}$")


def _name(value: str) -> str:
    if not _NAME.fullmatch(value):
        raise ValueError("a name is a letter and up to 39 letters, digits, - and _")
    return value


def _kind_of_place(value: Any) -> str:
    return "(name)" if isinstance(value, str) else "(point)"


def _kind_of_places(value: Any) -> str:
    if isinstance(value, str):
        return "(name)"
    flat = isinstance(value, list) and value and not isinstance(value[0], list | str)
    return "(point)" if flat else "(list)"


def _kind_of_body(value: Any) -> str:
    return "(file)" if isinstance(value, str) and is_body_file(value) else "(name)"


# The tags in brackets show up in the addresses of pydantic's errors; surefoot.files.yamlfile leaves them out.
Coordinate = Annotated[float, AfterValidator(_near)]
Point = Annotated[list[Coordinate], Len(3, 3)]
Name = Annotated[str, AfterValidator(_name), Field(json_schema_extra={"pattern": _NAME.pattern})]
Place = Annotated[
    Annotated[Name, Tag("(name)")] | Annotated[Point, Tag("(point)")], Discriminator(_kind_of_place)
]
"""A point (x, y, z) [m] or the name of a waypoint."""
Places = Annotated[
    Annotated[Name, Tag("(name)")]
    | Annotated[Point, Tag("(point)")]
    | Annotated[Annotated[list[Place], Len(1, 1000)], Tag("(list)")],
    Discriminator(_kind_of_places),
]
"""One place, or several in order."""
Seconds = Annotated[float, Gt(0.0), Le(86400.0)]
Speed = Annotated[float, Ge(0.5), Le(6.0)]


def _as_called_now(said: Any) -> Any:
    """Files of earlier versions call a skill as its obstacle."""
    return skill_called(said).skill if isinstance(said, str) and said in CLEARING else said


Skill = Annotated[
    str,
    OneOf(skill_words),
    BeforeValidator(_as_called_now),
]
"""What clears an obstacle."""


def _postures() -> list[str]:
    return [name for name in person_postures().postures if "/" not in name]


def _states() -> list[str]:
    return [STOWED, *dict.fromkeys(chain.from_iterable(person_postures().objects.values()))]


Posture = Annotated[str, OneOf(_postures)]
Held = Annotated[str, OneOf(lambda: list(person_postures().objects))]
Detail = Annotated[str, OneOf(lambda: (AUTO, *LEVELS))]
if TYPE_CHECKING:
    Body = str
else:
    _BodyFile = Annotated[str, Field(json_schema_extra={"pattern": r"\.ya?ml$"})]
    Body = Annotated[
        Annotated[str, OneOf(body_names), Tag("(name)")] | Annotated[_BodyFile, Tag("(file)")],
        Discriminator(_kind_of_body),
    ]


class _Strict(BaseModel):
    model_config = ConfigDict(
        extra="forbid", strict=True, frozen=True, allow_inf_nan=False, use_attribute_docstrings=True
    )

    def _one_of(self, what: str, names: tuple[str, ...]) -> None:
        """Raise ValueError unless exactly one of ``names`` is given."""
        given = [name for name in names if getattr(self, name) is not None]
        if len(given) != 1:
            instead = f", not {' and '.join(given)}" if given else ""
            raise ValueError(f"one {what} is needed: {', '.join(names[:-1])} or {names[-1]}{instead}")


def _requires_one(names: tuple[str, ...]) -> ConfigDict:
    """The same rule for the JSON schema."""
    return ConfigDict(json_schema_extra={"oneOf": [{"required": [name]} for name in names]})


class LevelSpec(_Strict):
    """The mesh or the open world that the mission runs on."""

    file: str
    """Mesh file, or the folder of an open world (`navmesh.bake_open_world`), relative to the mission's."""
    radius: Annotated[float, Gt(0.0), Le(1e5)] = 250.0
    """[m] Of an open world: how far around its players chunks are loaded."""
    up: Literal["x", "y", "z"] | None = None
    """Axis of the file that points up; default: what the file says, y for glTF, else z. The coordinates in
    the mission are Z up in any case."""
    scale: Annotated[float, Gt(0.0), Le(1e6)] | None = None
    """Metres per unit of the file; default: what the file says, else 1."""
    tags: str | None = None
    """File with authored obstacle tags, relative to the mission's; by default the one beside the level."""


class RulesSpec(_Strict):
    """Where a body can walk; what is left out is as all the bodies of the mission need it."""

    max_slope_deg: Annotated[float, Gt(0.0), Le(89.0)] | None = None
    """[°] Steeper faces end the walkable surface."""
    max_step: Annotated[float, Ge(0.0), Le(10.0)] | None = None
    """[m] Higher steps end the walkable surface."""
    headroom: Annotated[float, Gt(0.0), Le(100.0)] | None = None
    """[m] Free height above the floor that walking needs."""
    resolution: Annotated[float, Ge(0.02), Le(2.0)] | None = None
    """[m] Width of a cell of the surface."""


class Region(_Strict):
    """A part of space: a box from `min` to `max`, or a ball about `center`."""

    min: Point | None = None
    """[m] The corner with the least x, y and z."""
    max: Point | None = None
    """[m] The corner with the greatest."""
    center: Point | None = None
    """[m]"""
    radius: Annotated[float, Gt(0.0), Le(1e6)] | None = None
    """[m]"""

    model_config = ConfigDict(
        json_schema_extra={"oneOf": [{"required": ["min", "max"]}, {"required": ["center", "radius"]}]}
    )

    @model_validator(mode="after")
    def _whole(self) -> Self:
        given = {name for name in ("min", "max", "center", "radius") if getattr(self, name) is not None}
        if given not in ({"min", "max"}, {"center", "radius"}):
            raise ValueError("a region has either min and max or center and radius")
        if self.min and self.max and not all(a < b for a, b in zip(self.min, self.max, strict=True)):
            raise ValueError("min must be below max in x, y and z")
        return self


class Follow(_Strict):
    """Go where another agent goes."""

    agent: Name
    """Whom."""
    distance: Annotated[float, Ge(0.5), Le(100.0)] = 2.0
    """[m] How far behind to stay, along the way."""
    seconds: Seconds | None = None
    """[s] For how long; without it to the end of the mission."""


class Patrol(_Strict):
    """Go round several points, over and over."""

    points: Annotated[list[Place], Len(2, 1000)]
    """Visited in order, then again from the first."""
    rounds: Annotated[int, Ge(1), Le(10000)] | None = None
    """How often; without it, and without `seconds`, to the end of the mission."""
    seconds: Seconds | None = None
    """[s] For how long."""


class Use(_Strict):
    """Clear one obstacle with a skill: take a run-up, go over it and a few metres on."""

    skill: Skill
    """Which one; the body must have it."""
    obstacle: str | None = None
    """The obstacle's tag, as the level's tags file names it."""
    near: Place | None = None
    """Or a place near the middle of its edge."""

    model_config = _requires_one(("obstacle", "near"))

    @model_validator(mode="after")
    def _whole(self) -> Self:
        self._one_of("obstacle", ("obstacle", "near"))
        return self


class Hold(_Strict):
    """Have something in the hands."""

    object: Held
    """What."""
    state: Annotated[str, OneOf(_states)] = "deployed"
    """What it does with it; `stowed`: nothing any more."""


_ACTIONS = ("goto", "wait", "follow", "patrol", "use", "posture", "hold")


class Step(_Strict):
    """One action of a script."""

    goto: Places | None = None
    """Places to go to, one after the other."""
    wait: Seconds | None = None
    """[s] Stand for this long."""
    follow: Follow | None = None
    patrol: Patrol | None = None
    use: Use | None = None
    posture: Posture | None = None
    """A posture to take: people only."""
    hold: Hold | None = None
    speed: Speed | None = None
    """[m/s] For this action; by default the agent's."""

    model_config = _requires_one(_ACTIONS)

    @model_validator(mode="after")
    def _whole(self) -> Self:
        self._one_of("action", _ACTIONS)
        if self.wait is not None and self.speed is not None:
            raise ValueError("waiting has no speed")
        if (self.posture or self.hold) is not None and self.speed is not None:
            raise ValueError("a change of posture has no speed")
        return self


Steps = Annotated[list[Step], Len(1, 1000)]


class Distance(_Strict):
    """How far an agent stays from another."""

    to: Name
    """The other agent."""
    at_least: Annotated[float, Gt(0.0), Le(1e6)] | None = None
    """[m] between the two places on the ground."""
    at_most: Annotated[float, Gt(0.0), Le(1e6)] | None = None
    """[m]"""
    after: Annotated[float, Ge(0.0), Le(86400.0)] = 0.0
    """[s] What happens earlier does not count."""

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if self.at_least is None and self.at_most is None:
            raise ValueError("at_least, at_most or both are needed")
        if self.at_least is not None and self.at_most is not None and self.at_least >= self.at_most:
            raise ValueError("at_least must be below at_most")
        return self


class Expectation(_Strict):
    """What has to hold for the mission to succeed; what is left out is not looked at."""

    arrives_within: Seconds | None = None
    """[s] Simulated time by which the agent has done everything that it was told."""
    never_falls: bool | None = None
    """Whether the agent stays on its feet for the whole mission."""
    uses_skills: list[Skill] | None = None
    """Skills that the agent finishes at least once."""
    stays_out_of: list[Name] | None = None
    """Regions in which the agent never is."""
    keeps_distance: list[Distance] | None = None


class Style(_Strict):
    """How a person differs from others. What is left out is by chance, or as usual while it is simulated."""

    phase: Annotated[float, Ge(0.0), Le(1.0)] | None = None
    """Of its steps, as a share of two of them."""
    pace: Annotated[float, Ge(0.8), Le(1.25)] | None = None
    """Share of its speed whose strides it takes: above 1 longer and fewer ones."""
    width: Annotated[float, Ge(-0.05), Le(0.15)] | None = None
    """[rad] By which each leg is spread."""
    arms: Annotated[float, Ge(0.0), Le(2.0)] | None = None
    """How far they swing, as a share."""
    lean: Annotated[float, Ge(-0.2), Le(0.3)] | None = None
    """[rad] Of the trunk, ahead."""
    head: Annotated[float, Ge(-0.3), Le(0.3)] | None = None
    """[rad] Bent ahead."""
    size: Annotated[float, Ge(0.8), Le(1.2)] | None = None
    """Of the whole figure, as a share of 1.76 m; by default 1. 0.88 is 1.55 m, 1.08 is 1.90 m."""

    @property
    def traits(self) -> dict[str, float]:
        """Those that are given."""
        return self.model_dump(exclude_none=True)


class AgentSpec(_Strict):
    """One figure: where it starts and what it does."""

    name: Name
    body: Body = USUAL
    """One of ours, or the .yaml file of a quadruped of one's own, relative to the mission's."""
    start: Place
    """(x, y, z) [m], Z up, or a waypoint; snapped to the walkable surface below."""
    facing_deg: Annotated[float, Ge(-360.0), Le(360.0)] = 0.0
    """[°] Counter-clockwise from the X axis."""
    detail: Detail = PHYSICS
    """Of a person: simulated, or drawn by recorded motion; `auto`: by who of the `viewers` looks on."""
    style: Style | None = None
    """Of a person."""
    speed: Speed = 3.5
    """[m/s] Along its path."""
    goto: Places | None = None
    """Places, reached one after the other: short for a script with only this."""
    script: Steps | None = None
    """Actions, one after the other. Without `goto` and `script` it stands until a trigger tells it more."""
    expect: Expectation = Expectation()

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if self.goto is not None and self.script is not None:
            raise ValueError("either goto or script, not both")
        return self

    @property
    def steps(self) -> tuple[Step, ...]:
        """What it does of its own accord."""
        return tuple(self.script or ()) if self.goto is None else (Step(goto=self.goto),)


class Entering(_Strict):
    """An agent gets into a region."""

    agent: Name
    region: Name


class Using(_Strict):
    """An agent finishes a skill."""

    agent: Name
    skill: Skill


_EVENTS = ("after", "arrives", "falls", "enters", "uses")


class When(_Strict):
    """What a trigger waits for."""

    after: Seconds | None = None
    """[s] That much time has passed."""
    arrives: Name | None = None
    """This agent has reached the last place of a goto."""
    falls: Name | None = None
    """This agent has fallen."""
    enters: Entering | None = None
    uses: Using | None = None

    model_config = _requires_one(_EVENTS)

    @model_validator(mode="after")
    def _whole(self) -> Self:
        self._one_of("event", _EVENTS)
        return self


class Order(_Strict):
    """What an agent does from now on, instead of what it did."""

    agent: Name
    do: Steps


class Trigger(_Strict):
    """Orders that are given once, when something happens for the first time."""

    when: When
    then: Annotated[list[Order], Len(1, 100)]


class ViewerSpec(_Strict):
    """A camera or a player: people whose detail is `auto` go by it."""

    position: Point
    """[m]"""
    direction: Point = [1.0, 0.0, 0.0]
    """In which it looks, of any length above 0."""
    field_of_view_deg: Annotated[float, Gt(0.0), Le(360.0)] = 90.0
    """[°] From one edge of the picture to the other."""

    @model_validator(mode="after")
    def _whole(self) -> Self:
        if not any(self.direction):
            raise ValueError("direction must have a length")
        return self


class Mission(_Strict):
    """The content of a mission file."""

    level: LevelSpec
    rules: RulesSpec = RulesSpec()
    seed: Annotated[int, Ge(0), Le(2**63 - 1)] = 0
    time_limit: Seconds = 120.0
    """[s] Simulated time after which the mission ends in any case."""
    waypoints: Annotated[dict[Name, Point], Len(0, 1000)] = {}
    """Points with names, for use wherever a place is wanted."""
    regions: Annotated[dict[Name, Region], Len(0, 1000)] = {}
    skills: Annotated[list[str], Len(0, 100)] = []
    """Files that describe skills of one's own, relative to the mission's: its people have them, too."""
    agents: Annotated[list[AgentSpec], Len(1, 100)]
    triggers: Annotated[list[Trigger], Len(0, 1000)] = []
    players: Annotated[list[Place], Len(0, 100)] | None = None
    """Around whom an open world is loaded: agents by name, wherever they go, waypoints and points [m]; by
    default all agents."""
    viewers: Annotated[list[ViewerSpec], Len(0, 100)] = []
    """Who looks on."""
