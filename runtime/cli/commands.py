"""What the ``surefoot`` commands do once their arguments are parsed."""

import json
import signal
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import navmesh
from locomotion import smooth_route
from locomotion.skills.registry import skill_kind
from runtime.cli.dis_line import DisLine, RealTime
from runtime.errors import RuntimeInputError
from runtime.events import Departed, Event
from runtime.missions.check import prepare_mission
from runtime.missions.mission import load_mission, mission_schema
from runtime.missions.run import MissionResult, run_mission
from runtime.planning.rules import person_walk_rules
from runtime.traces.trace import Trace
from runtime.warmup import compile_kernels, is_compiled, load_kernels
from surefoot.files.archive import check_target
from surefoot.files.atomic_write import whole_file
from surefoot.files.outputs import check_output_folder
from surefoot.progress import Progress
from surefoot.words import several

__all__ = [
    "Address",
    "Result",
    "bake_level",
    "check_mission_file",
    "check_page",
    "check_picture",
    "find_path",
    "list_obstacles",
    "print_values",
    "ready",
    "run_mission_file",
    "serve_worlds",
    "show_mission",
    "write_schema",
]

_MEASURES = ("height", "depth", "width", "run_up", "landing")
_NO_FOLD = 400
"""[columns] in a pipe: rows stay on one line."""


@dataclass(frozen=True)
class Result:
    """Result of a command: ``values`` for programs, ``show`` to print for people, ``held`` for the exit
    code."""

    values: Mapping[str, Any]
    held: bool
    show: Callable[[], None]


def bake_level(
    level: Path,
    output: Path,
    up: str | None,
    scale: float | None,
    tags: Path | None,
    rules: Mapping[str, float | None],
    threads: int = 1,
) -> Result:
    """Build and save the graph of ``level``."""
    beside = navmesh.tags_path(level)
    authored = tags or (beside if beside.is_file() else None)
    loaded = None if authored is None else navmesh.load_tags(authored)
    check_target(output)
    progress = ready()
    walk_rules = person_walk_rules(**rules)
    with progress.stage(f"building the graph of {level.name}"):
        begun = time.perf_counter()
        terrain = navmesh.Terrain.load(level, up=up, scale=scale)
        check_target(output)  # files that the level refers to are inputs too
        graph = navmesh.NodeGraph.build(terrain, walk_rules, tags=loaded, threads=threads)
        seconds = time.perf_counter() - begun
        graph.save(output)
    values = {
        "level": str(level),
        "output": str(output),
        "size": (terrain.bounds[1] - terrain.bounds[0]).round(2).tolist(),
        "triangles": len(terrain.faces),
        "nodes": len(graph),
        "edges": len(graph.edge_target) // 2,
        "obstacles": {kind: int((graph.obstacles.affordance == kind).sum()) for kind in _kinds(graph)},
        "links": len(graph.links),
        "seconds": round(seconds, 3),
        "terrain_digest": terrain.digest,
    }
    return Result(values, True, lambda: print_values(values))


def list_obstacles(level: Path, up: str | None, scale: float | None) -> Result:
    """List what a skill can clear in a mesh or a baked graph."""
    found = _graph_of(level, up, scale, ready()).obstacles
    rows = [
        {
            "tag": str(found.tag[k]),
            "skill": skill_kind(str(found.affordance[k])).skill,
            "affordance": str(found.affordance[k]),
            "authored": bool(found.authored[k]),
            **{name: round(float(getattr(found, name)[k]), 3) for name in _MEASURES},
            "position": found.position[k].round(3).tolist(),
        }
        for k in range(len(found))
    ]

    def show() -> None:
        from rich.console import Console
        from rich.table import Table

        table = Table("tag", "skill", *(f"{name.replace('_', '-')} [m]" for name in _MEASURES), "place [m]")
        for row in rows:
            place = " ".join(f"{value:.1f}" for value in row["position"])
            table.add_row(row["tag"], row["skill"], *(f"{row[name]:.2f}" for name in _MEASURES), place)
        Console(highlight=False, markup=False, width=_NO_FOLD).print(table)

    return Result({"level": str(level), "obstacles": rows}, True, show)


def _graph_of(level: Path, up: str | None, scale: float | None, progress: Progress) -> navmesh.NodeGraph:
    """The baked graph in ``level``, or one built from the mesh there."""
    if level.suffix == ".npz":
        return navmesh.NodeGraph.load(level)
    with progress.stage(f"building the graph of {level.name}"):
        terrain = navmesh.Terrain.load(level, up=up, scale=scale)
        beside = navmesh.tags_path(level)
        tags = navmesh.load_tags(beside) if beside.is_file() else None
        return navmesh.NodeGraph.build(terrain, person_walk_rules(), tags=tags)


def find_path(
    graph_file: Path,
    start: tuple[float, float, float],
    goal: tuple[float, float, float],
    radius: float,
    jump: tuple[float, float],
    smooth: bool,
) -> Result:
    """Find a path on a baked graph; holds if the path is complete."""
    graph = navmesh.NodeGraph.load(graph_file)
    ready()
    route = graph.find_path(start, goal, radius=radius, skills={"jump": jump} if jump[1] > 0.0 else None)
    points = route.waypoints
    if smooth and len(points) > 1:
        points = smooth_route(route).points
    values = {
        "status": route.status,
        "length": round(route.length, 4),
        "links": [str(graph.obstacles.tag[use.obstacle]) for use in route.links],
        "points": [[round(value, 4) for value in point] for point in points.tolist()],
    }

    def show() -> None:
        over = f", {several(len(route.links), 'obstacle')} on the way" if route.links else ""
        print(f"{route.status}, {route.length:.2f} m, {several(len(points), 'point')}{over}")
        for x, y, z in points:
            print(f"{x:10.3f} {y:10.3f} {z:8.3f}")

    return Result(values, route.status == "complete", show)


def run_mission_file(mission: Path, out: Path | None, line: DisLine | None = None) -> Result:
    """Run a mission; write trace, plot, film strip and page to ``out`` if given. With a ``line`` to other
    simulators it is run in real time."""
    loaded = load_mission(mission)
    written = [] if out is None else check_output_folder(out, _RESULTS)
    progress = ready()
    if line is None:
        result = run_mission(loaded, progress)
    else:
        prepared = prepare_mission(loaded, progress)
        with RealTime(line.gateway(prepared.world)) as real_time:
            result = run_mission(loaded, progress, prepared, real_time.keep)
    _write_results(result.trace, written, progress)
    values = {
        **result.trace.report,
        "events": list(result.trace.events),
        "files": [str(each) for each in written],
    }
    return Result(values, result.held, lambda: show_mission(mission, result, written))


def check_mission_file(mission: Path) -> Result:
    """Check a mission and its level; raises `surefoot.files.yamlfile.FileError` that says what is wrong."""
    loaded = load_mission(mission)
    prepare_mission(loaded, ready())
    agents = [{"name": agent.name, "body": agent.body} for agent in loaded.mission.agents]
    values = {"mission": str(mission), "level": str(loaded.level_path), "agents": agents}
    return Result(values, True, lambda: print(f"{mission}: ready to run ({several(len(agents), 'agent')})"))


def write_schema(output: Path | None) -> None:
    """Write the JSON schema of missions to ``output``, or print it."""
    text = json.dumps(mission_schema(), indent=1) + "\n"
    if output is None:
        print(text, end="")
        return
    check_target(output)
    with whole_file(output) as temporary:
        temporary.write_text(text, encoding="utf-8")


class Address(NamedTuple):
    """Where a server listens, its token, and the folder of its pages."""

    host: str
    port: int
    token: str
    pages: Path | None


def serve_worlds(
    levels: list[Path],
    up: str | None,
    scale: float | None,
    radius: float,
    at: Address,
    line: DisLine | None = None,
) -> None:
    """Serve worlds on ``levels`` until interrupted: meshes, baked graphs, or open worlds, of which ``radius``
    [m] around players is loaded."""
    import asyncio

    try:
        from runtime.server.server import SurefootServer
    except ImportError as error:
        raise RuntimeInputError(f"{error}; in Surefoot's folder: pip install -e '.[serve]'") from None

    if at.pages is not None and not at.pages.is_dir():
        raise RuntimeInputError(f"{at.pages}: not a folder; --pages needs one")
    served: dict[str, navmesh.NodeGraph | navmesh.OpenWorld] = {}
    progress = ready()
    for level in levels:
        if level.stem in served:
            raise RuntimeInputError(f"{level}: two levels are called {level.stem!r}")
        served[level.stem] = (
            navmesh.OpenWorld(level, radius) if level.is_dir() else _graph_of(level, up, scale, progress)
        )
    load_kernels()
    gateway = None if line is None else line.gateway
    server = SurefootServer(served, *at, gateway=gateway)
    where = f"[{at.host}]" if ":" in at.host else at.host

    async def serve_until_ended() -> None:
        own = asyncio.current_task()
        assert own is not None
        with suppress(NotImplementedError):  # only on Unix
            asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, own.cancel)
        await server.run(lambda port: print(f"serving on ws://{where}:{port}", flush=True))

    try:
        asyncio.run(serve_until_ended())
    except asyncio.CancelledError:  # everything has been cleaned up
        raise SystemExit(128 + signal.SIGTERM) from None


_RESULTS = ("trace.npz", "level.png", "film.png", "run.html")


def _write_results(trace: Trace, files: Sequence[Path], progress: Progress) -> None:
    """Write the trace to ``files``, in the order of `_RESULTS`; does nothing if there are none."""
    from runtime.views.filmstrip import write_filmstrip
    from runtime.views.plot import plot_from_above
    from runtime.views.view import write_page

    if not files:
        return
    files[0].parent.mkdir(parents=True, exist_ok=True)
    trace.write(files[0])
    with progress.stage("drawing the level from above"):
        plot_from_above(trace, files[1])
    write_filmstrip(trace, files[2], progress)
    with progress.stage("writing the page"):
        write_page(trace, files[3])


def show_mission(mission: Path, result: MissionResult, written: list[Path]) -> None:
    """Print what happened in a mission and which expectations held."""
    from rich.console import Console
    from rich.table import Table

    console = Console(highlight=False)
    happened = Table("time", "what happened", title=mission.name, title_justify="left")
    for event, more in _in_short(result.events):
        again = f" (and replans {several(more, 'time')})" if more else ""
        happened.add_row(f"{event.time:6.2f} s", f"{event}{again}")
    console.print(happened)
    checks = Table("agent", "expected", "found", "held")
    for check in result.checks:
        verdict = "[green]yes[/]" if check.held else "[red]no[/]"
        checks.add_row(check.agent, check.expected, check.found, verdict)
    console.print(checks)
    pace = result.simulated / max(result.wall, 1e-9)
    console.print(f"{result.simulated:.1f} s simulated in {result.wall:.1f} s ({pace:.1f} x real time)")
    for path in written:
        console.print(f"wrote {path}", soft_wrap=True)


def _in_short(events: Sequence[Event]) -> list[tuple[Event, int]]:
    """The events, with only the first of several departures in a row, each with the number of that agent's
    departures left out."""
    shown: list[tuple[Event, int]] = []
    latest: dict[str, int] = {}
    for event in events:
        last = latest.get(event.agent)
        if last is not None and isinstance(event, Departed) and isinstance(shown[last][0], Departed):
            shown[last] = shown[last][0], shown[last][1] + 1
        else:
            latest[event.agent] = len(shown)
            shown.append((event, 0))
    return shown


def ready() -> Progress:
    """Progress display for a command; compiles the kernels first."""
    progress = Progress()
    if not is_compiled():
        compile_kernels(progress)
    return progress


def check_picture(picture: Path) -> None:
    """Raise `ArchiveError` or `RuntimeInputError` if ``picture`` cannot be a PNG file."""
    check_target(picture)
    if picture.suffix.lower() != ".png":
        raise RuntimeInputError(f"{picture}: pictures are written as .png; use that ending")


def check_page(page: Path) -> None:
    """Raise `ArchiveError` or `RuntimeInputError` if ``page`` cannot be an HTML file."""
    check_target(page)
    if page.suffix.lower() not in (".html", ".htm"):
        raise RuntimeInputError(f"{page}: pages are written as .html; use that ending")


def _kinds(graph: navmesh.NodeGraph) -> list[str]:
    return sorted({str(kind) for kind in graph.obstacles.affordance})


def print_values(values: Mapping[str, Any]) -> None:
    """Print one value a line, for people."""
    for name, value in values.items():
        print(f"{name:15} {value}")
