"""Quadrupeds: dogs, cats, horses that follow a path with a bending spine and planted feet."""

from locomotion.quadruped.animal import Animal, AnimalMemory
from locomotion.quadruped.body import BODY_NAMES, Body, is_body_file, load_body
from locomotion.quadruped.footprint import (
    Footprint,
    check_places,
    check_script,
    check_trail,
    stopping_distance,
)
from locomotion.quadruped.herd import Herd
from locomotion.quadruped.layout import LEGS
from locomotion.quadruped.local_motion import LocalMotion, local_motion
from locomotion.quadruped.script import Place, Script
from locomotion.quadruped.trail import NoTrail, Trail, lay_trail
from locomotion.quadruped.trail_planning import Planner

__all__ = [
    "BODY_NAMES",
    "LEGS",
    "Animal",
    "AnimalMemory",
    "Body",
    "Footprint",
    "Herd",
    "LocalMotion",
    "NoTrail",
    "Place",
    "Planner",
    "Script",
    "Trail",
    "check_places",
    "check_script",
    "check_trail",
    "is_body_file",
    "lay_trail",
    "load_body",
    "local_motion",
    "stopping_distance",
]
