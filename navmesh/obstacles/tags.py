"""What a level's author says about its obstacles: additions, changes and removals, in a file beside it.

For ``level.obj`` the file is ``level.tags.yaml``. Places are in world coordinates (metres, Z up, whatever the
mesh file's axes). A detected obstacle is referred to by a place near the middle of its edge, or by its tag:

```yaml
version: 1
add:
  - name: fountain
    affordance: vault
    position: [31.0, 12.0, 0.8]    # middle of the near edge, on top
    run_towards_deg: 90            # heading of the run: 0 is +x, 90 is +y
    height: 0.8
    depth: 0.4
    width: 3.0
change:
  - at: [25.0, 3.4, 0.3]
    set: {name: first platform, width: 4.0}
remove:
  - at: [42.0, 27.0, 0.0]
    affordance: gap
  - tag: drop@57.0,19.8,1.0/180
```
"""

import os
from pathlib import Path
from typing import Annotated, Literal, Self

import yaml
from annotated_types import Ge, Gt, Le, Len
from pydantic import AfterValidator, BaseModel, ConfigDict, StringConstraints, model_validator

from navmesh.obstacles.kinds import affordances, kind_of
from surefoot.files.atomic_write import whole_file
from surefoot.files.choices import OneOf

__all__ = ["Addition", "Change", "NewValues", "Reference", "Tags", "save_tags", "tags_path"]

Affordance = Annotated[str, OneOf(affordances)]


def _coordinate(value: float) -> float:
    if not abs(value) <= 1e9:
        raise ValueError("a coordinate is within ±1e9 m")
    return value


Point = Annotated[list[Annotated[float, AfterValidator(_coordinate)]], Len(3, 3)]
Name = Annotated[str, StringConstraints(min_length=1, max_length=64, pattern=r"^\S(.*\S)?$")]
Length = Annotated[float, Ge(0.0), Le(100.0)]
Size = Annotated[float, Gt(0.0), Le(100.0)]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class Addition(_Strict):
    """An obstacle that detection does not find."""

    name: Name
    """Its tag; no other obstacle of the level has the same."""
    affordance: Affordance
    position: Point
    """Middle of the edge nearest the run-up side, at its top [m]."""
    run_towards_deg: Annotated[float, Ge(-360.0), Le(360.0)]
    """Heading of the run towards the obstacle: 0 is +x, 90 is +y."""
    width: Size
    """Usable length of the edge [m]."""
    height: Annotated[float, Ge(-10.0), Le(10.0)] | None = None
    """As `Obstacles.height` [m]; 0 for a gap if left out."""
    depth: Length | None = None
    """Thickness of a vault, width of a gap [m]; left out for a jump and a drop."""
    run_up: Length | None = None
    """Free length before it [m]; measured on the surface if left out."""
    landing: Length | None = None
    """Free length behind it [m]; measured on the surface if left out."""

    @model_validator(mode="after")
    def _is_whole(self) -> Self:
        kind = kind_of(self.affordance)
        tall = kind.measure == "height"
        if tall and not self.height:
            raise ValueError(f"a {self.affordance} needs height, above 0 [m]")
        if kind.has_depth and not self.depth:
            raise ValueError(f"a {self.affordance} needs depth, above 0 [m]")
        if tall and self.height is not None and self.height <= 0:
            raise ValueError(f"the height of a {self.affordance} is above 0 [m]")
        if not kind.has_depth and self.depth is not None:
            raise ValueError(f"a {self.affordance} has no depth of its own; leave it out")
        return self


class Reference(_Strict):
    """A detected obstacle: by ``at`` (a place near the middle of its edge) or by ``tag``."""

    at: Point | None = None
    within: Annotated[float, Gt(0.0), Le(100.0)] = 0.5
    """Greatest distance from ``at`` to the obstacle's position [m]."""
    affordance: Affordance | None = None
    """Narrows ``at`` down where several obstacles share an edge."""
    tag: Name | None = None

    @model_validator(mode="after")
    def _points_somewhere(self) -> Self:
        if (self.at is None) == (self.tag is None):
            raise ValueError("needs either at: [x, y, z] or tag: name")
        return self


class NewValues(_Strict):
    """What to change in an obstacle; see `Obstacles`."""

    name: Name | None = None
    height: Annotated[float, Ge(-10.0), Le(10.0)] | None = None
    depth: Length | None = None
    width: Size | None = None
    run_up: Length | None = None
    landing: Length | None = None

    @model_validator(mode="after")
    def _says_something(self) -> Self:
        if not self.model_dump(exclude_none=True):
            raise ValueError(f"changes nothing; valid: {', '.join(type(self).model_fields)}")
        return self


class Change(Reference):
    """New values for a detected obstacle."""

    set: NewValues


class Tags(_Strict):
    """The content of a tag file."""

    version: Literal[1] = 1
    add: list[Addition] = []
    change: list[Change] = []
    remove: list[Reference] = []


def tags_path(level: str | os.PathLike[str]) -> Path:
    """Where the tags of a level's mesh file are: next to it, as level.tags.yaml."""
    return Path(level).with_suffix(".tags.yaml")


def save_tags(path: str | os.PathLike[str], tags: Tags) -> None:
    """Write a tag file that `load_tags` reads; the file appears whole or not at all."""
    target = Path(path)
    content = tags.model_dump(exclude_defaults=True)
    text = yaml.safe_dump({"version": tags.version, **content}, sort_keys=False, allow_unicode=True)
    with whole_file(target) as temporary:
        temporary.write_text(text, encoding="utf-8")
