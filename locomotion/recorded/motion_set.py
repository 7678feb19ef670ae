"""Recorded motion that all figures share.

::

    motions = load_motions()                          # the package's own
    for name, origin in zip(motions.names, motions.origins, strict=True):
        print(name, origin)
    walk = motions.clip("walk 1.2")

A set is made offline (``surefoot record``, `locomotion.recorded.recorder`) and never changes. It is played by
`locomotion.recorded.sampling`.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Annotated, Self

import numpy as np
from annotated_types import Ge, Gt, Le, Lt
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, model_validator

from locomotion.body.person import JOINT_NAMES
from locomotion.data import MOTIONS
from locomotion.errors import LocomotionError
from locomotion.recorded.skeletons import LEVELS, skeleton
from surefoot.files.archive import ArchiveError, read_archive, write_archive
from surefoot.files.schema import Array, Flags, Header, Numbers, Schema

__all__ = ["KINDS", "PERSON_MOTIONS", "Clip", "LevelFrames", "MotionSet", "load_motions"]

PERSON_MOTIONS = MOTIONS / "person.npz"
KINDS = ("posture", "arc", "cycle", "skill")
"""What a clip is: a posture held; a motion from one posture to another; a cycle of a gait at a speed; a
motion that is done once."""
ANGLE = 1e-4
"""[rad] A file's joint angles are whole multiples of it."""
_MOST = 32767


class Clip(BaseModel):
    """One motion of a set.

    Attributes:
        name: in the set. kind: one of `KINDS`. gait: of a cycle, else "". origin: what made it.
        seconds: how long it takes; of a cycle, once round. speed: of a cycle [m/s]; of a turn on the spot
            [rad/s].
        travel: x, y [m] and turn [rad] from its beginning to its end, or once round.
        rest: of a cycle: the clip of the posture that the gait slows down to, or "".
        bears: of a cycle on two feet: the share of it for which each foot bears, from when it strikes, the
            right one at 0, the left one at 0.5. 0 for others: their feet are not planted.
        obstacle: of a skill: how far ahead of its beginning the near edge of the obstacle was, how high that
            was, and how deep, or wide [m]. 0 for others.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    name: str
    kind: str
    origin: str
    seconds: Annotated[float, Gt(0.0), Le(600.0)]
    gait: str = ""
    speed: float = 0.0
    travel: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rest: str = ""
    bears: Annotated[float, Ge(0.0), Lt(1.0)] = 0.0
    obstacle: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @model_validator(mode="after")
    def _is_of_a_kind(self) -> Self:
        if self.kind not in KINDS:
            raise ValueError(f"kind {self.kind!r}: valid: {', '.join(KINDS)}")
        if (self.kind == "cycle") != bool(self.gait):
            raise ValueError("a cycle has a gait, and nothing else has")
        return self


@dataclass(frozen=True, eq=False)
class LevelFrames:
    """The frames of all clips at one level, one clip after the other.

    Attributes:
        first, count: (k,) int64, the frames of each clip. They lie evenly over its seconds: from its
            beginning to its end, or once round, without the first again.
        channels: (f, c) float64 [rad], of the level's `Skeleton`.
        roots: (f, 7) float64, places of the pelvis. Those of a cycle are told from where even travel has
            taken the figure since the cycle's begin; all others from where it stood when the clip began, at
            x = y = 0 facing +x, on the ground z = 0.
        stance: (f, 2) bool: whether the right and the left foot bears.
    """

    first: NDArray[np.int64]
    count: NDArray[np.int64]
    channels: NDArray[np.float64]
    roots: NDArray[np.float64]
    stance: NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class MotionSet:
    """``clips``, and their frames at each of `LEVELS`; arrays are not to be changed."""

    clips: tuple[Clip, ...]
    levels: tuple[LevelFrames, ...]
    gaits: tuple[str, ...] = field(init=False)
    """Names of the gaits, sorted."""
    cycles: NDArray[np.int64] = field(init=False)
    """Clips of the gaits' cycles, gait after gait, by growing speed."""
    gait_first: NDArray[np.int64] = field(init=False)
    """(gaits + 1,): gait g has the cycles ``gait_first[g]`` to ``gait_first[g + 1]``."""
    rests: NDArray[np.int64] = field(init=False)
    """(gaits,) The clip of the posture at rest, or -1."""
    cyclic: NDArray[np.bool_] = field(init=False)
    """(k,) Whether a clip is a cycle."""
    seconds: NDArray[np.float64] = field(init=False)
    """(k,) [s]"""
    speeds: NDArray[np.float64] = field(init=False)
    """(k,) Speed of each cycle; 0 of other clips."""
    travel: NDArray[np.float64] = field(init=False)
    """(k, 3) as `Clip.travel`."""

    def __post_init__(self) -> None:
        clips = self.clips
        gaits = tuple(sorted({clip.gait for clip in clips} - {""}))
        order = sorted(
            (k for k, clip in enumerate(clips) if clip.gait), key=lambda k: (clips[k].gait, clips[k].speed)
        )
        counts = [sum(clip.gait == gait for clip in clips) for gait in gaits]
        for name, value in (
            ("gaits", gaits),
            ("cycles", np.array(order, np.int64)),
            ("gait_first", np.cumsum([0, *counts]).astype(np.int64)),
            ("rests", np.array([self._rest(gait) for gait in gaits], np.int64)),
            ("cyclic", np.array([clip.kind == "cycle" for clip in clips], np.bool_)),
            ("seconds", np.array([clip.seconds for clip in clips])),
            ("speeds", np.array([clip.speed for clip in clips])),
            ("travel", np.array([clip.travel for clip in clips]).reshape(-1, 3)),
        ):
            object.__setattr__(self, name, value)

    def _rest(self, gait: str) -> int:
        rest = next(clip.rest for clip in self.clips if clip.gait == gait)
        return self.names.index(rest) if rest else -1

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the clips."""
        return tuple(clip.name for clip in self.clips)

    @property
    def origins(self) -> tuple[str, ...]:
        """What made each clip."""
        return tuple(clip.origin for clip in self.clips)

    @property
    def nbytes(self) -> int:
        """Bytes of all frames in memory."""
        return sum(
            part.nbytes
            for level in self.levels
            for part in (level.first, level.count, level.channels, level.roots, level.stance)
        )

    def clip(self, name: str) -> int:
        """The number of a clip; `LocomotionError` for an unknown one."""
        return _number("clip", name, self.names)

    def gait(self, name: str) -> int:
        """The number of a gait; `LocomotionError` for an unknown one."""
        return _number("gait", name, self.gaits)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the set; the file appears whole or not at all. Angles are rounded to `ANGLE`, places to
        single precision."""
        arrays: dict[str, np.ndarray] = {}
        for name, level in zip(LEVELS, self.levels, strict=True):
            arrays[f"{name}_count"] = level.count.astype(np.int32)
            arrays[f"{name}_channels"] = np.round(level.channels / ANGLE).astype(np.int16)
            arrays[f"{name}_roots"] = level.roots.astype(np.float32)
            arrays[f"{name}_stance"] = level.stance
        header = {"joints": list(JOINT_NAMES), "clips": [clip.model_dump() for clip in self.clips]}
        write_archive(path, MOTION_SET_FILE.kind, MOTION_SET_FILE.version, header, arrays)


def _number(what: str, name: str, names: Sequence[str]) -> int:
    if name not in names:
        raise LocomotionError(f"{what} {name!r}: valid: {', '.join(names)}")
    return names.index(name)


class _MotionSetHeader(Header):
    joints: tuple[str, ...]
    clips: tuple[Clip, ...]

    @model_validator(mode="after")
    def _fits_the_person(self) -> Self:
        if self.joints != JOINT_NAMES:
            raise ValueError("the motions of a person with other joints")
        names = [clip.name for clip in self.clips]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"two clips are called {name!r}")
        for clip in self.clips:
            if clip.rest and clip.rest not in names:
                raise ValueError(f"clip {clip.name!r}: there is no clip {clip.rest!r} to rest in")
        places = [(clip.gait, clip.speed) for clip in self.clips if clip.gait]
        if len(set(places)) < len(places):
            raise ValueError("two cycles of a gait have the same speed")
        return self


def _check(header: _MotionSetHeader, arrays: dict[str, np.ndarray]) -> str | None:
    for name in LEVELS:
        counts, roots = arrays[f"{name}_count"], arrays[f"{name}_roots"]
        if len(counts) != len(header.clips):
            return f"{name}_count has {len(counts)} rows, expected one for each of {len(header.clips)} clips"
        if counts.sum(dtype=np.int64) != len(roots):
            return f"{name}_count adds up to {counts.sum(dtype=np.int64)}, expected {len(roots)} frames"
        if (np.abs(np.linalg.norm(roots[:, 3:].astype(np.float64), axis=1) - 1.0) > 1e-3).any():
            return f"{name}_roots holds a rotation that is not a unit quaternion"
    return None


def _arrays() -> dict[str, Array]:
    arrays: dict[str, Array] = {}
    for name in LEVELS:
        frames = f"{name} frames"
        arrays[f"{name}_count"] = Numbers("clips", low=1, high=100_000, dtype="int32")
        width = len(skeleton(name).channels)
        arrays[f"{name}_channels"] = Numbers(frames, width, low=-_MOST, high=_MOST, dtype="int16")
        arrays[f"{name}_roots"] = Numbers(frames, 7, low=-1e4, high=1e4, dtype="float32")
        arrays[f"{name}_stance"] = Flags(frames, 2)
    return arrays


MOTION_SET_FILE = Schema(
    kind="motion set",
    version=1,
    header=_MotionSetHeader,
    arrays=lambda header: _arrays(),
    remedy="record it again (surefoot record)",
    check=_check,
)


def load_motions(path: str | os.PathLike[str] = PERSON_MOTIONS) -> MotionSet:
    """Read a set; the package's own is read once. `LocomotionError` if the file is missing, cut off, of
    another version or another person."""
    return _package_motions() if path == PERSON_MOTIONS else _read(path)


@lru_cache(maxsize=1)
def _package_motions() -> MotionSet:
    return _read(PERSON_MOTIONS)


def _read(path: str | os.PathLike[str]) -> MotionSet:
    try:
        header, arrays = read_archive(path, MOTION_SET_FILE)
    except ArchiveError as error:
        raise LocomotionError(str(error)) from error
    levels = []
    for name in LEVELS:
        count = arrays[f"{name}_count"].astype(np.int64)
        roots = arrays[f"{name}_roots"].astype(np.float64)
        roots[:, 3:] /= np.linalg.norm(roots[:, 3:], axis=1, keepdims=True)
        channels = arrays[f"{name}_channels"] * ANGLE
        first = np.cumsum(count) - count
        levels.append(LevelFrames(first, count, channels, roots, arrays[f"{name}_stance"]))
    return MotionSet(header.clips, tuple(levels))
