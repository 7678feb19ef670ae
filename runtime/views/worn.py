"""What is drawn of people who wear a character: its skin, and capsules along its bones for the shadow."""

from collections.abc import Sequence

import numpy as np

from locomotion import Ground, Rig
from locomotion.characters.skinning import posed_points
from runtime.bodies.figure import Shapes
from runtime.errors import RuntimeInputError
from runtime.traces.trace import AgentTrace, LevelTrace
from runtime.views.render import Triangles

__all__ = ["Wardrobe", "wearers", "wears"]

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


class Wardrobe:
    """A character as people wear it on a level."""

    def __init__(self, rig: Rig, level: LevelTrace) -> None:
        self._rig, self._mesh = rig, rig.skeleton.mesh
        self._ground = Ground.from_arrays(level.vertices, level.faces) if len(level.faces) else None

    def worn(self, bodies: Sequence[str], places: np.ndarray) -> tuple[Triangles, Shapes]:
        """The skin for a person whose ``bodies`` are at ``places`` (n, 7), and what casts its shadow."""
        pose = self._rig.pose_from(places, bodies, self._ground)
        skin = Triangles(posed_points(self._rig.skeleton, pose), self._mesh.faces, self._mesh.colours)
        return skin, self._along_bones(pose)

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
