"""Which bone of a character shows which part of the person: by a mapping, by VRM's table, or by its names."""

import os
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

from pydantic import Field, RootModel

from locomotion.body.person import BODY_NAMES
from locomotion.characters.character_file import Skeleton
from locomotion.characters.name_words import guessed_by_words
from locomotion.clips.retargeting import NEEDED_PARTS
from locomotion.data import CHARACTERS
from locomotion.errors import LocomotionError
from surefoot.files.yamlfile import FileError, nearest, read_yaml

__all__ = ["SHIPPED", "bones_of_parts", "load_bone_names"]

SHIPPED = ("mixamo", "vrm", "unreal", "surefoot")
"""Names of the mappings that are in the package."""
_Names = Annotated[list[str], Field(min_length=1)]


class _Mapping(RootModel[dict[str, str | _Names]]):
    """A bone's name, or several of which the first that there is counts, for each part of the person."""


def load_bone_names(mapping: str | os.PathLike[str]) -> dict[str, tuple[str, ...]]:
    """Read a mapping, a YAML file or one of `SHIPPED`: for each part of the person the names to look for.

    Raises `LocomotionError` for an unreadable file, unknown parts, and missing parts that must be mapped.
    """
    given = os.fspath(mapping)
    path = CHARACTERS / f"{given}.yaml" if given in SHIPPED else Path(given)
    if given not in SHIPPED and not path.suffix and not path.exists():
        hint = nearest(given, SHIPPED)
        raise LocomotionError(
            f"mapping {given!r}: {hint}give a YAML file, or one of {', '.join(SHIPPED)}, or None to guess"
        )
    try:
        file, located = read_yaml(path, _Mapping, "mapping of parts to bones")
        for part in file.root:
            if part not in BODY_NAMES:
                hint = nearest(part, BODY_NAMES)
                valid = ", ".join(BODY_NAMES)
                raise located.error(
                    [part], f"no part is called {part!r}; {hint}the parts are {valid}", at_key=True
                )
        missing = [part for part in NEEDED_PARTS if part not in file.root]
        if missing:
            raise located.error([], f"has no bone for {', '.join(missing)}")
    except FileError as error:
        raise LocomotionError(str(error)) from None
    return {part: (name,) if isinstance(name, str) else tuple(name) for part, name in file.root.items()}


def bones_of_parts(skeleton: Skeleton, mapping: str | os.PathLike[str] | None) -> dict[str, int]:
    """The bone that shows each part of the person.

    mapping: as for `load_bone_names`; None: VRM's table if the file has it, else the shipped mapping that
    finds most, else words in the bones' names. Raises `LocomotionError` that lists the parts without a bone
    and the names that were looked for, if a part is missing that must be mapped.
    """
    if mapping is not None:
        names = load_bone_names(mapping)
        found = _found(names, skeleton.names)
        _check(skeleton, found, names, f"mapping {os.fspath(mapping)!r}")
        return found
    if skeleton.humanoid:
        names = load_bone_names("vrm")
        found = {
            part: skeleton.humanoid[own[0]]
            for part, options in names.items()
            if (own := [name for name in options if name in skeleton.humanoid])
        }
        _check(skeleton, found, names, "its own table of VRM")
        return found
    tried = [(_found(load_bone_names(name), skeleton.names), name) for name in SHIPPED]
    tried.append((guessed_by_words(skeleton.names, skeleton.parents), ""))
    for found, _ in tried:
        if not set(NEEDED_PARTS) - set(found) and _hangs_wrong(skeleton, found) is None:
            return found
    best, name = max(tried[:-1], key=lambda each: len(each[0]))
    _check(skeleton, best, load_bone_names(name), f"mapping {name!r}, which fits best; name another")
    return best


def _found(names: Mapping[str, tuple[str, ...]], bones: tuple[str, ...]) -> dict[str, int]:
    """The bones with the names of a mapping. Prefixes that they share, capitals and marks do not matter."""
    exact = {name: b for b, name in reversed(list(enumerate(bones)))}
    if all(any(name in exact for name in names[part]) for part in NEEDED_PARTS):
        plain, bare = exact, lambda name: name
    else:
        bare = _bare
        plain = _without_prefix([_bare(name) for name in bones], [_bare(name) for name in names["pelvis"]])
    found = {}
    for part, options in names.items():
        there = [plain[bare(name)] for name in options if bare(name) in plain]
        if there:
            found[part] = there[0]
    return found


def _bare(name: str) -> str:
    """A name without its name space, capitals and marks."""
    return re.sub(r"[^a-z0-9]", "", re.sub(r"^.*[:|]", "", name).lower())


def _without_prefix(bones: list[str], pelvis: list[str]) -> dict[str, int]:
    """Bones by name without what stands before the name of the pelvis."""
    prefixes = {bone[: -len(end)] for bone in bones for end in pelvis if end and bone.endswith(end)}
    prefix = max(
        sorted(prefixes, key=len), key=lambda each: sum(bone.startswith(each) for bone in bones), default=""
    )
    found: dict[str, int] = {}
    for b, bone in enumerate(bones):
        if bone.startswith(prefix):
            found.setdefault(bone[len(prefix) :], b)
    return found


def _check(skeleton: Skeleton, found: dict[str, int], names: Mapping[str, tuple[str, ...]], of: str) -> None:
    missing = [part for part in NEEDED_PARTS if part not in found]
    if missing:
        looked = "; ".join(f"{part} ({' or '.join(names[part])})" for part in missing)
        has = ", ".join(skeleton.names[:40]) + (", ..." if len(skeleton.names) > 40 else "")
        raise LocomotionError(f"{skeleton.path}: by {of}, it has no bone for {looked}; its bones: {has}")
    twice = {b for b in found.values() if list(found.values()).count(b) > 1}
    if twice:
        b = min(twice)
        parts = " and ".join(part for part, bone in found.items() if bone == b)
        raise LocomotionError(f"{skeleton.path}: bone {skeleton.names[b]!r} cannot be {parts} at once")
    wrong = _hangs_wrong(skeleton, found)
    if wrong is not None:
        part, above = wrong
        raise LocomotionError(
            f"{skeleton.path}: bone {skeleton.names[found[part]]!r} ({part}) does not hang on"
            f" {skeleton.names[found[above]]!r} ({above}); check the mapping"
        )


def _hangs_wrong(skeleton: Skeleton, found: dict[str, int]) -> tuple[str, str] | None:
    """A part whose bone does not hang on the bone of the part that it belongs to, and that part."""
    for part, bone in found.items():
        side, _, kind = part.partition("_")
        own = {"chest": "pelvis", "head": "chest", "waist": "pelvis"}.get(part) or {
            "thigh": "pelvis", "shank": f"{side}_thigh", "foot": f"{side}_shank", "toes": f"{side}_foot",
            "clavicle": "chest", "upper_arm": "pelvis", "forearm": f"{side}_upper_arm",
            "hand": f"{side}_forearm",
        }.get(kind)  # fmt: skip
        if own is None or own not in found:
            continue
        above = int(skeleton.parents[bone])
        while above >= 0 and above != found[own]:
            above = int(skeleton.parents[above])
        if above < 0:
            return part, own
    return None
