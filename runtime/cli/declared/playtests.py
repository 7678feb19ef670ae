"""``surefoot playtest`` and ``replay``."""

from pathlib import Path
from typing import Annotated

import typer

from runtime.cli.declared.options import MESH_HELP, ClusterOption, JsonOption, ScaleOption, UpOption
from runtime.cli.starting import begin, finish, reads


def playtest(
    context: typer.Context,
    level: Annotated[
        Path,
        typer.Argument(
            callback=reads,
            help=f"{MESH_HELP} Or the folder of an open world, or a suite of playtests (.yaml).",
        ),
    ],
    bots: Annotated[int, typer.Option(min=0, help="How many bots.")] = 64,
    seconds: Annotated[float, typer.Option(help="[s] How long each bot plays.")] = 300.0,
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same report.")] = 0,
    body: Annotated[str, typer.Option(help="walker (quick) or any other body of a world.")] = "walker",
    plan: Annotated[
        Path | None,
        typer.Option(
            callback=reads, help="File with spawns, places and expectations; default: LEVEL.playtest.yaml."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for report.html, report.json and junit.xml.")
    ] = None,
    before: Annotated[
        Path | None, typer.Option(callback=reads, help="Earlier report.json to compare with.")
    ] = None,
    processes: Annotated[
        int, typer.Option(min=1, help="Number of processes; does not change the report.")
    ] = 1,
    cluster: ClusterOption = None,
    up: UpOption = None,
    scale: ScaleOption = None,
    as_json: JsonOption = False,
) -> None:
    """Send bots through a level, or through all levels of a suite, and report faults. The exit code is 1 if
    there are any."""
    begin()
    from runtime.playtest.command import playtest_level, playtest_suite

    if level.suffix.lower() in (".yaml", ".yml"):
        for name in ("bots", "seconds", "seed", "body", "plan", "up", "scale"):
            source = context.get_parameter_source(name)
            if source is not None and source.name != "DEFAULT":
                raise typer.BadParameter(f"a suite says that itself: {level}", param_hint=f"--{name}")
        finish(playtest_suite(level, out, before, processes, cluster), as_json)
        return
    options = {
        "bots": bots, "seconds": seconds, "seed": seed, "body": body, "plan": plan, "up": up,
        "scale": scale, "processes": processes, "cluster": cluster,
    }  # fmt: skip
    finish(playtest_level(level, options, out, before), as_json)


def replay(
    report: Annotated[
        Path, typer.Argument(callback=reads, help="report.json written by `surefoot playtest --out`.")
    ],
    number: Annotated[int, typer.Argument(help="Number of the finding in the report.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file for the page (.html).")] = Path(
        "replay.html"
    ),
    as_json: JsonOption = False,
) -> None:
    """Write a page that replays a finding of a playtest: the bot that found it runs again."""
    begin()
    from runtime.playtest.command import replay_finding

    finish(replay_finding(report, number, output), as_json)
