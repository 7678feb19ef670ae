"""``surefoot bake``, ``obstacles`` and ``path``: a level's graph."""

from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.declared.options import (
    MESH_HELP,
    HeadroomOption,
    JsonOption,
    ResolutionOption,
    ScaleOption,
    SlopeOption,
    StepOption,
    UpOption,
)
from runtime.cli.starting import begin, finish, reads


def bake(
    level: Annotated[Path, typer.Argument(callback=reads, help=MESH_HELP)],
    output: Annotated[
        Path,
        typer.Option(
            "--output", "-o", help="Output file for the baked graph (.npz); for an open world a folder."
        ),
    ],
    up: UpOption = None,
    scale: ScaleOption = None,
    tags: Annotated[
        Path | None,
        typer.Option(
            callback=reads,
            help="File with your corrections of the obstacles; default: LEVEL.tags.yaml if it exists.",
        ),
    ] = None,
    max_slope_deg: SlopeOption = None,
    max_step: StepOption = None,
    headroom: HeadroomOption = None,
    resolution: ResolutionOption = None,
    threads: Annotated[int, typer.Option(min=1, help="Threads that build; the graph is the same.")] = 1,
    open_world: Annotated[
        bool,
        typer.Option(
            "--open-world",
            help="Write a folder from which a game loads what is around its players.",
        ),
    ] = False,
    radius: Annotated[
        list[float] | None,
        typer.Option(
            metavar="<float>",
            help="[m] With --open-world: radius of a body; give it again for others; default: 0.3.",
        ),
    ] = None,
    side: Annotated[
        float | None,
        typer.Option(help="[m] With --open-world: side of the squares that it is cut into; default: 60."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Build a level's navigation graph and write it to a file, or the folder of an open world. The defaults
    suit a person."""
    rules = {
        "max_slope_deg": max_slope_deg,
        "max_step": max_step,
        "headroom": headroom,
        "resolution": resolution,
    }
    commands = begin()
    if not open_world:
        for option, given in (("--radius", bool(radius)), ("--side", side is not None)):
            if given:
                raise typer.BadParameter(f"{option}: is for open worlds; give --open-world, too")
        finish(commands.bake_level(level, output, up, scale, tags, rules, threads), as_json)
        return
    from runtime.cli import world_commands

    world_commands.refuse_tags(level, tags)
    finish(
        world_commands.bake_world(
            level, output, up, scale, radius or [0.3], 60.0 if side is None else side, rules, threads
        ),
        as_json,
    )


def obstacles(
    level: Annotated[
        Path, typer.Argument(callback=reads, help="Mesh file, or a graph written by `surefoot bake`.")
    ],
    up: UpOption = None,
    scale: ScaleOption = None,
    as_json: JsonOption = False,
) -> None:
    """List the obstacles of a level that a skill can clear, with their sizes, positions and the names that
    missions use."""
    finish(begin().list_obstacles(level, up, scale), as_json)


def path(
    graph: Annotated[Path, typer.Argument(help="Graph written by `surefoot bake`.")],
    start: Annotated[
        tuple[float, float, float], typer.Option(metavar="X Y Z", help="[m] Start x y z, Z up.")
    ],
    goal: Annotated[tuple[float, float, float], typer.Option(metavar="X Y Z", help="[m] Goal x y z, Z up.")],
    radius: Annotated[float, typer.Option(help="[m] Radius of the body.")] = 0.3,
    jump: Annotated[
        tuple[float, float],
        typer.Option(
            metavar="LEAST GREATEST",
            help="[m] Lowest and highest platform to jump onto; 0 0: none.",
            show_default="0 0",
        ),
    ] = (0.0, 0.0),
    smooth: Annotated[
        bool, typer.Option(help="Print the smoothed path instead of the string-pulled one.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Find a path on a baked graph."""
    finish(begin().find_path(graph, start, goal, radius, jump, smooth), as_json)
