"""Checking a mission against its level without running it: agents stand, places can be reached."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

import navmesh
from locomotion import LocomotionError, load_run_skill
from locomotion.skills.library import described_ranges
from runtime.bodies.registry import kind_of
from runtime.errors import RuntimeInputError
from runtime.missions.actions import first_far
from runtime.missions.clearing import find_clearing
from runtime.missions.mission import Address, LoadedMission, places_in, steps_of
from runtime.missions.model import AgentSpec, Step, ViewerSpec
from runtime.missions.places import what_is_wrong
from runtime.planning.planning import NotLoaded, NoWay
from runtime.planning.rules import obstacle_rules
from runtime.world.agent import Agent
from runtime.world.level_of_detail import Viewer, checked_detail
from runtime.world.world import World
from surefoot.errors import SurefootError
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress

__all__ = ["Prepared", "build_graph", "prepare_mission"]


class Prepared(NamedTuple):
    """A mission that can be run."""

    world: World
    """With the agents at their starts."""
    clearings: dict[Address, np.ndarray]
    """For every `use` step, by its address, the run-up and the place beyond, (2, 3) [m]."""


def prepare_mission(
    loaded: LoadedMission, progress: Progress, graph: navmesh.NodeGraph | None = None
) -> Prepared:
    """Make the mission's world: level read, graph built (unless it is given), or of an open world what is
    around its players loaded; all places reachable.

    Raises `FileError` that names line and column for a level that cannot be read, a start off
    the walkable surface, a place that cannot be reached from the agent's start, and a skill or an obstacle
    that is not there.
    """
    _check_ends(loaded)
    if loaded.open_world:
        with progress.stage(f"loading what is around the players of {loaded.level_path.name}"):
            level = _load_world(loaded)
    elif graph is None:
        with progress.stage(f"reading {loaded.level_path.name} and building its graph"):
            level = build_graph(loaded)
    else:
        level = graph
    if isinstance(level, navmesh.NodeGraph):
        _check_starts(loaded, level)
    try:
        world = World(level, loaded.mission.seed, loaded.skill_paths)
    except RuntimeInputError as error:
        raise loaded.error(("skills",), str(error)) from None
    world.viewers = [_viewer(each) for each in loaded.mission.viewers]
    prepared = Prepared(world, {})
    with progress.stage("placing the agents and checking their ways"):
        for index, spec in enumerate(loaded.mission.agents):
            _place(loaded, world, index, spec)
        if loaded.open_world:
            world.players = [world.agents[each] if isinstance(each, str) else each for each in loaded.players]
        for _, name, steps in steps_of(loaded.mission):
            agent = world.agents[name]
            for chain in _chains(loaded, prepared, agent, steps):
                _check_ways(loaded, agent, chain)
    return prepared


def build_graph(loaded: LoadedMission) -> navmesh.NodeGraph:
    """The graph of the mission's level; raises `FileError`."""
    level = loaded.mission.level
    rules, beside = loaded.rules(), navmesh.tags_path(loaded.level_path)
    tags_path = loaded.tags_path or (beside if beside.is_file() else None)
    try:
        tags = None if tags_path is None else navmesh.load_tags(tags_path)
        terrain = navmesh.Terrain.load(loaded.level_path, up=level.up, scale=level.scale)
        own = described_ranges(load_run_skill(), loaded.skill_paths)
        return navmesh.NodeGraph.build(terrain, rules, obstacle_rules(own), tags=tags)
    except LocomotionError as error:
        raise loaded.error(("skills",), str(error)) from None
    except FileError:
        raise
    except SurefootError as error:
        raise loaded.error(("level", "file"), str(error)) from None


def _load_world(loaded: LoadedMission) -> navmesh.OpenWorld:
    """The open world of the mission, with what is around its players and the starts loaded."""
    try:
        world = navmesh.OpenWorld(loaded.level_path, loaded.mission.level.radius)
        _check_starts(loaded, world)
        starts = {agent.name: loaded.point(agent.start) for agent in loaded.mission.agents}
        around = [starts[each] if isinstance(each, str) else each for each in loaded.players]
        world.change(world.next_changes(around, len(world.chunks), needed=list(starts.values())))
    except FileError:
        raise
    except SurefootError as error:
        raise loaded.error(("level", "file"), str(error)) from None
    return world


def _check_starts(loaded: LoadedMission, level: navmesh.NodeGraph | navmesh.OpenWorld) -> None:
    for index, (spec, body) in enumerate(zip(loaded.mission.agents, loaded.bodies, strict=True)):
        point, radius = loaded.point(spec.start), kind_of(body).radius(body)
        try:
            wrong = what_is_wrong(level, point, radius, Path(body).stem)
        except navmesh.NavmeshError as error:
            raise loaded.error(("agents", index, "body"), str(error)) from None
        if wrong is not None:
            raise loaded.error(("agents", index, "start"), wrong)


def _viewer(spec: ViewerSpec) -> Viewer:
    (x, y, z), (a, b, c) = spec.position, spec.direction
    return Viewer((x, y, z), (a, b, c), math.radians(spec.field_of_view_deg))


def _place(loaded: LoadedMission, world: World, index: int, spec: AgentSpec) -> None:
    point, body = loaded.point(spec.start), loaded.bodies[index]
    try:
        checked_detail(spec.detail, kind_of(body).levels, Path(body).stem)
    except ValueError as error:
        raise loaded.error(("agents", index, "detail"), str(error)) from None
    try:
        agent = world.spawn(body, point, math.radians(spec.facing_deg), spec.name, detail=spec.detail)
    except ValueError as error:
        raise loaded.error(("agents", index, "start"), str(error)) from None
    if spec.style is not None:
        try:
            agent.set_style(**spec.style.traits)
        except ValueError as error:
            raise loaded.error(("agents", index, "style"), str(error)) from None


Chain = list[tuple[Address, np.ndarray]]
"""Places (3,) [m] that are visited one after the other, with their addresses."""


def _chains(
    loaded: LoadedMission, prepared: Prepared, agent: Agent, steps: list[tuple[Address, Step]]
) -> Iterator[Chain]:
    """The places of a script, broken where it is not known where the agent will be."""
    chain: Chain = []
    for address, step in steps:
        for what in ("posture", "hold"):
            if getattr(step, what) is not None and not agent.has_levels:
                raise loaded.error((*address, what), f"a {Path(agent.body).stem} has no postures")
        if step.use is not None:
            here = (*address, "use")
            clearing = prepared.clearings[address] = find_clearing(
                loaded, prepared.world, agent, here, step.use
            )
            chain += [(here, point) for point in clearing]
            continue
        if step.follow is not None:
            yield chain
            chain = []
        for below, place in places_in(step):
            here, point = (*address, *below), loaded.point(place)
            level = prepared.world.open_world or prepared.world.graph
            wrong = what_is_wrong(level, point, agent.radius, Path(agent.body).stem)
            if wrong is not None:
                raise loaded.error(here, wrong)
            chain.append((here, point))
    yield chain


def _check_ways(loaded: LoadedMission, agent: Agent, chain: Chain) -> None:
    left = chain[first_far(agent.position, [point for _, point in chain]) :]
    if not left:
        return
    try:
        agent.plan(np.array([point for _, point in left]))
    except NotLoaded:
        pass
    except NoWay as error:
        address, point = left[error.goal]
        raise loaded.error(address, f"{point.tolist()} cannot be reached: {error.reason}") from None


def _check_ends(loaded: LoadedMission) -> None:
    """Nothing comes after what never ends, and nobody is expected to arrive who has no end."""
    told = {order.agent for trigger in loaded.mission.triggers for order in trigger.then}
    for address, name, steps in steps_of(loaded.mission):
        endless = [here for here, step in steps if _is_endless(step)]
        if endless and endless[0] != steps[-1][0]:
            raise loaded.error(
                endless[0], "this never ends, and more comes after it; give it seconds or rounds"
            )
        if endless and address[0] == "agents" and name not in told:
            expect = loaded.mission.agents[int(address[1])].expect
            if expect.arrives_within is not None:
                where = (*address, "expect", "arrives_within")
                raise loaded.error(
                    where, f"{name!r} never ends what it does; give its last step seconds or rounds"
                )


def _is_endless(step: Step) -> bool:
    if step.patrol is not None:
        return step.patrol.rounds is None and step.patrol.seconds is None
    return step.follow is not None and step.follow.seconds is None
