"""Arguments and options that several commands have."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer

from runtime.cli.starting import reads


class Up(StrEnum):
    """Up axis of a mesh file."""

    x = "x"
    y = "y"
    z = "z"


MESH_HELP = "Mesh file: OBJ, PLY, STL, OFF, glTF (.gltf, .glb), FBX or USD (docs/guides/meshes.md)."
CharacterOption = Annotated[
    Path | None,
    typer.Option(callback=reads, help="Rigged figure (.glb, .gltf) that all people are shown as."),
]
MappingOption = Annotated[
    str | None,
    typer.Option(
        help="Which of its bones shows which part: mixamo, vrm, unreal, surefoot, or a YAML file;"
        " default: guessed by the bones' names."
    ),
]
TraceArgument = Annotated[
    Path, typer.Argument(callback=reads, help="Trace (.npz), or a mission (.yaml), which is run first.")
]
UpOption = Annotated[
    Up | None,
    typer.Option(help="Up axis of the file; default: as the file says, y for glTF, else z."),
]
ScaleOption = Annotated[
    float | None, typer.Option(help="Metres per unit of the file; default: as the file says, else 1.")
]
ClusterOption = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Dask cluster that does the work: tls://HOST:PORT, or local:N for N workers here.",
    ),
]
JsonOption = Annotated[bool, typer.Option("--json", help="Print the result as JSON on standard output.")]
FollowOption = Annotated[str | None, typer.Option(help="Agent that the camera follows; default: the first.")]
SlopeOption = Annotated[float | None, typer.Option(help="[°] Steepest walkable slope.")]
StepOption = Annotated[float | None, typer.Option(help="[m] Highest walkable step.")]
HeadroomOption = Annotated[float | None, typer.Option(help="[m] Headroom that walking needs.")]
ResolutionOption = Annotated[
    float | None, typer.Option(help="[m] Spacing of the samples taken on the surface.")
]
DisOption = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS:PORT", help="Talk to other simulators by DIS: where to send PDUs."),
]
DisListenOption = Annotated[
    str | None,
    typer.Option(metavar="ADDRESS:PORT", help="Where to listen for PDUs; default: this machine, same port."),
]
DisNameOption = Annotated[
    str, typer.Option(metavar="SITE:APPLICATION:EXERCISE", help="Our numbers among the other simulators.")
]
DisOriginOption = Annotated[
    tuple[float, float, float],
    typer.Option(
        metavar="LATITUDE LONGITUDE HEIGHT",
        help="[°, °, m] Where on the earth the level's origin is.",
        show_default="0 0 0",
    ),
]
MulticastOption = Annotated[bool, typer.Option("--multicast", help="Allow multicast addresses.")]
BroadcastOption = Annotated[bool, typer.Option("--broadcast", help="Allow broadcast addresses.")]


def dis_line(
    to: str | None,
    listen: str | None,
    name: str,
    origin: tuple[float, float, float],
    multicast: bool,
    broadcast: bool,
) -> Any:
    """The line to other simulators that the options ask for, None without one."""
    from runtime.cli.dis_line import DisLine

    return None if to is None else DisLine(to, listen, name, origin, multicast, broadcast)
