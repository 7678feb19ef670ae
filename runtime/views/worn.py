"""What is drawn of people who wear a character: its skin, capsules along its bones for the shadow, and what
they hold, in its hands."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from locomotion import Ground, Rig
from locomotion.characters.skinning import posed_points
from runtime.bodies.figure import Figure, Shapes, rotate
from runtime.bodies.held_things import place_between
from runtime.bodies.pose import between
from runtime.errors import RuntimeInputError
from runtime.traces.trace import AgentTrace, LevelTrace, Trace
from runtime.views.render import Triangles

__all__ = ["Wardrobe", "ground_of", "only_things", "wearers", "wears", "worn_poses"]

_THICK = 0.03  # [body heights] radius of the capsules along bones


def wears(agent: AgentTrace) -> bool:
    """Whether an agent is a person, whom a character can show."""
    return {"pelvis", "right_thigh", "left_thigh"} <= set(agent.figure.bodies)


def wearers(agents: Sequence[AgentTrace]) -> list[AgentTrace]:
    """The people among ``agents``. Raises `RuntimeInputError` if there are none."""
    found = [agent for agent in agents if wears(agent)]
    if not found:
        names = ", ".join(agent.name for agent in agents)
        raise RuntimeInputError(f"a character shows people; in this run there are none, but {names}")
    return found


def ground_of(level: LevelTrace) -> Ground | None:
    """What the feet of a character stand on."""
    return Ground.from_arrays(level.vertices, level.faces) if len(level.faces) else None


def worn_poses(rig: Rig, agent: AgentTrace, times: np.ndarray, ground: Ground | None) -> np.ndarray:
    """(t, b, 7) the bones of a ``rig`` that an agent wears, at the ``times`` (t,) [s] of its trace."""
    own, grip = agent.own, agent.held.any(axis=1) if agent.held.shape[1] else 0.0
    return rig.pose_motion(agent.poses[:, :own], times, agent.figure.bodies[:own], ground, grip)


def only_things(agent: AgentTrace, rig: Rig, worn: np.ndarray) -> AgentTrace | None:
    """What an agent holds, in the hands of the ``rig`` that it wears, whose bones are at ``worn`` (t, b, 7);
    None if that is nothing."""
    own, count = agent.own, agent.held.shape[1]
    if count == 0:
        return None
    poses = agent.poses[:, own:].astype(np.float64)
    hands = [rig.parts.get(f"{side}_hand") for side in ("right", "left")]
    if None not in hands:
        bones = [worn[:, rig.names.index(str(hand))] for hand in hands]
        points = [
            bone[:, :3] + rotate(bone[:, 3:], point)
            for bone, point in zip(bones, rig.hand_points, strict=True)
        ]
        turn = agent.poses[:, agent.figure.bodies.index("right_hand"), 3:].astype(np.float64)
        poses = np.repeat(place_between(points[0], points[1], turn)[:, None], count, axis=1)
    shapes, shown = agent.figure.shapes, agent.figure.owner >= own
    look = Figure(
        agent.figure.bodies[own:],
        np.full(count, -1, np.int32),
        agent.figure.owner[shown] - own,
        Shapes(*(part[shown] for part in (shapes.place, shapes.size, shapes.round, shapes.colour))),
    )
    return replace(agent, figure=look, poses=poses.astype(np.float32), paths=())


class Wardrobe:
    """A ``rig`` as ``agents`` of a ``trace`` wear it, who are people, at all of its moments."""

    def __init__(self, rig: Rig, trace: Trace, agents: Sequence[AgentTrace]) -> None:
        self._rig, self._mesh, ground = rig, rig.skeleton.mesh, ground_of(trace.level)
        self._poses = {agent.name: worn_poses(rig, agent, trace.times, ground) for agent in agents}
        self._things = {agent.name: only_things(agent, rig, self._poses[agent.name]) for agent in agents}

    def worn(
        self, agent: AgentTrace, moment: int, share: float = 0.0
    ) -> tuple[Triangles, list[Shapes], Shapes]:
        """The skin for an agent, what it holds, and what casts its shadow, a ``share`` (0 to 1) of the way
        from the ``moment`` of that number to the next."""
        pose = _between(self._poses[agent.name], moment, share)
        skin = Triangles(posed_points(self._rig.skeleton, pose), self._mesh.faces, self._mesh.colours)
        things = self._things[agent.name]
        held = [] if things is None else [things.posed(moment, _between(things.poses, moment, share))]
        return skin, [shapes for shapes in held if len(shapes.size)], self._along_bones(pose)

    def _along_bones(self, pose: np.ndarray) -> Shapes:
        parents = self._rig.parents
        ends = pose[parents >= 0, :3]
        starts = pose[parents[parents >= 0], :3]
        along = ends - starts
        length = np.linalg.norm(along, axis=1)
        unit = along / np.maximum(length, 1e-9)[:, None]
        unit[length < 1e-9] = 0.0, 0.0, 1.0
        turn = np.column_stack([1.0 + unit[:, 2], -unit[:, 1], unit[:, 0], np.zeros(len(unit))])
        turn[unit[:, 2] < -0.999999] = 0.0, 1.0, 0.0, 0.0  # straight down
        turn /= np.linalg.norm(turn, axis=1, keepdims=True)
        radius = _THICK * float(np.ptp(self._mesh.points[:, 2]))
        size = np.column_stack([np.full(len(length), radius), 0.5 * length, np.zeros(len(length))])
        count = len(length)
        place = np.hstack([0.5 * (starts + ends), turn])
        return Shapes(place, size, np.zeros(count, bool), np.zeros((count, 3)))


def _between(poses: np.ndarray, moment: int, share: float) -> np.ndarray:
    """(n, 7) of ``poses`` (t, n, 7)."""
    first, then = poses[moment].astype(np.float64), poses[min(moment + 1, len(poses) - 1)].astype(np.float64)
    return between(first, then, share)
