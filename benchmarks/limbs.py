"""How deep a person's limbs are in each other. MuJoCo does not find that out: its shapes never touch each
other.

Looked at are the shapes that touch the ground, in pairs whose bodies no joint connects. Some of these overlap
in the rest pose already, an upper arm and the chest by 25 mm: only what is deeper than that counts.
"""

from itertools import combinations

import mujoco
import numpy as np

from locomotion.body.person import BODY_NAMES

__all__ = ["Limbs"]


class Limbs:
    """The deepest that has been seen of each pair of a person's bodies."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self._model = model
        own = [model.body(name).id for name in BODY_NAMES]
        shapes = np.flatnonzero((model.geom_conaffinity > 0) & np.isin(model.geom_bodyid, own))
        bodies, parents = model.geom_bodyid, model.body_parentid
        self._pairs = np.array([
            (a, b) for a, b in combinations(shapes.tolist(), 2)
            if bodies[a] != bodies[b] and parents[bodies[a]] != bodies[b] and parents[bodies[b]] != bodies[a]
        ])  # fmt: skip
        self._reach = model.geom_rbound[self._pairs].sum(axis=1)
        rest = mujoco.MjData(model)
        mujoco.mj_kinematics(model, rest)
        self._rest = np.zeros(len(self._pairs))
        self._rest = self._overlaps(rest)
        self._deepest = np.zeros(len(self._pairs))

    def _overlaps(self, data: mujoco.MjData) -> np.ndarray:
        """Of each pair, beyond that at rest [m]."""
        places, found = data.geom_xpos[self._pairs], np.zeros(len(self._pairs))
        near = np.linalg.norm(places[:, 0] - places[:, 1], axis=1) < self._reach
        for k in np.flatnonzero(near):
            found[k] = -mujoco.mj_geomDistance(self._model, data, *self._pairs[k], 0.0, None)
        return np.maximum(found - self._rest, 0.0)

    def note(self, data: mujoco.MjData) -> None:
        """Look at a pose."""
        np.maximum(self._deepest, self._overlaps(data), out=self._deepest)

    def deepest(self) -> dict[str, float]:
        """How deep [m] of each two bodies that were in each other, such as "left hand in left thigh"."""
        found: dict[str, float] = {}
        for k in np.flatnonzero(self._deepest):
            one, other = (self._model.body(self._model.geom_bodyid[g]).name for g in self._pairs[k])
            name = f"{one} in {other}".replace("_", " ")
            found[name] = max(found.get(name, 0.0), float(self._deepest[k]))
        return found
