"""Find what is wrong with a posture graph: postures that cannot be reached, arcs that do not meet the
postures at their ends, and what a body cannot do."""

from dataclasses import dataclass

import numpy as np

from locomotion.body.person import JOINT_NAMES
from locomotion.clips.motion import Motion
from locomotion.clips.motion_check import check_motion
from locomotion.postures.places import placed
from locomotion.postures.posture_graph import PostureGraph, frame_at

__all__ = ["PostureFault", "check_postures"]

_JOINT = np.radians(5.0)  # that an arc's end may be off its posture
_PLACE = 0.02  # [m] the root
_TURN = np.radians(5.0)


@dataclass(frozen=True)
class PostureFault:
    """Something wrong with ``arc``, or, if that is -1, with ``posture``: numbers of the graph. ``problem``
    says what, in words."""

    arc: int
    posture: int
    problem: str


def check_postures(graph: PostureGraph) -> list[PostureFault]:
    """Everything that is wrong with a graph, by posture and then by arc. Arcs that are played backwards have
    the faults of their opposites and are not listed."""
    faults = []
    for p, name in enumerate(graph.postures):
        for fault in check_motion(Motion(name, 1.0, graph.poses[p : p + 1])):
            faults.append(PostureFault(-1, p, str(fault).partition(" from ")[0]))
        there, back = np.isfinite(graph.least[:, p]), np.isfinite(graph.least[p])
        if len(there) > 1 and p != graph.fatal:
            if there.sum() == 1:
                faults.append(PostureFault(-1, p, f"{name!r} cannot be reached: no arc leads to it"))
            elif back.sum() == 1:
                faults.append(PostureFault(-1, p, f"{name!r} cannot be left: no arc leads from it"))
    for a in np.flatnonzero(~graph.backwards).tolist():
        frames = graph.frames[graph.first[a] : graph.first[a] + graph.count[a]]
        rate = (len(frames) - 1) / graph.seconds[a]
        faults += [PostureFault(a, -1, str(fault)) for fault in check_motion(Motion("", float(rate), frames))]
        for posture, seconds, place, when in (
            (graph.start[a], 0.0, np.zeros(3), "begins"),
            (graph.end[a], graph.seconds[a], graph.moves[a], "ends"),
        ):
            problem = _apart(frame_at(graph, a, seconds), placed(graph.poses[posture], place))
            if problem:
                name = graph.postures[posture]
                faults.append(PostureFault(a, -1, f"does not meet {name!r} where it {when}: {problem}"))
    return faults


def _apart(pose: np.ndarray, posture: np.ndarray) -> str:
    """How a pose differs from a posture, in words, or "" if it hardly does."""
    off = np.abs(pose[7:] - posture[7:])
    worst = int(np.argmax(off))
    if off[worst] > _JOINT:
        return f"{JOINT_NAMES[worst]} is {np.degrees(off[worst]):.0f} degrees off"
    far = float(np.linalg.norm(pose[:3] - posture[:3]))
    if far > _PLACE:
        return f"the pelvis is {100 * far:.0f} cm off"
    turn = 2.0 * np.arccos(min(abs(float(pose[3:7] @ posture[3:7])), 1.0))
    return f"the pelvis is turned by {np.degrees(turn):.0f} degrees" if turn > _TURN else ""
