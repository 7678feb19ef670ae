"""Running a mission as fast as the machine can, and saying what happened."""

import time
from collections.abc import Callable
from dataclasses import asdict, dataclass

from runtime.events import Event
from runtime.missions.check import Prepared, prepare_mission
from runtime.missions.director import Director
from runtime.missions.expectations import Check, Watch, checks
from runtime.missions.mission import LoadedMission
from runtime.traces.recording import Recorder
from runtime.traces.trace import Trace
from runtime.world.world import World
from surefoot.progress import Progress

__all__ = ["MissionResult", "run_mission"]

SAMPLE = 0.03
"""[s] between recorded poses."""
AFTERMATH = 1.0
"""[s] that a mission runs on after its last agent has come to an end."""


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


def run_mission(
    loaded: LoadedMission,
    progress: Progress | None = None,
    prepared: Prepared | None = None,
    watch: Callable[[World], object] = lambda world: None,
) -> MissionResult:
    """Run the mission to its end: nobody has anything left to do, or the time limit is over.

    ``prepared`` is what `prepare_mission` made of it, and is used up; by default it is made here. ``watch``
    is called with the world at the beginning and after every step. Raises `FileError` as
    `prepare_mission` does.
    """
    progress = progress or Progress(shown=False)
    world, clearings = prepared or prepare_mission(loaded, progress)
    recorder, noted = Recorder(world), Watch(world)
    director = Director(loaded, world, clearings)
    begun = time.perf_counter()
    with progress.stage("running") as stage:
        director.begin()
        recorder.sample()
        noted.sample()
        watch(world)
        limit = ends = loaded.mission.time_limit
        while world.time < ends - 1e-9:
            world.step(SAMPLE)
            director.go_on(recorder.sample())
            noted.sample()
            watch(world)
            if not director.over:
                ends = limit
            elif ends == limit:
                ends = min(limit, world.time + AFTERMATH)
            stage.update(max(director.share, world.time / limit), f"{world.time:.1f} s simulated")
    wall = time.perf_counter() - begun
    found = checks(loaded, director, noted, recorder.events)
    report = {
        "mission": loaded.path.name,
        "held": all(check.held for check in found),
        "simulated": round(world.time, 3),
        "state_hash": world.state_hash(),
        "agents": [{"name": name, "status": agent.status} for name, agent in world.agents.items()],
        "checks": [asdict(check) for check in found],
    }
    return MissionResult(found, tuple(recorder.events), recorder.trace(report), world.time, wall)
