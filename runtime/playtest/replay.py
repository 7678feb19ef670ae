"""Seeing a finding again: the bot that met it runs once more, or one goes there to show it."""

import numpy as np

from runtime.bodies.figure import Figure
from runtime.errors import RuntimeInputError
from runtime.playtest.bots import run_bot
from runtime.playtest.fault import Fault
from runtime.playtest.looks import POSED, capsule, figure_of, poses_along
from runtime.playtest.movers import CapsuleMover
from runtime.playtest.report import Report
from runtime.playtest.run import Stage, open_stage
from runtime.playtest.tally import sighted
from runtime.traces.recording import level_trace
from runtime.traces.trace import AgentTrace, PathTrace, Trace

__all__ = ["replay"]

_BEFORE = 8.0
"""[s] shown before a bot meets trouble."""


def replay(report: Report, number: int) -> Trace:
    """The run that shows finding ``number`` of ``report`` (from 1), for `runtime.views.view.write_page`.

    Raises `RuntimeInputError` for a number that the report does not have, or when the level is not the one
    that was played.
    """
    if not 1 <= number <= len(report.faults):
        raise RuntimeInputError(f"finding {number}: the report has 1 to {len(report.faults)}")
    fault = report.faults[number - 1]
    stage = open_stage(report.setup)
    if stage.site.graph.terrain.digest != report.digest:
        raise RuntimeInputError(
            f"{report.setup.level}: is not the level of the report any more; playtest it again"
        )
    if fault.sightings:
        track, poses = _met_again(stage, fault)
    else:
        track, poses = _shown(stage, fault), None
    if poses is None:
        return _trace(stage, fault, number, track, capsule(stage.site.character), poses_along(track))
    return _trace(stage, fault, number, track, figure_of(stage.site.character), poses)


def _met_again(stage: Stage, fault: Fault) -> tuple[np.ndarray, np.ndarray | None]:
    """The last seconds of the bot's track before it met ``fault``, and its poses."""
    first, setup = fault.sightings[0], stage.setup
    run = run_bot(stage.site, stage.goals, setup.seed, first.bot, setup.seconds)
    trouble = sighted(run, first)
    if trouble is None:
        raise RuntimeInputError("the bot does not do what the report says; was it made by another version?")
    track = run.track
    recent = (track[:, 0] > first.time - _BEFORE) & (track[:, 0] <= first.time + 0.01)
    return track[recent], trouble.poses


def _shown(stage: Stage, fault: Fault) -> np.ndarray:
    """A walk from the nearest spawn as far towards ``fault`` as there is a way."""
    site, goals = stage.site, stage.goals
    character = site.character
    place = np.array(fault.position)
    spawn = goals.spawns[np.argmin(np.linalg.norm(goals.spawns - place, axis=1))]
    patch = goals.targets[np.argmin(np.linalg.norm(goals.targets - place, axis=1))]
    route = site.graph.find_path(spawn, patch, radius=character.radius, skills=dict(character.skills))
    mover = CapsuleMover(site)
    mover.appear(route.waypoints[0] if len(route.waypoints) else spawn, 0.0)
    still = np.array([[0.0, *mover.place], [1.0, *mover.place]])
    if len(route.waypoints) < 2:
        return still
    return np.vstack([still[:1], mover.travel(route, 600.0).track])


def _trace(
    stage: Stage, fault: Fault, number: int, track: np.ndarray, figure: Figure, poses: np.ndarray
) -> Trace:
    times = POSED * np.arange(len(poses))
    event = {
        "kind": fault.kind,
        "time": float(times[-1]),
        "agent": "bot",
        "position": list(fault.position),
    }
    line = PathTrace(raw=track[:1, 1:], pulled=track[:1, 1:], smooth=track[:, 1:])
    return Trace(
        level=level_trace(stage.site.graph),
        times=times,
        agents=(AgentTrace("bot", figure, poses, (line,)),),
        events=(event,),
        state_hash="",
        report={"finding": number, "text": fault.text},
    )
