"""Running a playtest: the level read, its faults proved, the bots sent through it, the report made."""

import hashlib
import json
import math
import os
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

import navmesh
from runtime.errors import RuntimeInputError
from runtime.playtest.analysis import analyse
from runtime.playtest.bots import BotRun, Goals, run_bot
from runtime.playtest.character import Character, character_of
from runtime.playtest.expectations import broken_expectations
from runtime.playtest.fault import numbered
from runtime.playtest.goals import make_goals, patches_of, place_parts, spawn_parts
from runtime.playtest.holes import find_holes
from runtime.playtest.kept_runs import KeptRuns
from runtime.playtest.observation import crossings, journeys, observed, with_sightings
from runtime.playtest.plan import LoadedPlan, plan_path
from runtime.playtest.report import Chunks, Report, Setup
from runtime.playtest.site import Site
from runtime.playtest.tally import Tally
from surefoot.progress import Progress
from surefoot.workers.cluster import checked_address
from surefoot.workers.pool import Place, worker_pool
from surefoot.workers.versions import own_versions

__all__ = ["BODY", "MOST_BOTS", "Outcome", "Stage", "open_stage", "playtest"]

BODY = "walker"
"""Who plays unless something else is said."""
MOST_BOTS = 100_000


@dataclass(frozen=True)
class Stage:
    """A level that is ready to be played: the site, the plan, where bots go, and what was asked for."""

    setup: Setup
    site: Site
    plan: LoadedPlan
    goals: Goals


@dataclass(frozen=True)
class Outcome:
    """A report, with what it does not say because it must not differ from run to run: the ``tally`` of
    the bots, the ``wall`` time [s] that they took together, and where their runs are ``kept``."""

    report: Report
    tally: Tally
    stage: Stage
    wall: float
    kept: KeptRuns | None = None


def playtest(
    level: str | os.PathLike[str],
    *,
    bots: int = 16,
    seconds: float = 60.0,
    seed: int = 0,
    body: str = BODY,
    plan: str | os.PathLike[str] | None = None,
    up: str | None = None,
    scale: float | None = None,
    processes: int = 1,
    cluster: str | None = None,
    checkpoint: Path | None = None,
    progress: Progress | None = None,
) -> Outcome:
    """Playtest ``level`` (a mesh file, or the folder of an open world) with ``bots`` bots of ``body`` for
    ``seconds`` [s] each.

    ``plan`` is the playtest file; by default LEVEL.playtest.yaml where there is one. ``up`` and ``scale`` as
    for `navmesh.Terrain.load`. Bots run in ``processes`` of this machine, or on the ``cluster`` with that
    address (`surefoot.workers.cluster`); the report is the same wherever they run. Finished runs are kept in
    the folder ``checkpoint`` until its `KeptRuns.forget`; the same playtest with the same folder goes on from
    them. Raises `RuntimeInputError`, `navmesh.NavmeshError`, its `FileError` and
    `surefoot.workers.cluster.ClusterError` for wrong input.
    """
    if not 0 <= bots <= MOST_BOTS:
        raise RuntimeInputError(f"bots = {bots}: expected 0 to {MOST_BOTS}")
    if not (math.isfinite(seconds) and 0.0 < seconds <= 86400.0):
        raise RuntimeInputError(f"seconds = {seconds!r}: expected more than 0 and at most a day (86400)")
    if seed < 0:
        raise RuntimeInputError(f"seed = {seed}: expected 0 or more")
    if processes < 1:
        raise RuntimeInputError(f"processes = {processes}: expected 1 or more")
    place = processes if cluster is None else checked_address(cluster)
    progress = progress or Progress(shown=False)
    beside = plan_path(level)
    plan = plan or (beside if beside.is_file() else None)
    setup = Setup(str(level), up, scale, None if plan is None else str(plan), body, bots, seconds, seed)
    with progress.stage(f"reading {Path(level).name} and building its graph"):
        stage = open_stage(setup)
    site = stage.site
    with progress.stage("looking for faults in its geometry"):
        starts = spawn_parts(site, stage.plan)
        at = place_parts(site, stage.plan, "places")
        meant = np.array([each.reachable for each in stage.plan.plan.places], dtype=bool)
        reached = site.reached(starts)
        holes = find_holes(site, reached)
        proved = analyse(site, holes, starts, at[~meant], at[meant])
        proved += broken_expectations(site, stage.plan, starts, at)
    # the processes that play load the graph, and kept runs are known by it
    packed = b"" if place == 1 and checkpoint is None else _packed(site.graph)
    kept = None if checkpoint is None else KeptRuns(checkpoint, _identity(stage, packed))
    patches, _ = patches_of(site, reached)
    tally = Tally(patches, site.open_world)
    begun = time.perf_counter()
    with progress.stage(f"{bots} bots play") as bar:
        for done, run in enumerate(_all_runs(stage, packed, place, kept), start=1):
            tally.add(run)
            pace = tally.seconds / max(time.perf_counter() - begun, 1e-9)
            bar.update(done / bots, f"{done} done, {pace:.0f} x real time")
    wall = time.perf_counter() - begun
    ways, trips = crossings(site, tally, stage.goals.obstacles), journeys(tally.visits)
    faults = numbered(with_sightings(proved, observed(site, tally, ways, trips), holes))
    report = Report(
        setup=setup,
        digest=site.graph.terrain.digest,
        character=site.character.to_dict(),
        faults=tuple(faults),
        crossings=tuple(ways),
        journeys=tuple(trips),
        coverage=tally.coverage.curve(seconds),
        patches=tally.coverage.visits(),
        reachable=round(float(site.areas[reached].sum()), 2),
        chunks=_chunks(site, tally),
    )
    return Outcome(report, tally, stage, wall, kept)


def open_stage(setup: Setup) -> Stage:
    """The stage of ``setup``."""
    plan = LoadedPlan.read(setup.plan)
    character = plan.character(character_of(setup.body))
    site = _open_site(setup, plan, character) if Path(setup.level).is_dir() else _site(setup, character)
    return Stage(setup, site, plan, make_goals(site, plan, np.random.default_rng(setup.seed)))


def _site(setup: Setup, character: Character) -> Site:
    terrain = navmesh.Terrain.load(setup.level, up=setup.up, scale=setup.scale)
    beside = navmesh.tags_path(setup.level)
    # tags are of obstacles; what a body without skills steps over may be none
    tags = navmesh.load_tags(beside) if character.skills and beside.is_file() else None
    graph = navmesh.NodeGraph.build(terrain, character.rules, character.obstacle_rules(), tags=tags)
    return Site(graph, character)


def _open_site(setup: Setup, plan: LoadedPlan, character: Character) -> Site:
    """The site of an open world, of which everything is loaded to prove faults and to choose goals."""
    for name in ("up", "scale"):
        if getattr(setup, name) is not None:
            raise RuntimeInputError(f"{setup.level}: an open world is as it was baked; leave out {name}")
    for name in ("height", "max_step", "max_slope_deg"):
        if getattr(plan.plan.character, name) is not None:
            problem = f"character.{name}: an open world has the rules that it was baked with; leave this out"
            raise plan.error(("character", name), problem)
    world = navmesh.OpenWorld(setup.level, plan.plan.radius)
    everything = copy(world)
    everything.change(everything.chunks)
    graph = everything.graph
    if graph is None:
        raise RuntimeInputError(f"{setup.level}: nothing there can be walked on")
    if character.radius > world.radii[-1]:
        raise RuntimeInputError(
            f"{setup.level}: a {character.noun} has a radius of {character.radius:g} m; the open world was "
            f"baked for bodies of up to {world.radii[-1]:g} m"
        )
    return Site(graph, replace(character, rules=graph.rules), world)


def _chunks(site: Site, tally: Tally) -> Chunks | None:
    if site.open_world is None:
        return None
    names = site.open_world.chunks
    return Chunks(len(names), tuple(name for name in names if name not in tally.loaded))


def _identity(stage: Stage, graph: bytes) -> str:
    """Of all that decides a bot's run, as a name for a folder. ``graph``: its file."""
    setup = {key: value for key, value in asdict(stage.setup).items() if key != "bots"}
    digest = hashlib.sha256(graph).hexdigest()
    told = [setup, digest, stage.site.character.to_dict(), stage.plan.plan.model_dump(), own_versions()]
    return hashlib.sha256(json.dumps(told, sort_keys=True, default=str).encode()).hexdigest()[:16]


def _packed(graph: navmesh.NodeGraph) -> bytes:
    """The graph's file."""
    with tempfile.TemporaryDirectory(prefix="surefoot-") as folder:
        file = Path(folder) / "graph.npz"
        graph.save(file)
        return file.read_bytes()


def _all_runs(stage: Stage, graph: bytes, place: Place, kept: KeptRuns | None) -> Iterator[BotRun]:
    """The runs in the order of the bots' numbers, those that are ``kept`` already as they were."""
    numbers = range(stage.setup.bots)
    if kept is None:
        with _runs(stage, graph, place, numbers) as fresh:
            yield from fresh
        return
    known = {number for number in numbers if kept.read(number) is not None}  # read again when it is its turn
    with _runs(stage, graph, place, [number for number in numbers if number not in known]) as fresh:
        for number in numbers:
            if number not in known:
                kept.keep(next(fresh))
            run = kept.read(number)
            if run is None:
                raise RuntimeInputError(
                    f"the run of bot {number} has been removed from its checkpoint; run it again"
                )
            yield run


@contextmanager
def _runs(stage: Stage, graph: bytes, place: Place, numbers: Sequence[int]) -> Iterator[Iterator[BotRun]]:
    """The runs of the bots ``numbers``, by whoever works at ``place``; they load the ``graph``."""
    site, goals, setup = stage.site, stage.goals, stage.setup
    if place == 1 or not numbers:
        yield (run_bot(site, goals, setup.seed, number, setup.seconds) for number in numbers)
        return
    most = place if isinstance(place, str) else min(place, len(numbers))
    common = (graph, site.character, site.open_world, goals, setup.seed, setup.seconds)
    with worker_pool(most, _begin, common) as pool:
        yield pool.imap(_run_one, numbers)


_player: tuple[Site, Goals, int, float] | None = None  # of a worker process


def _begin(
    graph: bytes,
    character: Character,
    open_world: navmesh.OpenWorld | None,
    goals: Goals,
    seed: int,
    seconds: float,
) -> None:
    global _player
    with tempfile.TemporaryDirectory(prefix="surefoot-") as folder:
        file = Path(folder) / "graph.npz"
        file.write_bytes(graph)
        site = Site(navmesh.NodeGraph.load(file), character, open_world)
    _player = site, goals, seed, seconds


def _run_one(number: int) -> BotRun:
    assert _player is not None
    site, goals, seed, seconds = _player
    return run_bot(site, goals, seed, number, seconds)
