"""The text of a BVH file, read and checked line by line.

A file consists of HIERARCHY, the nested joints, MOTION, the number of frames, the time between two frames,
and one row of numbers per frame: one for each channel of each joint, in the order of the joints.
Existing parsers (bvhio, bvh) do not name the line of an error and do not notice that a file is cut off.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from locomotion.errors import LocomotionError

__all__ = ["BvhFile", "read_bvh_file"]

_CHANNELS = [axis + kind for kind in ("position", "rotation") for axis in "XYZ"]
_MOST = 1e9  # of a length or an angle, in the file's unit: nothing real is as large
_CLOSEST, _FARTHEST = 1e-4, 1.0  # [s] between two frames
_LONGEST = 600.0  # [s] of a capture


@dataclass
class BvhFile:
    """What a file says, in its own units and axes.

    Attributes:
        names, parents, offsets: of the joints, parents before children; -1 is the parent of the root.
        channels: of each joint, such as "Zrotation", in the order in which they are applied.
        frame_time: [s]. frames: (n, c) float64, a column for each channel of each joint; angles in degrees.
    """

    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    offsets: list[list[float]] = field(default_factory=list)
    channels: list[list[str]] = field(default_factory=list)
    frame_time: float = 0.0
    frames: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 0)))


def read_bvh_file(path: Path) -> BvhFile:
    """Read a file.

    Raises `LocomotionError`, which names the line and what is expected there, if the file cannot be read, is
    not BVH or ends early; for unknown channels, numbers that are not finite, and rows with more or fewer
    numbers than there are channels; and for no frames, frames less than 0.1 ms or more than 1 s apart, or
    more than ten minutes of them.
    """
    lines, found = _Lines(path), BvhFile()
    words = lines.words("HIERARCHY")
    if words != ["HIERARCHY"]:
        raise lines.error(f"not a BVH file: it must begin with HIERARCHY, not {_shown(words)}")
    _read_joints(lines, found)
    if lines.words("MOTION") != ["MOTION"]:
        raise lines.error("expected MOTION: a file has one ROOT, and its last } closes it")
    columns = [
        f"{name} {channel}"
        for name, channels in zip(found.names, found.channels, strict=True)
        for channel in channels
    ]
    count = _read_times(lines, found)
    found.frames = np.empty((count, len(columns)))
    for frame in range(count):
        where = f"frame {frame + 1} of {count}"
        row = lines.words(where)
        if len(row) != len(columns):
            raise lines.error(f"{where} has {len(row)} numbers; its joints have {len(columns)} channels")
        found.frames[frame] = lines.numbers(row, [f"{column} in {where}" for column in columns])
    return found


class _Lines:
    """The lines of a file that are not blank, one after the other."""

    def __init__(self, path: Path) -> None:
        self._path, self._number = path, 1
        try:
            text = path.read_text()
        except OSError as error:
            raise LocomotionError(f"{path}: cannot be read: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise LocomotionError(f"{path}: not a BVH file: {error}") from error
        # splitlines would end lines at form feeds and some more, too
        self._rest: Iterator[tuple[int, str]] = iter(enumerate(text.split("\n"), 1))

    def words(self, expected: str) -> list[str]:
        """Words of the next line, at least one. Raises `LocomotionError` if the file ends here."""
        for number, line in self._rest:
            self._number = number
            if words := line.split():
                return words
        raise self.error(f"not a whole BVH file: it ends where {expected} is expected")

    def numbers(self, words: list[str], names: list[str]) -> list[float]:
        """The ``words`` of the line read last, as numbers; ``names`` says what each of them is."""
        numbers = []
        for word, name in zip(words, names, strict=True):
            number = _number(word)
            if number is None:
                raise self.error(f"{name}: expected a number of at most {_MOST:g}, not {_shown([word])}")
            numbers.append(number)
        return numbers

    def error(self, problem: str) -> LocomotionError:
        """The error ``problem`` in the line read last."""
        return LocomotionError(f"{self._path}:{self._number}: {problem}")


def _read_joints(lines: _Lines, found: BvhFile) -> None:
    words = lines.words("ROOT")
    if words[0] != "ROOT":
        raise lines.error(f"expected ROOT and a name, not {_shown(words)}")
    _read_joint(lines, words, found, -1)
    above = [0]  # joints that are not closed yet
    while above:
        words = lines.words("}")
        if words[0] == "JOINT":
            _read_joint(lines, words, found, above[-1])
            above.append(len(found.names) - 1)
        elif words[0] == "End":
            _opening(lines)
            _offset(lines, "End Site")
            if lines.words("}")[0] != "}":
                raise lines.error("expected the } of End Site")
        elif words[0] == "}":
            above.pop()
        else:
            raise lines.error(f"expected JOINT, End Site or }}, not {_shown(words)}")


def _read_joint(lines: _Lines, words: list[str], found: BvhFile, parent: int) -> None:
    """Read a joint, whose first line is ``words``, up to its channels."""
    if len(words) < 2:
        raise lines.error(f"expected a name after {words[0]}")
    name = words[1]
    _opening(lines)
    offset = _offset(lines, name)
    words = lines.words("CHANNELS")
    if words[0] != "CHANNELS" or words[1:2] != [str(len(words) - 2)]:
        raise lines.error(f"expected CHANNELS of {name!r}: how many, and as many names")
    channels = words[2:]
    for channel in channels:
        if channel not in _CHANNELS or channels.count(channel) > 1:
            what = "twice" if channel in _CHANNELS else "which is none"
            raise lines.error(
                f"{name!r} has the channel {_shown([channel])}, {what}; valid: {', '.join(_CHANNELS)}"
            )
    found.names.append(name)
    found.parents.append(parent)
    found.offsets.append(offset)
    found.channels.append(channels)


def _opening(lines: _Lines) -> None:
    if lines.words("{") != ["{"]:
        raise lines.error("expected a line with { alone")


def _offset(lines: _Lines, name: str) -> list[float]:
    words = lines.words("OFFSET")
    if words[0] != "OFFSET" or len(words) != 4:
        raise lines.error(f"expected OFFSET of {name!r} and three numbers")
    return lines.numbers(words[1:], [f"the OFFSET of {name}"] * 3)


def _read_times(lines: _Lines, found: BvhFile) -> int:
    """Read the two lines after MOTION; returns the number of frames."""
    words = lines.words("Frames:")
    count = _number(words[1]) if len(words) == 2 and words[0] == "Frames:" and words[1].isdecimal() else None
    if not count:
        raise lines.error("expected Frames: and how many frames there are, at least one")
    words = lines.words("Frame Time:")
    time = _number(words[2]) if len(words) == 3 and words[:2] == ["Frame", "Time:"] else None
    if time is None or not _CLOSEST <= time <= _FARTHEST:
        raise lines.error(
            f"expected Frame Time: and a number of seconds from {_CLOSEST:g} to {_FARTHEST:g},"
            f" not {_shown(words)}"
        )
    if (count - 1) * time > _LONGEST:
        raise lines.error(
            f"{count:.0f} frames of {time:g} s take {count * time / 60.0:.3g} minutes; a capture has at most"
            f" {_LONGEST / 60.0:g}"
        )
    found.frame_time = time
    return int(count)


def _number(word: str) -> float | None:
    """``word`` as a number; None if it is not one, not finite, or too large."""
    try:
        value = float(word)
    except ValueError:
        return None
    return value if abs(value) <= _MOST else None


def _shown(words: list[str]) -> str:
    text = " ".join(words)
    return repr(text if len(text) <= 40 else f"{text[:37]}...")
