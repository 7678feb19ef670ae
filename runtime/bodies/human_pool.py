"""The simulated persons of a world as they are made, and kept for others who come later."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from locomotion import Human, HumanState, load_run_skill
from locomotion.gaits.brake import load_brake_skill
from locomotion.gaits.policy.skill import PolicySkill, load_policy
from locomotion.gaits.residual.skill import load_brake_residual, load_landing_residual
from locomotion.gaits.run.skill import RunSkill
from locomotion.gaits.slow_down import load_slow_down_skill
from locomotion.gaits.speed_up import load_speed_up_skill
from locomotion.gaits.walk.skill import WalkSkill, load_walk_skill
from locomotion.human.human import BetweenGaits
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.library import learned_skills
from runtime.planning.level import Level

__all__ = ["HumanPool"]


class _Learned(NamedTuple):
    """What people have learned, read once for all of a world."""

    run: RunSkill
    clearing: tuple[ClearingSkill, ...]
    walk: WalkSkill
    between: BetweenGaits
    policy: PolicySkill | None

    @classmethod
    def read(cls, skills: Sequence[Path], walk: str) -> "_Learned":
        run = load_run_skill()
        between = BetweenGaits(
            load_slow_down_skill(),
            load_speed_up_skill(),
            load_brake_skill(),
            load_brake_residual(),
            load_landing_residual(),
        )
        policy = load_policy() if walk == "learned" else None
        return cls(run, tuple(learned_skills(run, skills)), load_walk_skill(), between, policy)


class HumanPool:
    """Persons of any size on a ``level``. ``skills``, ``walk``: as of `runtime.bodies.people.People`;
    ``rehearsals``: as of `Human`; ``waits``: as of `Human.waits`."""

    def __init__(self, level: Level, skills: Sequence[Path], walk: str, rehearsals: int, waits: bool) -> None:
        self._level, self._skills, self._walk = level, skills, walk
        self._rehearsals, self._waits = rehearsals, waits
        self._learned: _Learned | None = None  # shared by all
        self._spare: dict[float, list[Human]] = {}
        self._unused: dict[float, HumanState] = {}

    def take(self, size: float) -> Human:
        """One of a ``size``, as good as new, who stands somewhere."""
        if self._learned is None:
            self._learned = _Learned.read(self._skills, self._walk)
        if self._spare.get(size):
            human = self._spare[size].pop()
            human.restore_state(self._unused[size])
            return human
        run, clearing, walk, between, policy = self._learned
        human = Human(
            self._level.ground_for(size), run, clearing, walk, between, self._rehearsals, gets_up=True,
            policy=policy,
        )  # fmt: skip
        human.waits = self._waits
        human.get_ready()
        self._unused.setdefault(size, human.save_state())
        return human

    def put_back(self, human: Human, size: float) -> None:
        """Keep one whom nobody holds any more."""
        human.bravery = None
        self._spare.setdefault(size, []).append(human)

    def forget(self) -> None:
        """Keep nobody: the level has changed."""
        self._spare, self._unused = {}, {}
