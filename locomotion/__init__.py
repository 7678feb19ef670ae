"""Bodies that follow a path."""

from locomotion.approach import ApproachPlan, plan_approach, plan_approach_exact
from locomotion.body import ARRIVAL_DISTANCE, PERSON_RULES, Human, HumanState
from locomotion.errors import LocomotionError
from locomotion.ground import Ground
from locomotion.human_state import MOVING
from locomotion.route_smoothing import ObstacleAhead, Smoothing, SmoothPath, smooth_route
from locomotion.skill import RunSkill, load_run_skill
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
