"""Learned vaults, and the vault as a skill that the body can use."""

import os
from functools import lru_cache
from typing import Literal

import mujoco
import numpy as np
from numpy.typing import NDArray

from locomotion.body.hand_hold import hold, let_go
from locomotion.clips.clip import Clip, load_clip
from locomotion.data import CLIPS, SKILLS
from locomotion.gaits.run.skill import RunSkill
from locomotion.paths.smoothing import ObstacleAhead
from locomotion.saved_arrays import COUNT, FLAG, SIDE, Slots
from locomotion.skills.kernel import FIRST_STEP, LAST_STEP
from locomotion.skills.learned_skill import LawTables, LearnedSkill, tables_over_run
from locomotion.skills.skill_file import SkillFamily, load_family
from locomotion.skills.vault import kernel as vault
from locomotion.skills.vault.kernel import start_vault, vault_fell, vault_tick

__all__ = [
    "KIND", "VAULT_CLIP", "VAULT_SKILL", "Vault", "grip", "load_vault_skill",
    "tables_of", "vault_clip",
]  # fmt: skip

VAULT_CLIP = CLIPS / "vault.yaml"
VAULT_SKILL = SKILLS / "vault.npz"
KIND = "vault skill"


@lru_cache(maxsize=1)
def vault_clip() -> Clip:
    """The reference clip that comes with the package."""
    return load_clip(VAULT_CLIP)


def tables_of(parameters: NDArray[np.float64], reference: NDArray[np.float64], run: RunSkill) -> LawTables:
    """Put the arguments of the kernels together; ``reference`` (4, 6, 18): expected sensors."""
    return tables_over_run(parameters, vault.parameter_slices(), reference, vault_clip(), run)


def load_vault_skill(path: str | os.PathLike[str] = VAULT_SKILL) -> SkillFamily:
    """Read learned vaults; `LocomotionError` if the file is missing, cut off, of another version or of
    another person."""
    width = sum(vault.PARAMETERS.values())
    return load_family(path, KIND, width, (vault.STEPS * vault.BINS, vault.SENSORS))


class Vault(LearnedSkill):
    """Vaulting over walls as a `locomotion.skills.interface.ClearingSkill`, on top of a given run.

    joint: whether a ball joint holds the hand on the top, as in "Terrain Runner" (4.2.1), which can pull,
    too; else only friction does. Can be set.
    """

    affordance = "vault"
    ends: Literal["running", "walking"] = "running"
    slots = Slots(
        "the vault of a person",
        vault.MEMORY_SIZE,
        [
            (vault.ACTIVE, FLAG),
            (FIRST_STEP, COUNT),
            (LAST_STEP, COUNT),
            (vault.HOLD, (0.0, 2.0)),
            (vault.HELD, COUNT),
            (vault.SIDE, SIDE),
            (vault.PHASE, (0.0, vault.PHASES - 1.0)),
        ],
        whole=(vault.ACTIVE, FIRST_STEP, LAST_STEP, vault.HOLD, vault.PHASE),
    )

    def __init__(self, skill: SkillFamily, run: RunSkill) -> None:
        """``skill``: the learned vaults; ``run``: the run under them."""
        self.joint = False

        def law(height: float) -> LawTables:
            parameters, reference = skill.at(height)
            return tables_of(parameters, reference.reshape(vault.STEPS, vault.BINS, vault.SENSORS), run)

        super().__init__(skill, law)

    def start(self, obstacle: ObstacleAhead, state: NDArray[np.float64]) -> NDArray[np.float64]:
        """Begin a vault at a stance switch, before that tick's `tick`; gives all that it remembers, (k,)
        float64."""
        tables = self.tables(obstacle.height)
        memory = np.zeros(vault.MEMORY_SIZE)
        edge = np.ascontiguousarray(obstacle.position[:2], dtype=np.float64)
        ahead = np.ascontiguousarray(-obstacle.normal[:2], dtype=np.float64)
        top, height, depth = float(obstacle.position[2]), float(obstacle.height), float(obstacle.depth)
        start_vault(tables.parameters, memory, state, edge, ahead, top, height, depth)
        return memory

    def approach(self, size: float, depth: float = 0.0) -> tuple[float, float]:
        """The same nearer to walls that are thicker than usual."""
        entry, mark = super().approach(size)
        return entry, mark - vault.nearer(depth)

    def tick(
        self,
        obstacle: ObstacleAhead,
        memory: NDArray[np.float64],
        state: NDArray[np.float64],
        data: mujoco.MjData,
    ) -> bool:
        """One control tick after `run_tick`'s and before the physics; True when the vault is over."""
        tables = self.tables(obstacle.height)
        vault_tick(tables.parameters, *tables.rest, memory, state, data.qpos, data.ctrl)
        if self.joint:
            grip(memory, data)
        return bool(memory[vault.ACTIVE] == 0.0)

    def fell(self, memory: NDArray[np.float64], state: NDArray[np.float64]) -> bool:
        """Whether the body has fallen; over the wall it may lie and tuck its legs."""
        return vault_fell(memory, state)


def grip(memory: NDArray[np.float64], data: mujoco.MjData) -> None:
    """Switch the supporting hand's joint as `vault_tick` has decided."""
    if memory[vault.HOLD] == 1.0:
        hold(data, memory[vault.SIDE], memory[vault.ANCHOR])
    else:
        let_go(data, memory[vault.SIDE])
