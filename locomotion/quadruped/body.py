"""A quadruped's body as data: bones, gaits and limits, read from a YAML file and checked.

    body = load_body("dog")            # or "cat", "horse", or the path of a file of your own

Lengths in metres, angles in degrees where the name ends in ``_deg``, speeds in metres per second.
"""

from __future__ import annotations

import math
import os
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Annotated, Self

import numpy as np
from annotated_types import Ge, Gt, Le, Len
from numpy.typing import NDArray
from pydantic import model_validator

import navmesh
from locomotion.data import BODIES
from locomotion.errors import LocomotionError
from locomotion.paths.smoothing import Smoothing
from locomotion.quadruped import layout as at
from locomotion.quadruped.gait_data import Gait, Length, Share, Strict
from surefoot.files.yamlfile import FileError, read_yaml

__all__ = ["BODY_NAMES", "Body", "Gait", "is_body_file", "load_body"]

BODY_NAMES = ("dog", "cat", "horse")
"""Bodies that come with the package."""

_BREATHS = 11.8 / 60.0  # [Hz] of one whose hips are 1 m high: 53.5 a minute by mass^-0.26 (Stahl, "Scaling of
# respiratory variables in mammals", 1967), 337 kg for a cubic metre of hip height, as of the dog


class Spine(Strict):
    """From between the rear feet to between the front feet, as seen from above."""

    length: Length
    bones: Annotated[int, Ge(2), Le(16)]
    bone_length: Length
    flex: Annotated[float, Ge(0.0), Le(2.0)]
    """Share of a turn that the spine takes: 0 a plank, 1 the rear follows the path, above 1 a cat."""
    max_bend_deg: Annotated[float, Gt(0.0), Le(60.0)]
    """Largest angle between two bones."""
    sacral: Share = 0.4
    """Share of its flexion in a gait at the joint between pelvis and spine."""

    @model_validator(mode="after")
    def _adds_up(self) -> Self:
        whole = self.bones * self.bone_length
        if abs(whole - self.length) > 1e-6:
            raise ValueError(
                f"{self.bones} bones of {self.bone_length:g} m make {whole:g} m, the spine {self.length:g}"
            )
        if self.bones * self.max_bend_deg > 180.0:
            raise ValueError(f"{self.bones} bones that bend by {self.max_bend_deg:g}° close to a ring")
        return self


class Legs(Strict):
    """A pair of legs, each of an upper, a lower and a foot bone."""

    height: Length
    """Height of the upper joint above the ground when standing."""
    track: Length
    """Between the left and the right foot."""
    upper: Length
    lower: Length
    foot: Length
    lean_deg: Annotated[float, Ge(-60.0), Le(60.0)]
    """Of the foot bone when standing: how far its upper end is behind the vertical."""
    curl_deg: Annotated[float, Ge(0.0), Le(120.0)]
    """Angle by which the foot bone folds backwards in the swing."""

    @model_validator(mode="after")
    def _reaches(self) -> Self:
        whole = self.upper + self.lower + self.foot
        if whole < 1.02 * self.height:
            raise ValueError(
                f"bones of {self.upper:g}, {self.lower:g} and {self.foot:g} m make {whole:g} m: too short "
                f"for a height of {self.height:g} m"
            )
        if abs(self.upper - self.lower) > self.height - self.foot:
            raise ValueError(
                f"bones of {self.upper:g} and {self.lower:g} m cannot fold to a height of {self.height:g} m"
            )
        return self


class Neck(Strict):
    length: Length
    rise_deg: Annotated[float, Ge(-60.0), Le(90.0)]


class Head(Strict):
    length: Length
    drop_deg: Annotated[float, Ge(-30.0), Le(90.0)]
    radius: Length
    turn_deg: Annotated[float, Ge(0.0), Le(120.0)]
    """Largest turn of neck and head together."""
    look_ahead: Annotated[float, Gt(0.0), Le(5.0)]
    """[s] how far ahead on its path it looks."""


class Tail(Strict):
    length: Length
    rise_deg: Annotated[float, Ge(-90.0), Le(90.0)]


class Trunk(Strict):
    chest: Length
    """Radius behind the shoulders."""
    loin: Length
    """Radius before the hips."""


class Movement(Strict):
    """Limits."""

    acceleration: Annotated[float, Gt(0.0), Le(50.0)]
    braking: Annotated[float, Gt(0.0), Le(50.0)]
    sideways: Annotated[float, Gt(0.0), Le(50.0)]
    """[m/s²] in a bend."""
    path_rounding: Length
    """Over which the corners of its paths are rounded."""
    turn_radius: Length | None
    """Tightest bend of its paths; null: it can turn anywhere, and paths are found faster."""
    back_speed: Annotated[float, Gt(0.0), Le(5.0)]
    step: Length
    """Highest step under a foot."""
    slope_deg: Annotated[float, Gt(0.0), Le(60.0)]
    headroom: Length
    step_frequency: Annotated[float, Gt(0.2), Le(10.0)]
    """[Hz] of the strides when it steps around on the spot."""


class _Window(Strict):
    """Share of the whole motion during which it plays."""

    begin: Share
    end: Share

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.end < self.begin + 0.1:
            raise ValueError(f"end {self.end:g} must be at least 0.1 behind begin {self.begin:g}")
        return self


class Move(_Window):
    speed: Annotated[float, Gt(0.0), Le(5.0)]


class Turn(_Window):
    speed_deg: Annotated[float, Gt(0.0), Le(720.0)]


class Idle(Strict):
    """What it does when it stands, besides breathing and shifting its weight."""

    look_deg: Annotated[float, Ge(0.0), Le(120.0)] = 40.0
    """Farthest that it looks to a side."""
    sway_deg: Annotated[float, Ge(0.0), Le(15.0)] = 3.0
    """Roll of the hips with the weight on one hind leg."""
    tail_deg: Annotated[float, Ge(0.0), Le(60.0)] = 8.0
    """Swing of the tail to each side."""


class LocalMotions(Strict):
    """Motions blended for short moves: forwards and back, sideways, and around."""

    step: Move
    sidestep: Move
    turn: Turn


class Body(Strict):
    """A kind of quadruped. ``radius``: clearance in the graph's queries, half the shoulder width."""

    name: Annotated[str, Len(1, 40)]
    colour: Annotated[list[Share], Len(3, 3)]
    shoulder_width: Length
    spine: Spine
    front_legs: Legs
    rear_legs: Legs
    neck: Neck
    head: Head
    tail: Tail
    trunk: Trunk
    movement: Movement
    idle: Idle = Idle()
    local_motions: LocalMotions
    gaits: dict[str, Gait]

    @model_validator(mode="after")
    def _fits(self) -> Self:
        for name, legs in (("front_legs", self.front_legs), ("rear_legs", self.rear_legs)):
            if legs.track > self.shoulder_width:
                raise ValueError(f"{name}.track is {legs.track:g} m, wider than the shoulders")
        speeds = [gait.up_to for gait in self.gaits.values() if not gait.on_request]
        if not speeds:
            raise ValueError("gaits: at least one must not be on_request")
        if speeds != sorted(speeds):
            raise ValueError(f"gaits: those chosen by speed go from slow to fast, not up to {speeds}")
        return self

    @property
    def radius(self) -> float:
        """[m]"""
        return 0.5 * self.shoulder_width

    @property
    def length(self) -> float:
        """[m] from rump to nose, in the pose for turning."""
        reach = self.neck.length * math.cos(math.radians(self.neck.rise_deg))
        return self.spine.length + reach + self.head.length + self.trunk.loin

    @property
    def top_speed(self) -> float:
        """[m/s]"""
        return max(gait.up_to for gait in self.gaits.values() if not gait.on_request)

    @cached_property
    def gait_order(self) -> tuple[str, ...]:
        """Names of the gaits by the kernels' numbers: by speed, then those on request."""
        return tuple(sorted(self.gaits, key=lambda name: self.gaits[name].on_request))

    def walk_rules(self, resolution: float | None = None) -> navmesh.WalkRules:
        """Where this body can walk, for `navmesh.NodeGraph.build`. ``resolution`` [m] defaults to no more
        than its radius: passages narrower than a cell can be missed."""
        move = self.movement
        resolution = min(0.25, self.radius) if resolution is None else resolution
        return navmesh.WalkRules(
            max_slope=math.radians(move.slope_deg), max_step=min(move.step, move.headroom / 2),
            headroom=move.headroom, resolution=resolution, min_radius=min(0.1, self.radius),
        )  # fmt: skip

    @property
    def smoothing(self) -> Smoothing:
        """Requirements on its paths."""
        rounding, radius = self.movement.path_rounding, self.movement.turn_radius
        bounds = () if radius is None else (1.0 / radius,)
        return Smoothing(bounds, 0.25 * rounding, 2.0 * rounding**3)

    @property
    def spine_reach(self) -> float:
        """[rad] by which the spine alone can turn the front away from the rear's direction."""
        return 0.5 * (self.spine.bones + 1) * math.radians(self.spine.max_bend_deg)

    def params(self) -> NDArray[np.float64]:
        """(PARAMS,) float64 for the kernels."""
        row = np.zeros(at.PARAMS)
        spine, front, rear, move = self.spine, self.front_legs, self.rear_legs, self.movement
        rad = math.radians
        row[[at.BONES, at.BONE, at.FLEX]] = spine.bones, spine.bone_length, spine.flex
        row[at.MAX_BEND] = rad(spine.max_bend_deg)
        row[[at.WIDTH_FRONT, at.WIDTH_REAR]] = front.track, rear.track
        row[[at.HEIGHT_FRONT, at.HEIGHT_REAR]] = front.height, rear.height
        for first, legs in ((at.UPPER_FRONT, front), (at.UPPER_REAR, rear)):
            row[first : first + 4] = legs.upper, legs.lower, legs.foot, rad(legs.lean_deg)
        row[[at.NECK, at.NECK_RISE]] = self.neck.length, rad(self.neck.rise_deg)
        row[[at.HEAD, at.HEAD_DROP]] = self.head.length, rad(self.head.drop_deg)
        row[at.HEAD_TURN] = rad(self.head.turn_deg)
        row[[at.TAIL, at.TAIL_RISE]] = self.tail.length / 3.0, rad(self.tail.rise_deg)
        row[at.LOOK_AHEAD] = self.head.look_ahead
        row[[at.ACCELERATION, at.BRAKING, at.SIDEWAYS]] = move.acceleration, move.braking, move.sideways
        row[at.STEP] = move.step
        row[[at.CURL_FRONT, at.CURL_REAR]] = rad(front.curl_deg), rad(rear.curl_deg)
        row[at.AUTOMATIC] = sum(not gait.on_request for gait in self.gaits.values())
        row[at.STEP_FREQUENCY] = move.step_frequency
        idle = self.idle
        row[at.SACRAL], row[at.BREATHS] = spine.sacral, _BREATHS * rear.height**-0.78
        row[[at.LOOK, at.SWAY, at.WAG]] = np.radians(
            [min(idle.look_deg, self.head.turn_deg), idle.sway_deg, idle.tail_deg]
        )
        return row

    def gait_rows(self) -> NDArray[np.float64]:
        """(gaits, GAIT) float64 for the kernels, in the order of `gait_order`."""
        return np.stack(
            [self.gaits[name].row(self.spine.bones * self.spine.max_bend_deg) for name in self.gait_order]
        )

    def gait_index(self, name: str | None) -> int:
        """The kernels' number of a gait; -1 for None: chosen by speed. Raises `LocomotionError` for an
        unknown one."""
        if name is None:
            return -1
        if name not in self.gaits:
            raise LocomotionError(f"{self.name} has no gait {name!r}; valid: {', '.join(self.gait_order)}")
        return self.gait_order.index(name)


def load_body(name: str | os.PathLike[str]) -> Body:
    """One of `BODY_NAMES`, or the body in a YAML file.

    Raises `LocomotionError` that names the file, line and column of what is wrong.
    """
    if name in BODY_NAMES:
        return _own_body(str(name))
    if not is_body_file(name):
        raise LocomotionError(f"body {str(name)!r}: valid: {', '.join(BODY_NAMES)}, or a .yaml file")
    return _read_body(Path(name))


def is_body_file(name: str | os.PathLike[str]) -> bool:
    """Whether `load_body` treats ``name`` as a file."""
    return Path(name).suffix in (".yaml", ".yml")


@lru_cache
def _own_body(name: str) -> Body:
    return _read_body(BODIES / f"{name}.yaml")


def _read_body(path: Path) -> Body:
    try:
        return read_yaml(path, Body, "quadruped's body")[0]
    except FileError as error:
        raise LocomotionError(str(error)) from None
