"""Bones by the words in their names, for skeletons that follow none of the usual schemes.

"DEF-thigh.L", "Bip01 L UpperArm", "lowerleg_right": a side and a word for the part.
"""

import re
from collections.abc import Sequence

import numpy as np

__all__ = ["guessed_by_words"]

_WORDS = {
    "thigh": ("thigh", "upleg", "upperleg", "legupper"),
    "shank": ("shin", "calf", "lowerleg", "leglower", "shank", "crus"),
    "foot": ("foot", "ankle"),
    "toes": ("toes", "toe", "toebase", "ball"),
    "clavicle": ("clavicle", "collar", "collarbone", "shoulder"),
    "upper_arm": ("upperarm", "armupper", "uparm", "humerus", "bicep"),
    "forearm": ("forearm", "lowerarm", "armlower"),
    "hand": ("hand", "wrist"),
    "pelvis": ("pelvis", "hips", "hip"),
    "head": ("head",),
}
"""Words for each part, the likeliest first."""
_SHORT = {"shank": ("leg", "knee"), "upper_arm": ("arm",), "thigh": ("hip",), "forearm": ("elbow",)}
"""Words that mean the part only if no better one is there."""
_SIDES = {"l": "left", "left": "left", "r": "right", "right": "right"}
_FIRST = re.compile(r"^(l|left|r|right)(?=[A-Z])")
_EMPTY = ("def", "bip", "bone", "jnt", "joint", "b")
_MIDDLE = ("pelvis", "head")
_PIECES = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")


def guessed_by_words(names: Sequence[str], parents: np.ndarray) -> dict[str, int]:
    """The bones (by number) that the names suggest for the parts of the person; ``parents`` (b,) of each. The
    chest is the bone on which both arms hang."""
    split = [_side_and_words(name) for name in names]
    depth = _depths(parents)
    found: dict[str, int] = {}
    for side in ("", "right", "left"):
        for part, words in _WORDS.items():
            if (part in _MIDDLE) != (side == ""):
                continue
            for word in (*words, *_SHORT.get(part, ())):
                own = [b for b, (s, w) in enumerate(split) if s == side and w == word]
                own = [b for b in own if b not in found.values()]
                if own:
                    found[f"{side}_{part}" if side else part] = min(own, key=lambda b: depth[b])
                    break
    arms = [found[f"{side}_upper_arm"] for side in ("right", "left") if f"{side}_upper_arm" in found]
    if len(arms) == 2:
        first = _up_from(arms[0], parents)
        shared = [b for b in first if b in set(_up_from(arms[1], parents))]
        if shared and shared[0] not in found.values():
            found["chest"] = shared[0]
    return found


def _side_and_words(name: str) -> tuple[str, str]:
    """A bone's side ("" for none) and its other words in one, without numbers and name space."""
    bare = re.sub(r"^.*[:|]", "", name)
    bare = _FIRST.sub(lambda m: m.group(1) + "_", bare)
    pieces = [piece.lower() for piece in _PIECES.findall(bare)]
    sides = [_SIDES[piece] for piece in pieces if piece in _SIDES]
    left = [piece for piece in pieces if piece not in _SIDES and piece not in _EMPTY]
    for word in ("left", "right"):  # leftupperarm, without a mark between
        if not sides and len(left) == 1 and left[0].startswith(word):
            sides, left = [word], [left[0][len(word) :]]
    return (sides[0] if len(sides) == 1 else ""), "".join(left)


def _depths(parents: np.ndarray) -> list[int]:
    depths: list[int] = []
    for parent in parents:
        depths.append(0 if parent < 0 else depths[parent] + 1)
    return depths


def _up_from(bone: int, parents: np.ndarray) -> list[int]:
    """A bone's ancestors, the nearest first."""
    found = []
    above = int(parents[bone])
    while above >= 0:
        found.append(above)
        above = int(parents[above])
    return found
