"""Playing a posture graph: from where a figure is to the posture it is asked for, by elapsed time.

What a figure does is a value; nothing is counted in frames. So the pose at a time is the same to the bit,
however often it was asked for before.
"""

from dataclasses import dataclass, replace

import numpy as np

from locomotion.errors import LocomotionError
from locomotion.postures.places import beyond, place_of, placed
from locomotion.postures.posture_graph import PostureGraph, blended, frame_at

__all__ = ["Playback", "asked_for", "at_rest", "pose_at", "settled"]


@dataclass(frozen=True, eq=False)
class Playback:
    """What a figure does.

    Attributes:
        posture: where it is, or where the arc that it is on ends. target: the posture it was asked for.
        place: (3,) float64, x, y [m] and turn [rad] of where it is, or where the arc began.
        arc: the arc it is on, -1 at rest. begun: when that began [s].
        last: (46,) float64, the pose from which it goes straight to the fatal posture, else None.
    """

    posture: int
    target: int
    place: np.ndarray
    arc: int = -1
    begun: float = 0.0
    last: np.ndarray | None = None


def at_rest(graph: PostureGraph, posture: str, place: tuple[float, float, float]) -> Playback:
    """A figure in ``posture`` at ``place``: x, y [m], turn [rad]."""
    number = _number(graph, posture)
    return Playback(number, number, np.array(place, np.float64))


def settled(graph: PostureGraph, playback: Playback, now: float) -> Playback:
    """``playback`` with all arcs gone through that have ended by ``now`` [s]."""
    while True:
        if playback.last is not None:
            if now < playback.begun + graph.fatal_seconds:
                return playback
            return replace(playback, last=None)
        if playback.arc < 0:
            following = graph.next_arc[playback.posture, playback.target]
            if following < 0:
                return playback
            playback = replace(playback, arc=int(following), posture=int(graph.end[following]))
        end = playback.begun + float(graph.seconds[playback.arc])
        if now < end:
            return playback
        playback = replace(
            playback, arc=-1, begun=end, place=beyond(playback.place, graph.moves[playback.arc])
        )


def asked_for(graph: PostureGraph, playback: Playback, posture: str, now: float) -> Playback:
    """The figure is asked for ``posture`` at ``now`` [s].

    It goes on from the arc that it is on: to its end and from there the way of least time; or back, where
    the arc has an opposite and that is quicker. To the fatal posture it goes at once. Raises
    `LocomotionError` for an unknown posture and for one that cannot be reached; nothing has changed then.
    """
    target = _number(graph, posture)
    playback = settled(graph, playback, now)
    if target == playback.target:
        return playback
    if target == graph.fatal:
        pose = pose_at(graph, playback, now)
        return Playback(target, target, place_of(pose), -1, now, pose)
    if not np.isfinite(graph.least[playback.posture, target]):
        here = graph.postures[playback.posture]
        raise LocomotionError(f"{graph.name}: there is no way from {here!r} to {posture!r}")
    if playback.last is not None or playback.arc < 0:
        begun = playback.begun if playback.last is not None else now
        return settled(graph, replace(playback, target=target, begun=begun), now)
    arc, back = playback.arc, int(graph.opposite[playback.arc])
    elapsed = now - playback.begun
    left = float(graph.seconds[arc]) - elapsed
    behind = int(graph.start[arc])
    if back >= 0 and elapsed + graph.least[behind, target] < left + graph.least[playback.posture, target]:
        return Playback(behind, target, beyond(playback.place, graph.moves[playback.arc]), back, now - left)
    return replace(playback, target=target)


def pose_at(graph: PostureGraph, playback: Playback, now: float) -> np.ndarray:
    """The figure's pose (46,) at ``now`` [s], not before what it does began: ``qpos`` of the person."""
    playback = settled(graph, playback, now)
    if playback.last is not None:
        share = min(max((now - playback.begun) / graph.fatal_seconds, 0.0), 1.0)
        end = placed(graph.poses[graph.fatal], playback.place)
        return blended(playback.last, end, share * share * (3.0 - 2.0 * share))
    if playback.arc < 0:
        return placed(graph.poses[playback.posture], playback.place)
    return placed(frame_at(graph, playback.arc, now - playback.begun), playback.place)


def _number(graph: PostureGraph, posture: str) -> int:
    if posture not in graph.postures:
        raise LocomotionError(f"{graph.name}: posture {posture!r}: valid: {', '.join(graph.postures)}")
    return graph.postures.index(posture)
