"""A BVH file checked line by line before `bvhio` reads it, which names no lines and does not notice the end.

A file holds, a line each, HIERARCHY, the joints within each other, MOTION, the number of frames, their
distance in time, and a row of numbers per frame: one for each channel of each joint, in the joints' order.
"""

from collections.abc import Iterator
from pathlib import Path

from locomotion.errors import LocomotionError

__all__ = ["check_bvh"]

_CHANNELS = [axis + kind for kind in ("position", "rotation") for axis in "XYZ"]
_MOST = 1e9  # of a length or an angle, in the file's unit: far from what single precision holds
_CLOSEST, _FARTHEST = 1e-4, 1.0  # [s] between two frames
_LONGEST = 600.0  # [s] of a capture


def check_bvh(path: Path) -> None:
    """Raise `LocomotionError`, which names the line and what is expected there, for a file that cannot be
    read, is not BVH or ends early, has unknown channels, numbers that are not finite, rows that are shorter
    or longer than its channels need, no frames, frames nearer than 0.1 ms or farther than 1 s from each
    other, or more than ten minutes of them."""
    lines = _Lines(path)
    words = lines.words("HIERARCHY")
    if words != ["HIERARCHY"]:
        raise lines.error(f"not a BVH file: it must begin with HIERARCHY, not {_shown(words)}")
    channels = _joints(lines)
    if lines.words("MOTION") != ["MOTION"]:
        raise lines.error("expected MOTION: a file has one ROOT, and its last } closes it")
    count = _frames(lines)
    for frame in range(1, count + 1):
        where = f"frame {frame} of {count}"
        row = lines.words(where)
        if len(row) != len(channels):
            raise lines.error(f"{where} has {len(row)} numbers; its joints have {len(channels)} channels")
        if any(_number(word) is None for word in row):
            raise _not_a_number(lines, row, [f"{channel} in {where}" for channel in channels])


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
        # bvhio ends lines here too; splitlines would end them at form feeds and some more
        self._rest: Iterator[tuple[int, str]] = iter(enumerate(text.split("\n"), 1))

    def words(self, expected: str) -> list[str]:
        """Those of the next line, at least one; `LocomotionError` if the file ends instead."""
        for number, line in self._rest:
            self._number = number
            if words := line.split():
                return words
        raise self.error(f"not a whole BVH file: it ends where {expected} is expected")

    def error(self, problem: str) -> LocomotionError:
        """The error ``problem`` in the line that was read last."""
        return LocomotionError(f"{self._path}:{self._number}: {problem}")


def _joints(lines: _Lines) -> list[str]:
    """The channels of all joints, each with the name of its joint, in the order of a frame's numbers."""
    words = lines.words("ROOT")
    if words[0] != "ROOT":
        raise lines.error(f"expected ROOT and a name, not {_shown(words)}")
    channels = _joint(lines, words)
    depth = 1
    while depth:
        words = lines.words("}")
        if words[0] == "JOINT":
            channels += _joint(lines, words)
            depth += 1
        elif words[0] == "End":
            _opening(lines)
            _offset(lines, "End Site")
            if lines.words("}")[0] != "}":
                raise lines.error("expected the } of End Site")
        elif words[0] == "}":
            depth -= 1
        else:
            raise lines.error(f"expected JOINT, End Site or }}, not {_shown(words)}")
    return channels


def _joint(lines: _Lines, words: list[str]) -> list[str]:
    """The channels of the joint that ``words`` begin, each with its name; reads up to them."""
    if len(words) < 2:
        raise lines.error(f"expected a name after {words[0]}")
    name = words[1]
    _opening(lines)
    _offset(lines, name)
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
    return [f"{name} {channel}" for channel in channels]


def _opening(lines: _Lines) -> None:
    if lines.words("{") != ["{"]:
        raise lines.error("expected a line with { alone")


def _offset(lines: _Lines, name: str) -> None:
    words = lines.words("OFFSET")
    if words[0] != "OFFSET" or len(words) != 4:
        raise lines.error(f"expected OFFSET of {name!r} and three numbers")
    if any(_number(word) is None for word in words[1:]):
        raise _not_a_number(lines, words[1:], [f"the OFFSET of {name}"] * 3)


def _frames(lines: _Lines) -> int:
    """How many frames there are; reads the two lines after MOTION."""
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
    return int(count)


def _number(word: str) -> float | None:
    """The number that ``word`` says, unless it says none, or one that is not finite or too great."""
    try:
        value = float(word)
    except ValueError:
        return None
    return value if abs(value) <= _MOST else None


def _not_a_number(lines: _Lines, words: list[str], names: list[str]) -> LocomotionError:
    """The error of the first of ``words`` that says no number; ``names`` tell what each of them is."""
    word, name = next(pair for pair in zip(words, names, strict=True) if _number(pair[0]) is None)
    return lines.error(f"{name}: expected a number of at most {_MOST:g}, not {_shown([word])}")


def _shown(words: list[str]) -> str:
    text = " ".join(words)
    return repr(text if len(text) <= 40 else f"{text[:37]}...")
