"""Bodies that follow paths: people, animals and crowds."""

from locomotion.characters.footing import Footing
from locomotion.characters.rig import Rig
from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.ground.ground import Ground
from locomotion.human.human import ARRIVAL_DISTANCE, PERSON_RULES, Human, HumanState
from locomotion.human.state import MOVING
from locomotion.paths.smoothing import ObstacleAhead, Smoothing, SmoothPath, smooth_route
from locomotion.skills.approach import ApproachPlan, ApproachWeights, plan_approach, plan_approach_exact
from locomotion.skills.kind import SkillKind
from locomotion.skills.registry import register_skill, skill_kinds, unregister_skill
from surefoot import __version__

__all__ = [
    "ARRIVAL_DISTANCE",
    "MOVING",
    "PERSON_RULES",
    "ApproachPlan",
    "ApproachWeights",
    "Footing",
    "Ground",
    "Human",
    "HumanState",
    "LocomotionError",
    "ObstacleAhead",
    "Rig",
    "RunSkill",
    "SkillKind",
    "SmoothPath",
    "Smoothing",
    "__version__",
    "load_run_skill",
    "plan_approach",
    "plan_approach_exact",
    "register_skill",
    "skill_kinds",
    "smooth_route",
    "unregister_skill",
]
