"""What users call skills: an obstacle is a jump, a vault, a drop or a gap; what clears it is a jump, a vault,
a drop-roll or a leap."""

__all__ = ["AFFORDANCE_OF", "SKILL_OF", "clears"]

SKILL_OF = {"jump": "jump", "vault": "vault", "drop": "drop-roll", "gap": "leap"}
"""The skill for each affordance."""
AFFORDANCE_OF = {skill: affordance for affordance, skill in SKILL_OF.items()}
"""The affordance that each skill needs."""
_CLEARS = {
    "jump": "jumps onto {:.2f} m",
    "vault": "vaults over {:.2f} m",
    "drop-roll": "drops {:.2f} m and rolls",
    "leap": "leaps over {:.2f} m",
}


def clears(skill: str, height: float) -> str:
    """What somebody does who begins with ``skill`` at an obstacle of ``height`` [m] (of a leap: its width).
    Files of earlier versions call the skill as the obstacle."""
    return _CLEARS[SKILL_OF.get(skill, skill)].format(height)
