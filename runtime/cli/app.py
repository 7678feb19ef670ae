"""The ``surefoot`` command."""

import gc
import importlib.util
import json
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import exceptions as typer_exceptions
from typer.core import TyperCommand

from surefoot import __version__
from surefoot.errors import SurefootError

app = typer.Typer(
    no_args_is_help=True, add_completion=False, pretty_exceptions_enable=False, rich_markup_mode=None,
    help="Navigation and locomotion for game characters. "
    "Exit codes: 0: it worked or passed, 1: it did not, 2: wrong input.",
)  # fmt: skip


_INTERRUPTED = 130
"""Exit code after Ctrl-C."""


_inputs: list[str | Path] = []
"""Files that the command reads; it never writes to any of them (`surefoot.files.inputs`)."""
_after = ExitStack()
"""Cleanup to run when the command ends."""


def _input(value: Any) -> Any:
    """Callback of every argument and option that names an input file."""
    _inputs.extend(value if isinstance(value, list) else [] if value is None else [value])
    return value


class Up(StrEnum):
    """Up axis of a mesh file."""

    x = "x"
    y = "y"
    z = "z"


PRECONDITIONS = "preconditions"
"""What is trained and evaluated of all skills together."""


def _skills() -> tuple[str, ...]:
    """What can be trained: gaits, skills that clear obstacles, and when these hold."""
    _loaded()
    from locomotion.skills.registry import skill_words

    return ("run", "walk", "walk-policy", "speed-up", "slow-down", "brake", *skill_words(), PRECONDITIONS)


def _skill(name: str) -> str:
    if not name.endswith((".yaml", ".yml")) and name not in _skills():
        raise typer.BadParameter(
            f"{name!r}: valid: {', '.join(_skills())}, or the .yaml file that describes one"
        )
    return name


SkillArgument = typer.Argument(
    parser=_skill, callback=_input,
    help="A built-in skill, or the file (.yaml) that describes one of your own.",
)  # fmt: skip


class _OnSkills(TyperCommand):
    """A command on a skill. Which there are is looked up only when it is called: that imports a lot."""

    def get_params(self, ctx: Any) -> list[Any]:
        parameters = super().get_params(ctx)
        for parameter in parameters:
            if parameter.name == "skill":
                parameter.metavar = f"[{'|'.join(_skills())}|FILE.yaml]"
        return parameters


MESH_HELP = "Mesh file: OBJ, PLY, STL, OFF, glTF (.gltf, .glb), FBX or USD (docs/guides/meshes.md)."
CharacterOption = Annotated[
    Path | None,
    typer.Option(callback=_input, help="Rigged figure (.glb, .gltf) that all people are shown as."),
]
MappingOption = Annotated[
    str | None,
    typer.Option(
        help="Which of its bones shows which part: mixamo, vrm, unreal, surefoot, or a YAML file;"
        " default: guessed by the bones' names."
    ),
]
TraceArgument = Annotated[
    Path, typer.Argument(callback=_input, help="Trace (.npz), or a mission (.yaml), which is run first.")
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


def _show_version(wanted: bool) -> None:
    if wanted:
        print(f"surefoot {__version__}")
        raise typer.Exit


@app.callback()
def _surefoot(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version and exit."),
    ] = False,
) -> None:
    pass


@app.command()
def bake(
    level: Annotated[Path, typer.Argument(callback=_input, help=MESH_HELP)],
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file for the baked graph (.npz).")],
    up: UpOption = None,
    scale: ScaleOption = None,
    tags: Annotated[
        Path | None,
        typer.Option(
            callback=_input,
            help="File with your corrections of the obstacles; default: LEVEL.tags.yaml if it exists.",
        ),
    ] = None,
    max_slope_deg: SlopeOption = None,
    max_step: StepOption = None,
    headroom: HeadroomOption = None,
    resolution: ResolutionOption = None,
    as_json: JsonOption = False,
) -> None:
    """Build a level's navigation graph and write it to a file. The defaults suit a person."""
    rules = {
        "max_slope_deg": max_slope_deg,
        "max_step": max_step,
        "headroom": headroom,
        "resolution": resolution,
    }
    _finish(_commands().bake_level(level, output, up, scale, tags, rules), as_json)


@app.command()
def cache(
    clear: Annotated[bool, typer.Option("--clear", help="Remove all compiled kernels.")] = False,
    as_json: JsonOption = False,
) -> None:
    """Show where compiled kernels are kept and how much space they take, or remove them."""
    from surefoot.kernels import folder

    if clear:
        folder.clear()
    kept, size = folder.cache_folder(), folder.size_of_cache()
    if as_json:
        print(json.dumps({"folder": kept and str(kept), "bytes": size}))
    elif kept is None:
        print("nowhere: no cache folder is writable; set NUMBA_CACHE_DIR to one that is")
    else:
        print(f"{kept}: {size / 1e6:.1f} MB")


@app.command()
def obstacles(
    level: Annotated[
        Path, typer.Argument(callback=_input, help="Mesh file, or a graph written by `surefoot bake`.")
    ],
    up: UpOption = None,
    scale: ScaleOption = None,
    as_json: JsonOption = False,
) -> None:
    """List the obstacles of a level that a skill can clear, with their sizes, positions and the names that
    missions use."""
    _finish(_commands().list_obstacles(level, up, scale), as_json)


@app.command()
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
    _finish(_commands().find_path(graph, start, goal, radius, jump, smooth), as_json)


@app.command()
def run(
    mission: Annotated[Path, typer.Argument(callback=_input, help="Mission file (YAML).")],
    out: Annotated[Path | None, typer.Option(help="Folder for the trace, plot, film strip and page.")] = None,
    dis: DisOption = None,
    dis_listen: DisListenOption = None,
    dis_name: DisNameOption = "1:1:1",
    dis_origin: DisOriginOption = (0.0, 0.0, 0.0),
    multicast: MulticastOption = False,
    broadcast: BroadcastOption = False,
    as_json: JsonOption = False,
) -> None:
    """Run a mission as fast as possible and print what happened; in real time with --dis."""
    commands = _commands()
    line = _dis_line(dis, dis_listen, dis_name, dis_origin, multicast, broadcast)
    _finish(commands.run_mission_file(mission, out, line), as_json)


@app.command()
def check(
    mission: Annotated[Path, typer.Argument(callback=_input, help="Mission file (YAML).")],
    as_json: JsonOption = False,
) -> None:
    """Check a mission without running it: its file, its level, and that every place can be reached."""
    _finish(_commands().check_mission_file(mission), as_json)


@app.command()
def schema(
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Output file for the schema; default: standard output."),
    ] = None,
) -> None:
    """Write the JSON schema of mission files, which editors use to check and complete them."""
    _commands().write_schema(output)


@app.command()
def view(
    source: Annotated[
        str,
        typer.Argument(
            callback=_input,
            help="Trace (.npz), mission (.yaml), which is run first, or a server's address (ws://…).",
        ),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file for the page (.html).")] = Path(
        "view.html"
    ),
    follow: Annotated[
        str | None, typer.Option(help="Agent that the camera follows; default: the camera stands still.")
    ] = None,
    live: Annotated[bool, typer.Option(help="Run the mission in real time and watch it live.")] = False,
    world: Annotated[
        str | None, typer.Option(help="With a server: the world to watch; default: the only one.")
    ] = None,
    token: Annotated[
        str, typer.Option(envvar="SUREFOOT_TOKEN", help="With a server: its token, if it needs one.")
    ] = "",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port of the live page; 0: any free port.")] = 0,
    character: CharacterOption = None,
    mapping: MappingOption = None,
    as_json: JsonOption = False,
) -> None:
    """Write a page that replays a run in a browser, without server or network; or watch a world of `surefoot
    serve` live."""
    commands = _view_commands()
    served = source.startswith(("ws://", "wss://"))
    if character is not None and (live or served):
        raise typer.BadParameter(
            "a live view shows people as they are; leave out --character", param_hint="--character"
        )
    if served:
        _finish(commands.watch_served(source, world, token, port), as_json)
    elif live:
        _finish(commands.watch_mission(Path(source), port), as_json)
    else:
        _finish(commands.write_view(Path(source), output, follow, character, mapping), as_json)


@app.command()
def export(
    source: TraceArgument,
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file (.glb).")] = Path("run.glb"),
    character: CharacterOption = None,
    mapping: MappingOption = None,
    as_json: JsonOption = False,
) -> None:
    """Export a run as animated glTF for Blender, Godot, three.js and other tools."""
    _finish(_view_commands().export_gltf(source, output, character, mapping), as_json)


@app.command()
def film(
    source: TraceArgument,
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file (.mp4).")] = Path("run.mp4"),
    follow: FollowOption = None,
    character: CharacterOption = None,
    mapping: MappingOption = None,
    as_json: JsonOption = False,
) -> None:
    """Render a run as a video. Needs no GPU or display, but about half a second for each frame."""
    _finish(_view_commands().write_video(source, output, follow, character, mapping), as_json)


@app.command()
def serve(
    levels: Annotated[
        list[Path], typer.Argument(callback=_input, help="Mesh files, or graphs written by `surefoot bake`.")
    ],
    host: Annotated[
        str, typer.Option(help="Address to listen on; any other than this machine needs --token.")
    ] = ("127.0.0.1"),
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port to listen on; 0: any free port.")] = 8765,
    token: Annotated[
        str, typer.Option(envvar="SUREFOOT_TOKEN", help="Secret that clients must send to connect.")
    ] = "",
    pages: Annotated[Path | None, typer.Option(help="Folder of web pages to serve over HTTP.")] = None,
    up: UpOption = None,
    scale: ScaleOption = None,
    dis: DisOption = None,
    dis_listen: DisListenOption = None,
    dis_name: DisNameOption = "1:1:1",
    dis_origin: DisOriginOption = (0.0, 0.0, 0.0),
    multicast: MulticastOption = False,
    broadcast: BroadcastOption = False,
) -> None:
    """Run worlds for engines in other languages, over WebSockets. Stop with Ctrl-C. With --dis the first
    world that a client creates talks to other simulators."""
    commands = _commands()
    line = _dis_line(dis, dis_listen, dis_name, dis_origin, multicast, broadcast)
    commands.serve_worlds(levels, up, scale, host, port, token, pages, line)


class DisAction(StrEnum):
    """What `surefoot dis` does."""

    record = "record"
    replay = "replay"
    show = "show"


@app.command()
def dis(
    action: Annotated[DisAction, typer.Argument(help="Record what comes, send it again, or list it.")],
    file: Annotated[Path, typer.Argument(help="Packets (.pcap).")],
    address: Annotated[
        str,
        typer.Option(metavar="ADDRESS:PORT", help="Where to listen (record) or to send (replay)."),
    ] = "127.0.0.1:3000",
    seconds: Annotated[float, typer.Option(help="[s] How long to record.")] = 10.0,
    speed: Annotated[float, typer.Option(help="How many times faster to replay.")] = 1.0,
    multicast: MulticastOption = False,
    broadcast: BroadcastOption = False,
    as_json: JsonOption = False,
) -> None:
    """Record, replay or show DIS packets."""
    _commands()
    from runtime.cli import dis_commands

    if action is DisAction.record:
        result = dis_commands.record_packets(file, address, seconds, multicast, broadcast)
    elif action is DisAction.replay:
        result = dis_commands.replay_packets(file, address, speed, multicast, broadcast)
    else:
        result = dis_commands.show_packets(file)
    _finish(result, as_json)


def _dis_line(
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


@app.command()
def playtest(
    context: typer.Context,
    level: Annotated[
        Path, typer.Argument(callback=_input, help=f"{MESH_HELP} Or a suite of playtests (.yaml).")
    ],
    bots: Annotated[int, typer.Option(min=0, help="How many bots.")] = 64,
    seconds: Annotated[float, typer.Option(help="[s] How long each bot plays.")] = 300.0,
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same report.")] = 0,
    body: Annotated[str, typer.Option(help="walker (quick) or any other body of a world.")] = "walker",
    plan: Annotated[
        Path | None,
        typer.Option(
            callback=_input, help="File with spawns, places and expectations; default: LEVEL.playtest.yaml."
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for report.html, report.json and junit.xml.")
    ] = None,
    before: Annotated[
        Path | None, typer.Option(callback=_input, help="Earlier report.json to compare with.")
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
    _commands()
    from runtime.playtest.command import playtest_level, playtest_suite

    if level.suffix.lower() in (".yaml", ".yml"):
        for name in ("bots", "seconds", "seed", "body", "plan", "up", "scale"):
            source = context.get_parameter_source(name)
            if source is not None and source.name != "DEFAULT":
                raise typer.BadParameter(f"a suite says that itself: {level}", param_hint=f"--{name}")
        _finish(playtest_suite(level, out, before, processes, cluster), as_json)
        return
    options = {
        "bots": bots, "seconds": seconds, "seed": seed, "body": body, "plan": plan, "up": up,
        "scale": scale, "processes": processes, "cluster": cluster,
    }  # fmt: skip
    _finish(playtest_level(level, options, out, before), as_json)


@app.command()
def replay(
    report: Annotated[
        Path, typer.Argument(callback=_input, help="report.json written by `surefoot playtest --out`.")
    ],
    number: Annotated[int, typer.Argument(help="Number of the finding in the report.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file for the page (.html).")] = Path(
        "replay.html"
    ),
    as_json: JsonOption = False,
) -> None:
    """Write a page that replays a finding of a playtest: the bot that found it runs again."""
    _commands()
    from runtime.playtest.command import replay_finding

    _finish(replay_finding(report, number, output), as_json)


@app.command(cls=_OnSkills)
def train(
    skill: Annotated[str | None, SkillArgument] = None,
    everything: Annotated[
        bool, typer.Option("--all", help="Train all built-in skills, one after another.")
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Output file for the skill (preconditions: a folder); default: as FILE.yaml says, or the "
            "built-in one (--replace).",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same skill.")] = 0,
    workers: Annotated[int, typer.Option(min=1, help="Processes.")] = 2,
    cluster: ClusterOption = None,
    checkpoint: Annotated[
        Path | None,
        typer.Option(
            help="Folder for intermediate results; default: SKILL.checkpoint in the current folder."
        ),
    ] = None,
    effort: Annotated[
        float, typer.Option(min=0.01, max=100.0, help="Multiplies the number of generations.")
    ] = 1.0,
    replace: Annotated[bool, typer.Option("--replace", help="Overwrite the built-in skills.")] = False,
) -> None:
    """Train a skill, or the preconditions of all skills. If interrupted, run it again to continue from its
    checkpoint. A skill that never works is not written, and the exit code is 1."""
    if (skill is None) is not everything or (everything and (output or checkpoint)):
        raise typer.BadParameter("name one skill, or --all without --output and --checkpoint")
    _commands()
    from runtime.cli import skill_commands
    from runtime.cli.precondition_commands import train_all_preconditions

    if skill == PRECONDITIONS:
        result = train_all_preconditions(seed, cluster or workers, checkpoint, effort, output, replace)
    elif skill is None:
        result = skill_commands.train_library(seed, cluster or workers, effort, replace)
    else:
        result = skill_commands.train_skill(
            skill, output, seed, cluster or workers, checkpoint, effort, replace
        )
    _finish(result, as_json=False)


@app.command(cls=_OnSkills)
def evaluate(
    skill: Annotated[str, SkillArgument],
    trials: Annotated[int, typer.Option(min=1, help="Number of trials in each test.")] = 20,
    seed: Annotated[int, typer.Option(min=0, help="Of the trials.")] = 0,
    picture: Annotated[
        Path | None, typer.Option(help="Output file for a picture of which trials held (.png).")
    ] = None,
    processes: Annotated[
        int, typer.Option(min=1, help="Number of processes; does not change the result.")
    ] = 1,
    cluster: ClusterOption = None,
    as_json: JsonOption = False,
) -> None:
    """Try a learned skill from many starts and print how often it holds; of preconditions, how good their
    odds are."""
    _commands()
    from runtime.cli.precondition_commands import evaluate_preconditions
    from runtime.cli.skill_commands import evaluate_skill

    if skill == PRECONDITIONS:
        _finish(evaluate_preconditions(trials, seed, picture, cluster or processes), as_json)
    else:
        _finish(evaluate_skill(skill, trials, seed, picture, cluster or processes), as_json)


def _sampled(name: str) -> str:
    _loaded()
    from locomotion.training.preconditions.train import sampled_skills

    if name not in sampled_skills():
        raise typer.BadParameter(f"{name!r}: valid: {', '.join(sampled_skills())}")
    return name


@app.command()
def sample(
    skill: Annotated[
        str,
        typer.Argument(parser=_sampled, metavar="SKILL", help="A skill for obstacles, or slow-down."),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file (.npz).")],
    count: Annotated[int, typer.Option(min=1, help="Number of starts.")] = 1000,
    seed: Annotated[int, typer.Option(min=0, help="Of the starts.")] = 0,
    processes: Annotated[int, typer.Option(min=1, help="Number of processes; does not change the file.")] = 1,
    cluster: ClusterOption = None,
    as_json: JsonOption = False,
) -> None:
    """Try a skill without rehearsals from many starts, easy and hopeless ones, and write what comes of them.
    If interrupted, run it again to continue."""
    _commands()
    from runtime.cli.precondition_commands import sample_skill

    _finish(sample_skill(skill, count, seed, output, cluster or processes), as_json)


@app.command()
def clip(
    source: Annotated[
        Path,
        typer.Argument(
            callback=_input, help="Clip of keyframes (.yaml), captured motion (.bvh) or saved motion (.npz)."
        ),
    ],
    mapping: Annotated[
        Path | None,
        typer.Option(
            "--map",
            callback=_input,
            help="File that maps parts of the person to joints of the capture (.yaml).",
        ),
    ] = None,
    units: Annotated[str, typer.Option(help="Unit of length of a .bvh file: m, cm, mm, in or ft.")] = "cm",
    up: Annotated[Up, typer.Option(help="Up axis of a .bvh file.")] = Up.y,
    film: Annotated[Path | None, typer.Option(help="Output file for a film strip (.png).")] = None,
    stretch: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="BEGIN END", help="[s] Part of the motion to use."),
    ] = None,
    mirror: Annotated[bool, typer.Option("--mirror", help="Swap left and right.")] = False,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Output file for the motion (.npz) or its keyframes (.yaml)."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Show a motion and report where it exceeds joint ranges, sinks into the ground or floats."""
    _commands()
    from runtime.cli.skill_commands import show_clip

    _finish(show_clip(source, mapping, units, up.value, stretch, mirror, film, output), as_json)


@app.command()
def postures(
    file: Annotated[Path, typer.Argument(callback=_input, help="Posture file (.yaml).")],
    film: Annotated[
        Path | None, typer.Option(help="Output file for a picture of all postures and arcs (.png).")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Check a posture graph: what cannot be reached, does not meet, floats, sinks or bends too far."""
    _commands()
    from runtime.cli.posture_commands import show_postures

    _finish(show_postures(file, film), as_json)


@app.command()
def record(
    source: Annotated[
        Path | None,
        typer.Argument(callback=_input, help="Posture file (.yaml); with --list, recorded motions (.npz)."),
    ] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Output file for the motions (.npz).")
    ] = Path("motions.npz"),
    listed: Annotated[
        bool, typer.Option("--list", help="List the clips of a file, or of the package, and their origins.")
    ] = False,
    as_json: JsonOption = False,
) -> None:
    """Record the person's motions, from its simulation and from a posture graph, at three levels of
    detail."""
    if source is None and not listed:
        raise typer.BadParameter("name a posture file, or list what the package has with --list")
    _commands()
    from runtime.cli.record_commands import list_motions, record_motions

    if listed:
        result = list_motions(source)
    else:
        assert source is not None
        result = record_motions(source, output)
    _finish(result, as_json)


def _commands() -> Any:
    """The module `runtime.cli.commands`; from now on nothing is written to what the command reads."""
    commands = _loaded()
    from surefoot.files.inputs import keep_inputs

    _after.enter_context(keep_inputs(_inputs))
    return commands


def _loaded() -> Any:
    """The module `runtime.cli.commands`, imported when a command needs it.

    The imported modules live until exit, so they are frozen out of garbage collection: scanning them would
    take as long as the imports. MuJoCo need not look for a display, because no command draws with it. Ctrl-C
    waits until the imports are done: extension modules drop it while loading, or turn it into an ImportError.
    """
    os.environ.setdefault("MUJOCO_GL", "disable")
    gc.disable()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, (signal.SIGINT, signal.SIGTERM))
    try:
        with _told_that_it_loads():
            from runtime.cli import commands
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    gc.freeze()
    gc.enable()
    return commands


@contextmanager
def _told_that_it_loads() -> Iterator[None]:
    """Say that modules are loading: on a terminal every time; elsewhere only on the first start, which is
    slowest because Python has yet to compile them."""
    begin, end = "", ""
    if "runtime.cli.commands" not in sys.modules:
        if sys.stderr.isatty():
            begin, end = "loading ...", "\r\x1b[2K"
        elif not Path(
            importlib.util.cache_from_source(str(Path(__file__).with_name("commands.py")))
        ).exists():
            begin = "loading for the first time: up to half a minute\n"
    print(begin, end="", file=sys.stderr, flush=True)
    yield
    print(end, end="", file=sys.stderr, flush=True)


def _view_commands() -> Any:
    """The module `runtime.cli.view_commands`, as `_commands`."""
    _commands()
    from runtime.cli import view_commands

    return view_commands


def _finish(result: Any, as_json: bool) -> None:
    """Print a command's result and exit with 0 if it held, else 1."""
    if as_json:
        print(json.dumps(result.values, indent=1))
    else:
        result.show()
    if not result.held:
        raise typer.Exit(1)


def _refuse(message: str) -> int:
    print(f"surefoot: {' '.join(message.split())}", file=sys.stderr)
    return 2


def main(arguments: list[str] | None = None) -> None:
    """Run the command line. Exits with 0, 1 or 2; 130 when interrupted."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    _inputs.clear()
    with _after:
        code = _exit_code(arguments)
    if code == _INTERRUPTED:  # typer turns Ctrl-C into an exit of its own
        print("surefoot: interrupted; no half-written files are left", file=sys.stderr)
    sys.exit(code)


def _exit_code(arguments: list[str] | None) -> int:
    try:
        command: Callable[..., Any] = typer.main.get_command(app)
        code = command(arguments, prog_name="surefoot", standalone_mode=False) or 0
    except (KeyboardInterrupt, typer.Abort):
        code = _INTERRUPTED
    except typer.Exit as leave:
        code = leave.exit_code
    except typer_exceptions.TyperException as error:
        code = _refuse(f"{error.format_message()} (see surefoot --help)")
    except SurefootError as error:
        code = _refuse(str(error))
    except OSError as error:
        code = _refuse(f"{error.filename}: {error.strerror}" if error.filename else str(error))
    return code
