"""Running a mission as fast as the machine can, and saying what happened."""

import math
import time
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import navmesh
from navmesh.yamlfile import FileError
from runtime.agent import Agent
from runtime.events import Arrived, Event, Fell, SkillFinished
from runtime.mission import AgentSpec, LoadedMission
from runtime.planning import NoWay
from runtime.progress import Progress
from runtime.recording import Recorder
from runtime.trace import Trace
from runtime.world import World

__all__ = ["Check", "MissionResult", "prepare_mission", "run_mission"]

SAMPLE = 0.03
"""[s] between recorded poses."""
AFTERMATH = 1.0
"""[s] that a mission runs on after its last agent has come to an end."""


@dataclass(frozen=True)
class Check:
    """One expectation: of which agent, what, whether it held, and what was found."""

    agent: str
    expected: str
    held: bool
    found: str


@dataclass(frozen=True)
class MissionResult:
    """How a mission went. ``held``: whether every expectation did, and every agent arrived that has none."""

    checks: tuple[Check, ...]
    events: tuple[Event, ...]
    trace: Trace
    simulated: float
    """[s] of simulated time."""
    wall: float
    """[s] that the simulation took."""

    @property
    def held(self) -> bool:
        return all(check.held for check in self.checks)


def prepare_mission(loaded: LoadedMission, progress: Progress) -> World:
    """The mission's world: level read, graph built, agents at their starts, every waypoint reachable.

    Raises `navmesh.yamlfile.FileError` that names line and column for a level that is no mesh, a start off
    the walkable surface, and a waypoint that cannot be reached.
    """
    mission = loaded.mission
    with progress.stage(f"reading {loaded.level_path.name} and building its graph"):
        rules, tags = loaded.rules(), _tags(loaded)
        try:
            terrain = navmesh.Terrain.load(loaded.level_path, up=mission.level.up, scale=mission.level.scale)
            graph = navmesh.NodeGraph.build(terrain, rules, tags=tags)
        except FileError:
            raise
        except navmesh.NavmeshError as error:
            raise loaded.error(("level", "file"), f"level.file: {error}") from None
    world = World(graph, seed=mission.seed)
    with progress.stage("placing the agents and checking their ways"):
        for index, spec in enumerate(mission.agents):
            _place(loaded, world, index, spec)
    return world


def _tags(loaded: LoadedMission) -> Any:
    beside = navmesh.tags_path(loaded.level_path)
    path = loaded.tags_path or (beside if beside.is_file() else None)
    return None if path is None else navmesh.load_tags(path)


def _place(loaded: LoadedMission, world: World, index: int, spec: AgentSpec) -> None:
    try:
        agent = world.spawn(spec.body, spec.start, math.radians(spec.facing_deg), spec.name)
    except ValueError as error:
        problem = f"agents[{index}].start: {error}"
        raise loaded.error(("agents", index, "start"), problem) from None
    try:
        agent.plan(np.array(_goals(spec)))
    except NoWay as error:
        address = ("agents", index, "goto", error.goal)
        problem = (
            f"agents[{index}].goto[{error.goal}]: {spec.goto[error.goal]} cannot be reached: {error.reason}"
        )
        raise loaded.error(address, problem) from None


def run_mission(loaded: LoadedMission, progress: Progress | None = None) -> MissionResult:
    """Run the mission to its end: all agents have arrived or given up, or the time limit is over."""
    progress = progress or Progress(shown=False)
    world = prepare_mission(loaded, progress)
    mission = loaded.mission
    agents = [(spec, world.agents[spec.name]) for spec in mission.agents]
    recorder = Recorder(world)
    begun = time.perf_counter()
    with progress.stage("running") as stage:
        for spec, agent in agents:
            agent.go_to(np.array(_goals(spec)), spec.speed)
        recorder.sample()
        ends = mission.time_limit
        while world.time < ends - 1e-9:
            world.step(SAMPLE)
            recorder.sample()
            if ends == mission.time_limit and not any(agent.moving for _, agent in agents):
                ends = min(ends, world.time + AFTERMATH)
            stage.update(max(_headway(agent) for _, agent in agents), f"{world.time:.1f} s simulated")
    wall = time.perf_counter() - begun
    checks = tuple(check for spec, _ in agents for check in _checks(spec, recorder.events))
    report = _report(loaded.path, world, agents, checks)
    return MissionResult(checks, tuple(recorder.events), recorder.trace(report), world.time, wall)


def _goals(spec: AgentSpec) -> list[np.ndarray]:
    return [np.array(point, dtype=np.float64) for point in spec.goto]


def _headway(agent: Agent) -> float:
    return agent.progress


def _checks(spec: AgentSpec, events: Iterable[Event]) -> Iterable[Check]:
    own = [event for event in events if event.agent == spec.name]
    arrivals = [event.time for event in own if isinstance(event, Arrived)]
    falls = [event for event in own if isinstance(event, Fell)]
    expect = spec.expect
    limit = expect.arrives_within
    arrived = f"arrives after {arrivals[-1]:.1f} s" if arrivals else "does not arrive"
    expected = "arrives" if limit is None else f"arrives within {limit:g} s"
    yield Check(spec.name, expected, bool(arrivals) and (limit is None or arrivals[-1] <= limit), arrived)
    if expect.never_falls is not None:
        found = f"falls after {falls[0].time:.1f} s" if falls else "never falls"
        yield Check(
            spec.name,
            "never falls" if expect.never_falls else "falls",
            expect.never_falls != bool(falls),
            found,
        )
    used = [event.skill for event in own if isinstance(event, SkillFinished)]
    for skill in expect.uses_skills or []:
        times = used.count(skill)
        yield Check(spec.name, f"uses skill {skill}", times > 0, f"uses it {times} times")


def _report(
    path: Path, world: World, agents: list[tuple[AgentSpec, Agent]], checks: tuple[Check, ...]
) -> dict[str, Any]:
    return {
        "mission": path.name,
        "held": all(check.held for check in checks),
        "simulated": round(world.time, 3),
        "state_hash": world.state_hash(),
        "agents": [{"name": spec.name, "status": agent.status} for spec, agent in agents],
        "checks": [asdict(check) for check in checks],
    }
