"""Postures and arcs of a posture graph as clips."""

import numpy as np

from locomotion.postures.posture_graph import PostureGraph
from locomotion.recorded.motion_set import Clip
from locomotion.recorded.takes.take import RATE, Take, spread

__all__ = ["arc_name", "posture_takes"]

_HOLDS = "/"  # in the name of a posture with an object
_HANDS = ("right_hand", "left_hand")


def arc_name(graph: PostureGraph, arc: int) -> str:
    """The name of the clip of an arc; one that is played backwards has that of its opposite."""
    ends = graph.start[arc], graph.end[arc]
    before, after = ends[::-1] if graph.backwards[arc] else ends
    return f"{graph.postures[before]} to {graph.postures[after]}"


def posture_takes(graph: PostureGraph, origin: str) -> list[Take]:
    """A clip for each posture, and one for each arc that is not played backwards."""
    takes = [
        Take(
            Clip(name=name, kind="posture", origin=origin, seconds=1.0),
            pose[None].copy(),
            np.zeros((1, 2), np.bool_),
            _HANDS if _HOLDS in name else (),
        )
        for name, pose in zip(graph.postures, graph.poses, strict=True)
    ]
    for arc in np.flatnonzero(~graph.backwards).tolist():
        seconds = float(graph.seconds[arc])
        frames = graph.frames[graph.first[arc] : graph.first[arc] + graph.count[arc]]
        shares = np.linspace(0.0, 1.0, max(round(seconds * RATE), 1) + 1)
        x, y, turn = (float(v) for v in graph.moves[arc])
        clip = Clip(
            name=arc_name(graph, arc), kind="arc", origin=origin, seconds=seconds, travel=(x, y, turn)
        )
        ends = graph.postures[graph.start[arc]], graph.postures[graph.end[arc]]
        held = _HANDS if all(_HOLDS in end for end in ends) else ()
        stance = np.zeros((len(shares), 2), np.bool_)
        takes.append(Take(clip, spread(frames, shares, cyclic=False), stance, held))
    return takes
