"""Bodies that follow a path."""

from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.ground.ground import Ground
from locomotion.human.human import ARRIVAL_DISTANCE, PERSON_RULES, Human, HumanState
from locomotion.human.state import MOVING
from locomotion.paths.smoothing import ObstacleAhead, Smoothing, SmoothPath, smooth_route
from locomotion.skills.approach import ApproachPlan, plan_approach, plan_approach_exact
from surefoot import __version__

__all__ = [
    "ARRIVAL_DISTANCE",
    "MOVING",
    "PERSON_RULES",
    "ApproachPlan",
    "Ground",
    "Human",
    "HumanState",
    "LocomotionError",
    "ObstacleAhead",
    "RunSkill",
    "SmoothPath",
    "Smoothing",
    "__version__",
    "load_run_skill",
    "plan_approach",
    "plan_approach_exact",
    "smooth_route",
]
