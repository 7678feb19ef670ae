"""Only what changed: the joint angles that differ from those a figure was sent before.

A level keeps its motion at a rate of its own (60, 30, 15 Hz), and a figure of that level is told at that
rate: at the state nearest to each of the moments ``k / rate``, whatever the frame rate of the world is.
Angles are sent as whole multiples of a step that cannot be seen at the distance at which the level is used.
So a figure far away costs a fraction of one that is near, and one that stands still costs nothing::

    moment = moment_of(LOW, now)                   # the same until 1/15 s have passed
    angles = in_steps(LOW, channels)               # (c,) int16
    update = changes(sent, angles)                 # None if nothing changed
    packet = encoded(figure, update)               # bytes
"""

import math
import struct
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError
from locomotion.recorded.skeletons import LEVELS, skeleton

__all__ = ["STEPS", "Update", "applied", "changes", "decoded", "encoded", "in_steps", "moment_of"]

STEPS = (0.001, 0.004, 0.03)
"""[rad] of one step of an angle, by level: 1 mm at the end of an arm near by, 2 cm far away, where every
angle fits in a byte."""
_HEAD = struct.Struct("<IB")
_WIDE = 128


class Update(NamedTuple):
    """Channels that changed: ``indices`` (k,) uint8 and ``values`` (k,) int16, in `STEPS`."""

    indices: NDArray[np.uint8]
    values: NDArray[np.int16]


def moment_of(level: int, now: float) -> int:
    """The number of the moment nearest to ``now`` [s] at which a figure of ``level`` is to be told."""
    return math.floor(now * skeleton(LEVELS[level]).rate + 0.5)


def in_steps(level: int, channels: NDArray[np.float64]) -> NDArray[np.int16]:
    """Channels (..., c) [rad] in the steps of their level."""
    return np.round(channels / STEPS[level]).astype(np.int16)


def changes(before: NDArray[np.int16] | None, after: NDArray[np.int16]) -> Update | None:
    """What differs between two poses (c,) of a figure; all, if ``before`` is None; None if nothing does."""
    differs = np.ones(len(after), np.bool_) if before is None else before != after
    indices = np.flatnonzero(differs).astype(np.uint8)
    return Update(indices, after[indices]) if len(indices) else None


def applied(before: NDArray[np.int16], update: Update) -> NDArray[np.int16]:
    """``before`` (c,) with an update."""
    after = before.copy()
    after[update.indices] = update.values
    return after


def encoded(figure: int, update: Update) -> bytes:
    """An update as bytes, little-endian: the figure's number (uint32), how many channels (uint8), their
    indices (uint8 each) and values. These are int8 each if all of them fit, else int16, and 128 is added to
    the count."""
    count, wide = len(update.indices), bool((update.values != update.values.astype(np.int8)).any())
    values = update.values.astype("<i2" if wide else np.int8)
    return _HEAD.pack(figure, count + _WIDE * wide) + update.indices.tobytes() + values.tobytes()


def decoded(packet: bytes) -> tuple[int, Update]:
    """The figure's number and the update of a packet; `LocomotionError` if it is none."""
    if len(packet) < _HEAD.size:
        raise LocomotionError(f"a packet of {len(packet)} bytes, expected {_HEAD.size} or more")
    figure, count = _HEAD.unpack_from(packet)
    wide, count = count >= _WIDE, count % _WIDE
    wanted = _HEAD.size + (3 if wide else 2) * count
    if len(packet) != wanted:
        raise LocomotionError(f"a packet of {len(packet)} bytes for {count} channels, expected {wanted}")
    indices = np.frombuffer(packet, np.uint8, count, _HEAD.size)
    values = np.frombuffer(packet, "<i2" if wide else np.int8, count, _HEAD.size + count).astype(np.int16)
    return figure, Update(indices, values)
