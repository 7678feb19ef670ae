"""Quadrupeds: dogs, cats, horses that follow a path with a bending spine and planted feet."""

from locomotion.quadruped.animal import Animal, AnimalMemory, Planner
from locomotion.quadruped.body import BODY_NAMES, Body, load_body
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
from locomotion.quadruped.trail import Trail, lay_trail

__all__ = [
    "BODY_NAMES",
    "LEGS",
    "Animal",
    "AnimalMemory",
    "Body",
    "Footprint",
    "Herd",
    "LocalMotion",
    "Place",
    "Planner",
    "Script",
    "Trail",
    "check_places",
    "check_script",
    "check_trail",
    "lay_trail",
    "load_body",
    "local_motion",
    "stopping_distance",
]
