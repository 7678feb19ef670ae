"""The skills for all kinds of obstacles, in one list; whatever names kinds, statuses or skills asks here.

    register_skill(SkillKind(obstacle=navmesh.ObstacleKind("hurdle", "over"), skill="hurdle", ...))

The package's own kinds stand in `_PACKAGE`, in the order in which their skills are learned.
"""

from __future__ import annotations

from locomotion.errors import LocomotionError
from locomotion.skills.drop_roll.kind import DROP_ROLL
from locomotion.skills.jump.kind import JUMP
from locomotion.skills.kind import SkillKind
from locomotion.skills.leap.kind import LEAP
from locomotion.skills.vault.kind import VAULT
from navmesh.obstacles import kinds as obstacles

__all__ = [
    "BUSY", "CLEARING", "in_words", "register_skill", "skill_called", "skill_kind", "skill_kinds",
    "skill_words", "unregister_skill",
]  # fmt: skip

_PACKAGE = (JUMP, VAULT, DROP_ROLL, LEAP)
for _kind in _PACKAGE:
    if _kind.affordance not in obstacles.affordances():  # a kind that the package does not find in meshes
        obstacles.register(_kind.obstacle)
BUSY = (
    "standing", "walking", "running", "scrambling", "getting up", "fallen", "arrived", "lost", "stuck",
)  # fmt: skip
"""What a person can be doing that does not clear an obstacle."""

_kinds: dict[str, SkillKind] = {kind.affordance: kind for kind in _PACKAGE}
CLEARING: dict[str, str] = {kind.affordance: kind.status for kind in _PACKAGE}
"""What a person does that clears an obstacle, by affordance; changes with `register_skill`."""


def skill_kinds() -> tuple[SkillKind, ...]:
    """All kinds: the package's, then the others as they were registered."""
    return tuple(_kinds.values())


def skill_words() -> tuple[str, ...]:
    """What users call the skills, in the order of `skill_kinds`."""
    return tuple(kind.skill for kind in _kinds.values())


def skill_kind(affordance: str) -> SkillKind:
    """The skill for a kind of obstacle. Raises `LocomotionError` where there is none."""
    try:
        return _kinds[affordance]
    except KeyError:
        raise LocomotionError(f"affordance {affordance!r}: valid: {', '.join(_kinds)}") from None


def skill_called(name: str) -> SkillKind:
    """The skill that users call ``name``; files of earlier versions call it as its obstacle. Raises
    `LocomotionError` where there is none."""
    for kind in _kinds.values():
        if kind.skill == name:
            return kind
    if name in _kinds:
        return _kinds[name]
    raise LocomotionError(f"skill {name!r}: valid: {', '.join(skill_words())}")


def in_words(skill: str, size: float) -> str:
    """What somebody does who begins with ``skill`` at an obstacle of ``size`` [m]."""
    return skill_called(skill).does.format(size)


def register_skill(kind: SkillKind) -> None:
    """Add a kind of obstacle and its skill, in this process, before the first graph and the first person are
    made: people clear such obstacles, and missions, playtests and views know the skill.

    Raises `LocomotionError` for a skill, a status or an affordance that there is already, and `NavmeshError`
    if the graph knows another kind of obstacle of this name.
    """
    for known in _kinds.values():
        taken = {known.affordance, known.skill} & {kind.affordance, kind.skill}
        if taken:
            raise LocomotionError(f"{kind.affordance}: the name {taken.pop()!r} is taken; names are unique")
        if known.status == kind.status:
            raise LocomotionError(f"{kind.affordance}: the status {kind.status!r} is taken")
    if kind.status in BUSY:
        raise LocomotionError(f"{kind.affordance}: the status {kind.status!r} is taken")
    obstacles.register(kind.obstacle)
    _kinds[kind.affordance] = kind
    CLEARING[kind.affordance] = kind.status


def unregister_skill(affordance: str) -> None:
    """Take back a `register_skill`: graphs and worlds that know the kind cannot be used any more. Raises
    `LocomotionError` for what was not registered, and for the package's own kinds."""
    if skill_kind(affordance) in _PACKAGE:
        raise LocomotionError(f"the skill for {affordance!r} comes with the package")
    obstacles.unregister(affordance)
    del _kinds[affordance], CLEARING[affordance]
