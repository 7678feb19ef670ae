"""Messages between clients and server: one JSON object per WebSocket text message.

    python -m runtime.server.messages docs/reference/server.schema.json

writes the JSON schema of all of them.

Metres, seconds, radians; Z up; quaternions (w, x, y, z). A client sends requests, `Hello` first, each with an
``id`` of its choice that the reply repeats. Replies, errors and events carry ``seq``, which counts up by 1
for each client: none is lost or reordered. States carry none: a slow client gets only the newest. Types are
strict: a number may not be given as text, true or false.
"""

import json
import sys
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

from runtime.bodies.registry import body_names
from surefoot.files.atomic_write import whole_file
from surefoot.files.choices import OneOf

__all__ = [
    "PROTOCOL",
    "REQUEST",
    "Chunk",
    "Close",
    "Create",
    "GoTo",
    "Graph",
    "Hello",
    "Hold",
    "Join",
    "Leave",
    "Level",
    "Players",
    "Push",
    "Remove",
    "Request",
    "Restore",
    "Save",
    "SetDetail",
    "SetStyle",
    "Spawn",
    "States",
    "Step",
    "Stop",
    "TakePosture",
    "Viewers",
    "Way",
    "write_schema",
]

PROTOCOL = 2
"""Version of the messages; `Hello` must name it."""

_Name = Annotated[str, Field(min_length=1, max_length=40, pattern=r"^[\w .-]+$")]
_Metres = Annotated[float, Field(ge=-1e6, le=1e6)]
_Point = tuple[_Metres, _Metres, _Metres]
_Newtons = Annotated[float, Field(ge=-1e5, le=1e5)]
_Angle = Annotated[float, Field(ge=-100.0, le=100.0)]


_Body = Annotated[str, OneOf(body_names)]
"""A name that is registered. A file is none: clients name no files."""
States = Literal["none", "places", "world", "local", "changes"]
"""What a client receives after each step: nothing; each agent's place and activity; also its skeleton's
transforms in the world, or each relative to its parent; or only what has changed, people by joint angles
(`Changes`)."""


Detail = Literal["auto", "physics", "full", "medium", "low"]
"""Whether a person is simulated, or drawn by recorded motion of a level; "auto": by who looks on."""


class _Message(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, strict=True)


class _Request(_Message):
    id: Annotated[int, Field(ge=0, le=2**53 - 1, description="Repeated in the reply.")]


class Hello(_Request):
    """The first message of a client."""

    type: Literal["hello"]
    version: int
    token: Annotated[str, Field(max_length=256)] = ""


class Level(_Request):
    """Ask for the vertices and triangles of a level."""

    type: Literal["level"]
    level: _Name


class Graph(_Request):
    """Ask for a level's graph and its obstacles, to be drawn."""

    type: Literal["graph"]
    level: _Name


class Chunk(_Request):
    """Ask for the vertices and triangles of a chunk of an open world, loaded or not."""

    type: Literal["chunk"]
    level: _Name
    chunk: Annotated[str, Field(min_length=1, max_length=200)]


class Create(_Request):
    """Make a world and join it. ``clock``: "real" runs by itself, "manual" by `Step`. ``around``: places [m]
    around which an open world is loaded at first, and until the client says who its `Players` are."""

    type: Literal["create"]
    level: _Name
    seed: Annotated[int, Field(ge=0, le=2**53 - 1)] = 0
    clock: Literal["real", "manual"] = "real"
    states: States = "places"
    around: Annotated[list[_Point], Field(max_length=16)] = []


class Join(_Request):
    """Take part in a world that somebody made; sent again it changes ``states``."""

    type: Literal["join"]
    world: _Name
    states: States = "places"


class Leave(_Request):
    """Hear no more of a world."""

    type: Literal["leave"]
    world: _Name


class Close(_Request):
    """End a world for all."""

    type: Literal["close"]
    world: _Name


class Spawn(_Request):
    """Put an agent into a world; all who joined are told of its skeleton."""

    type: Literal["spawn"]
    world: _Name
    body: _Body
    at: _Point
    facing: _Angle = 0.0
    name: _Name | None = None
    detail: Detail = "physics"


class TakePosture(_Request):
    """Let a person take a posture, such as "kneel"; an event tells when it is in it."""

    type: Literal["posture"]
    world: _Name
    agent: _Name
    posture: Annotated[str, Field(max_length=40)]


class Hold(_Request):
    """Let a person have something in its hands: "deployed", "in use", or "stowed" again."""

    type: Literal["hold"]
    world: _Name
    agent: _Name
    object: Annotated[str, Field(max_length=40)]
    state: Annotated[str, Field(max_length=40)] = "deployed"


class SetDetail(_Request):
    """Say in how much detail a person is to be."""

    type: Literal["detail"]
    world: _Name
    agent: _Name
    detail: Detail


class SetStyle(_Request):
    """Let a person differ from others; all who joined are told the skeleton
    that it then has."""

    type: Literal["style"]
    world: _Name
    agent: _Name
    traits: Annotated[dict[Annotated[str, Field(max_length=40)], float], Field(min_length=1, max_length=16)]


class Push(_Request):
    """Push a simulated person at its waist with a ``force`` [N] for so many ``seconds``."""

    type: Literal["push"]
    world: _Name
    agent: _Name
    force: tuple[_Newtons, _Newtons, _Newtons]
    seconds: Annotated[float, Field(ge=0.01, le=10.0)] = 0.1


class Viewer(_Message):
    """A camera or a player; ``field_of_view`` [rad] from edge to edge."""

    position: _Point
    direction: _Point = (1.0, 0.0, 0.0)
    field_of_view: Annotated[float, Field(gt=0.0, le=6.2832)] = 1.5708


class Viewers(_Request):
    """Say who looks on: people whose detail is "auto" go by it."""

    type: Literal["viewers"]
    world: _Name
    viewers: Annotated[list[Viewer], Field(max_length=16)]


class Players(_Request):
    """Say around whom an open world is kept loaded: agents by name, wherever they go, and places [m], such as
    those of cameras. Replaces what this client said before; the players of others are kept, too."""

    type: Literal["players"]
    world: _Name
    players: Annotated[list[_Name | _Point], Field(max_length=16)]


class GoTo(_Request):
    """Send an agent through points, in order."""

    type: Literal["go_to"]
    world: _Name
    agent: _Name
    points: Annotated[list[_Point], Field(min_length=1, max_length=64)]
    speed: Annotated[float, Field(gt=0.0, le=20.0)] = 1.5
    facing: _Angle | None = None


class Stop(_Request):
    """Let an agent give up its way and come to a stand."""

    type: Literal["stop"]
    world: _Name
    agent: _Name


class Way(_Request):
    """Ask for the path that an agent is on."""

    type: Literal["way"]
    world: _Name
    agent: _Name


class Remove(_Request):
    """Take an agent out of its world."""

    type: Literal["remove"]
    world: _Name
    agent: _Name


class Step(_Request):
    """Advance a world with a manual clock by ``dt`` [s]."""

    type: Literal["step"]
    world: _Name
    dt: Annotated[float, Field(ge=0.0, le=1.0)]


class Save(_Request):
    """Keep the present moment of a world in the server, in place of the one kept before."""

    type: Literal["save"]
    world: _Name


class Restore(_Request):
    """Go back to the moment that was saved."""

    type: Literal["restore"]
    world: _Name


Request = Annotated[
    Hello
    | Level
    | Graph
    | Chunk
    | Create
    | Join
    | Leave
    | Close
    | Spawn
    | GoTo
    | TakePosture
    | Hold
    | SetDetail
    | SetStyle
    | Push
    | Viewers
    | Players
    | Stop
    | Way
    | Remove
    | Step
    | Save
    | Restore,
    Field(discriminator="type"),
]
REQUEST: TypeAdapter[Any] = TypeAdapter(Request)


class _Ordered(_Message):
    seq: Annotated[int, Field(ge=1, description="Counts up by 1 for each client.")]


class Reply(_Ordered):
    """What a request led to; which fields ``result`` has is in docs/guides/server.md."""

    type: Literal["reply"]
    id: int
    result: dict[str, Any]


class Error(_Ordered):
    """A request that was refused. ``id`` is null where the message had none."""

    type: Literal["error"]
    id: int | None
    code: Literal["invalid", "refused", "internal"]
    message: str


class Event(_Ordered):
    """Something that happened in a world: `runtime.events` as plain values."""

    type: Literal["event"]
    world: str
    event: dict[str, Any]


class Joined(_Ordered):
    """An agent has come into a world, or has another size."""

    type: Literal["agent"]
    world: str
    agent: "Skeleton"


class Gone(_Ordered):
    """An agent (or with ``agent`` null the whole world) is no more."""

    type: Literal["gone"]
    world: str
    agent: str | None


class ChunksChanged(_Ordered):
    """Chunks of an open world have been loaded and dropped."""

    type: Literal["chunks"]
    world: str
    loaded: list[str]
    dropped: list[str]


class Skeleton(_Message):
    """``parents``: -1 for the root. ``offsets``: where a person's bodies have their origins in the frames of
    their parents, all frames parallel at rest; ``joints``: the hinges that turn them, in this order; both are
    empty for all others. ``owner``: of each shape the body that carries it; ``place``: its
    position and quaternion there; ``size``: as `runtime.bodies.figure.Shapes` has it; ``round``: an
    ellipsoid, else a capsule along z; ``colour``: red, green, blue, 0 to 1."""

    name: str
    body: str
    bodies: list[str]
    parents: list[int]
    offsets: list[tuple[float, float, float]]
    joints: list["Joint"]
    owner: list[int]
    place: list[list[float]]
    size: list[list[float]]
    round: list[bool]
    colour: list[list[float]]


class Joint(_Message):
    """A hinge: ``body``, the number of the body that it turns about ``axis``, in that body's frame."""

    name: str
    body: int
    axis: tuple[float, float, float]


class AgentState(_Message):
    """``level``: what moves it: "physics", or the level of detail of recorded motion. ``way``: the number of
    the path that it is on, another one when that has changed; null for none. ``holds``: what its hands hold
    and the state of that, such as "rifle deployed"; empty with free hands.
    ``transforms``: 7 numbers for each body, as `States` says."""

    name: str
    status: str
    level: str
    posture: str
    holds: str
    position: tuple[float, float, float]
    facing: float
    way: int | None
    transforms: list[float] | None = None


class State(_Message):
    """Where everybody is, after a step."""

    type: Literal["state"]
    world: str
    time: float
    agents: list[AgentState]


class AgentChange(_Message):
    """What is left out is as it was told last. Fields as in `AgentState`. A person has a ``number``, by which
    `Changes` tells where it is, in multiples of ``steps``: of places [m], and of angles [rad]. Others have
    ``position``, ``facing`` and ``transforms`` in the world."""

    name: str
    status: str | None = None
    level: str | None = None
    posture: str | None = None
    holds: str | None = None
    position: tuple[float, float, float] | None = None
    facing: float | None = None
    way: int | None = None
    number: int | None = None
    steps: tuple[float, float] | None = None
    transforms: list[float] | None = None


class Changes(_Message):
    """What has changed since the last message of this kind. Agents that have not are left out. Recorded
    people are looked at 60, 30 or 15 times a second, by their level. The first message tells everything.

    ``moved``: of each person that did its number, the indices of its channels that changed, and their values
    as multiples of a step. Channels: 0 to 2 its position, and 4 to 6 from there to its root, in steps of
    places; 3 its facing, and from 11 on the angles of `Skeleton.joints`, in steps of angles; 7 to 10 the
    quaternion of its root, in half steps of angles."""

    type: Literal["changes"]
    world: str
    time: float
    agents: list[AgentChange]
    moved: list[tuple[int, list[int], list[int]]]


Answer = Annotated[
    Reply | Error | Event | Joined | Gone | ChunksChanged | State | Changes,
    Field(discriminator="type"),
]


def write_schema(path: Path) -> None:
    """Write the JSON schema of all messages to ``path``."""
    both = {
        "title": f"Messages of surefoot serve, version {PROTOCOL}",
        "from_client": REQUEST.json_schema(),
        "from_server": TypeAdapter(Answer).json_schema(),
    }
    with whole_file(path) as file:
        file.write_text(json.dumps(both, indent=1) + "\n")


if __name__ == "__main__":
    write_schema(Path(sys.argv[1]))
