"""What was expected of the agents of a mission, and whether it held."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from runtime.events import Event, Fell, SkillFinished
from runtime.missions.director import Director, inside
from runtime.missions.mission import LoadedMission
from runtime.missions.model import AgentSpec
from runtime.world.world import World

__all__ = ["Check", "Watch", "checks"]


@dataclass(frozen=True)
class Check:
    """One expectation: of which agent, what, whether it held, and what was found."""

    agent: str
    expected: str
    held: bool
    found: str


class Watch:
    """Where the agents are over time: what distances and regions are judged by."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._times: list[float] = []
        self._places: dict[str, list[np.ndarray]] = {name: [] for name in world.agents}

    def sample(self) -> None:
        """Keep where everybody is now."""
        self._times.append(self._world.time)
        for name, places in self._places.items():
            places.append(np.array(self._world.agents[name].position))

    @property
    def times(self) -> np.ndarray:
        """(t,) float64 [s]."""
        return np.array(self._times)

    def places(self, agent: str) -> np.ndarray:
        """(t, 3) float64 [m]."""
        return np.array(self._places[agent])


def checks(loaded: LoadedMission, director: Director, watch: Watch, events: list[Event]) -> tuple[Check, ...]:
    """Every expectation of the mission, and that every agent whose script has an end got there."""
    return tuple(
        Check(spec.name, *found)
        for spec in loaded.mission.agents
        for found in _checks(loaded, spec, director, watch, [e for e in events if e.agent == spec.name])
    )


Found = tuple[str, bool, str]
"""What was expected, whether it held, what was found."""


def _checks(
    loaded: LoadedMission, spec: AgentSpec, director: Director, watch: Watch, events: list[Event]
) -> Iterator[Found]:
    expect = spec.expect
    performer = director.performers[spec.name]
    if expect.arrives_within is not None or not (performer.endless or performer.state == "idle"):
        yield _arrival(performer.finished, expect.arrives_within)
    if expect.never_falls is not None:
        fall = next((event for event in events if isinstance(event, Fell)), None)
        found = f"falls after {fall.time:.1f} s" if fall else "never falls"
        yield ("never falls" if expect.never_falls else "falls"), expect.never_falls != bool(fall), found
    used = [event.skill for event in events if isinstance(event, SkillFinished)]
    for skill in expect.uses_skills or ():
        yield f"uses skill {skill}", skill in used, _times(used.count(skill))
    places = watch.places(spec.name)
    for name in expect.stays_out_of or ():
        within = np.array([inside(loaded.mission.regions[name], place) for place in places])
        first = watch.times[int(np.argmax(within))]
        found = f"enters after {first:.1f} s" if within.any() else "stays out"
        yield f"stays out of {name}", not within.any(), found
    for each in expect.keeps_distance or ():
        late = watch.times >= each.after - 1e-9
        apart = np.linalg.norm(places - watch.places(each.to), axis=1)[late]
        yield _distance(each.to, each.at_least, each.at_most, apart)


def _times(count: int) -> str:
    return {0: "does not use it", 1: "uses it once"}.get(count, f"uses it {count} times")


def _arrival(finished: float | None, limit: float | None) -> Found:
    expected = "arrives" if limit is None else f"arrives within {limit:g} s"
    if finished is None:
        return expected, False, "does not arrive"
    return expected, limit is None or finished <= limit + 1e-9, f"arrives after {finished:.1f} s"


def _distance(other: str, least: float | None, most: float | None, apart: np.ndarray) -> Found:
    bounds = [f"{word} {value:g} m" for word, value in (("at least", least), ("at most", most)) if value]
    expected = f"keeps {' and '.join(bounds)} to {other}"
    if len(apart) == 0:
        return expected, False, "the mission was over before"
    near, far = float(apart.min()), float(apart.max())
    held = (least is None or near >= least) and (most is None or far <= most)
    return expected, held, f"{near:.2f} to {far:.2f} m"
