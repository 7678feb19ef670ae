"""Seeing a finding again: the bot that met it runs once more, or one goes there to show it."""

import numpy as np

from runtime.errors import RuntimeInputError
from runtime.playtest.bots import run_bot
from runtime.playtest.fault import Fault
from runtime.playtest.movers import WalkerMover
from runtime.playtest.pictures import capsule
from runtime.playtest.report import Report
from runtime.playtest.run import Stage, open_stage
from runtime.recording import level_trace
from runtime.trace import AgentTrace, PathTrace, Trace

__all__ = ["replay"]

_BEFORE = 8.0
"""[s] shown before a bot meets trouble."""
_FRAME = 0.05
"""[s] between the frames of a replay."""


def replay(report: Report, number: int) -> Trace:
    """The run that shows finding ``number`` of ``report`` (from 1), for `runtime.view.write_page`.

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
        track = _met_again(stage, fault)
    else:
        track = _shown(stage, fault)
    return _trace(stage, fault, number, track)


def _met_again(stage: Stage, fault: Fault) -> np.ndarray:
    """The last seconds of the bot's track before it met ``fault``."""
    first, setup = fault.sightings[0], stage.setup
    run = run_bot(stage.site, stage.goals, setup.seed, first.bot, setup.seconds)
    same = [each for each in run.troubles if round(each.time, 2) == first.time]
    if not same:
        raise RuntimeInputError("the bot does not do what the report says; was it made by another version?")
    track = run.track
    return track[(track[:, 0] > first.time - _BEFORE) & (track[:, 0] <= first.time + 0.01)]


def _shown(stage: Stage, fault: Fault) -> np.ndarray:
    """A walk from the nearest spawn as far towards ``fault`` as there is a way."""
    site, goals = stage.site, stage.goals
    character = site.character
    place = np.array(fault.position)
    spawn = goals.spawns[np.argmin(np.linalg.norm(goals.spawns - place, axis=1))]
    patch = goals.targets[np.argmin(np.linalg.norm(goals.targets - place, axis=1))]
    route = site.graph.find_path(spawn, patch, radius=character.radius, skills=dict(character.skills))
    mover = WalkerMover(site)
    mover.appear(route.waypoints[0] if len(route.waypoints) else spawn, 0.0)
    still = np.array([[0.0, *mover.place], [1.0, *mover.place]])
    if len(route.waypoints) < 2:
        return still
    return np.vstack([still[:1], mover.travel(route, 600.0).track])


def _trace(stage: Stage, fault: Fault, number: int, track: np.ndarray) -> Trace:
    times = np.arange(track[0, 0], track[-1, 0] + 1e-9, _FRAME)
    place = np.column_stack([np.interp(times, track[:, 0], track[:, k]) for k in (1, 2, 3)])
    ahead = np.gradient(place[:, :2], axis=0) if len(place) > 1 else np.zeros((len(place), 2))
    yaw = np.unwrap(np.arctan2(ahead[:, 1], ahead[:, 0]))
    poses = np.zeros((len(times), 1, 7), np.float32)
    poses[:, 0, :3] = place
    poses[:, 0, 3], poses[:, 0, 6] = np.cos(0.5 * yaw), np.sin(0.5 * yaw)
    event = {
        "kind": fault.kind,
        "time": float(times[-1] - times[0]),
        "agent": "bot",
        "position": list(fault.position),
    }
    line = PathTrace(raw=place[:1], pulled=place[:1], smooth=place)
    return Trace(
        level=level_trace(stage.site.graph),
        times=times - times[0],
        agents=(AgentTrace("bot", capsule(stage.site.character), poses, (line,)),),
        events=(event,),
        state_hash="",
        report={"finding": number, "text": fault.text},
    )
