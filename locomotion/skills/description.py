"""Skills that are described by a file: a jump over obstacles of a kind, by a clip, the sizes to learn, an
objective and what was learned. How to make one is in docs/guides/own-skills.md.

    skill = load_described("leap.yaml", load_run_skill())
    human = Human(ground, clearing=[*learned_skills(run), skill])
"""

import os
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from locomotion.clips.clip import Clip, load_clip
from locomotion.errors import LocomotionError
from locomotion.gaits.run.skill import RunSkill
from locomotion.skills.interface import ClearingSkill
from locomotion.skills.jump.skill import Jump, load_jump_skill, run_digest
from navmesh.obstacles.kinds import obstacle_kinds
from surefoot.files.choices import OneOf
from surefoot.files.yamlfile import FileError, read_yaml

__all__ = ["SkillDescription", "load_described", "load_description"]


def _increase(sizes: list[float]) -> list[float]:
    if any(later <= earlier for earlier, later in pairwise(sizes)):
        raise ValueError("sizes must increase")
    return sizes


def _jumped() -> list[str]:
    """The kinds that a jump may clear: all but those that one has to get over something tall to clear."""
    return [kind.affordance for kind in obstacle_kinds() if kind.crossing != "over"]


_Size = Annotated[float, Field(gt=0.0, le=10.0)]
_Pace = Annotated[float, Field(gt=0.0, le=2.0)]


class SkillDescription(BaseModel):
    """What a description says; paths are relative to its file.

    name: what commands and files call it. affordance: the kind of obstacle that it clears. sizes: heights [m]
    (for a gap, widths) that are learned one after the other. least: [m] down to which what is learned first
    serves; None: the first of the sizes. entry: speed [m/s] of the last step before it. clip: what is played
    over take-off and landing. objective: weights of terms of `locomotion.training.skills.jump_kind.WEIGHTS`
    that are to differ from those. learned: what `surefoot train` writes.

    Where learning starts: marks: distances [m] from the edge at which the take-off step begins and the
    take-off foot stands. pace: of the four steps relative to the run's. share: of the clip, the rest is the
    run's.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: Annotated[str, Field(pattern=r"^[a-z][a-z0-9-]*$")]
    affordance: Annotated[str, OneOf(_jumped)]
    sizes: Annotated[list[_Size], Field(min_length=1), AfterValidator(_increase)]
    least: _Size | None = None
    entry: Annotated[float, Field(ge=1.0, le=6.0)] = 3.3
    marks: tuple[_Size, _Size] = (1.95, 0.95)
    pace: tuple[_Pace, _Pace, _Pace, _Pace] = (1.0, 0.75, 1.0, 1.0)
    share: Annotated[float, Field(ge=0.0, le=1.0)] = 1.0
    clip: Path
    objective: dict[str, Annotated[float, Field(ge=0.0)]] = {}
    learned: Path

    @property
    def heights(self) -> tuple[float, float]:
        """Least and greatest size [m] that it will clear."""
        return self.sizes[0] if self.least is None else self.least, self.sizes[-1]

    @property
    def kind(self) -> str:
        """What its learned file says that it is."""
        return f"{self.name} skill"

    def load_clip(self) -> Clip:
        """What is played."""
        return load_clip(self.clip)

    def content(self, clip: Clip) -> dict[str, Any]:
        """What it says, with the content of its ``clip`` and without where files lie; to be written as
        JSON."""
        return {**self.model_dump(mode="json", exclude={"clip", "learned"}), "clip": clip.digest}


def load_description(path: str | os.PathLike[str]) -> SkillDescription:
    """Read and check a description; `LocomotionError` names the file, line and column, and what would be
    right."""
    try:
        description, located = read_yaml(path, SkillDescription, "skill's description")
        if description.least is not None and description.least > description.sizes[0]:
            first = f"the first of the sizes, {description.sizes[0]:g} m"
            raise located.error(["least"], f"least: {description.least:g} m is above {first}")
        clip, learned = (Path(path).parent / each for each in (description.clip, description.learned))
        for taken, what in ((clip, "the clip"), (Path(path), "this file")):
            if learned.resolve() == taken.resolve():
                other = "name another file, which learning writes"
                raise located.error(["learned"], f"learned: {str(description.learned)!r} is {what}; {other}")
    except FileError as error:
        raise LocomotionError(str(error)) from None
    return description.model_copy(update={"clip": clip, "learned": learned})


def load_described(path: str | os.PathLike[str], run: RunSkill) -> ClearingSkill:
    """A described skill that has been learned, on top of ``run``. `LocomotionError` if something is wrong
    with its files, or it was learned as its description or clip said something else."""
    description = load_description(path)
    learned, clip = load_jump_skill(description.learned, description.kind), description.load_clip()
    said, says = learned.meta.get("description"), description.content(clip)
    if said is not None and said != says:  # files of earlier releases do not tell
        different = [key for key in {**says, **said} if says.get(key) != said.get(key)]
        raise LocomotionError(
            f"{description.learned}: learned when {path} said something else ({', '.join(different)}); learn "
            f"it anew (surefoot train {path})"
        )
    if learned.run != run_digest(run):
        raise LocomotionError(
            f"{description.learned}: learned on another run than the one that is to carry it; learn it anew "
            f"(surefoot train {path})"
        )
    return Jump(learned, run, description.affordance, clip)
