"""Suite files: which levels are played, by whom, and how often. YAML.

```yaml
levels:
  - levels/courtyard.obj
  - {file: levels/dungeon.glb, name: dungeon, up: y, plan: levels/dungeon.night.yaml}
bodies: [walker, human]
seeds: [1, 2, 3]
bots: 64
seconds: 300
```

Files are relative to the suite's own.
"""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from annotated_types import Ge, Gt, Le, Len
from pydantic import BaseModel, BeforeValidator, ConfigDict

from navmesh.streaming.world_folder import INDEX
from runtime.bodies.registry import body_names
from runtime.missions.model import Name
from runtime.playtest.run import BODY, MOST_BOTS
from surefoot.files.choices import OneOf
from surefoot.files.yamlfile import read_yaml

__all__ = ["Cell", "Suite", "cells_of", "read_suite"]


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class SuiteLevel(_Strict):
    """A level of the suite."""

    file: str
    """A mesh file, or the folder of an open world."""
    name: Name | None = None
    """Of its row and its folder; by default the file's name."""
    up: Literal["y", "z"] | None = None
    """Up axis; by default as the file says, y for glTF, else z."""
    scale: Annotated[float, Gt(0.0), Le(1e6)] | None = None
    """Metres per unit."""
    plan: str | None = None
    """Playtest file; by default LEVEL.playtest.yaml where there is one."""


def _level(value: object) -> object:
    return {"file": value} if isinstance(value, str) else value


class Suite(_Strict):
    """The content of a suite file."""

    levels: Annotated[list[Annotated[SuiteLevel, BeforeValidator(_level)]], Len(1, 1000)]
    bodies: Annotated[list[Annotated[str, OneOf(body_names)]], Len(1, 20)] = [BODY]
    seeds: Annotated[list[Annotated[int, Ge(0), Le(2**31 - 1)]], Len(1, 100)] = [0]
    bots: Annotated[int, Ge(0), Le(MOST_BOTS)] = 64
    """For each level, body and seed."""
    seconds: Annotated[float, Gt(0.0), Le(86400.0)] = 300.0
    """[s] How long each bot plays."""


@dataclass(frozen=True)
class Cell:
    """One playtest of a suite: a ``level`` by name and file, a ``body``, a ``seed``."""

    level: str
    file: Path
    up: str | None
    scale: float | None
    plan: Path | None
    body: str
    seed: int

    @property
    def folder(self) -> Path:
        """Where its report lies, relative to the suite's."""
        return Path(self.level) / self.body / f"seed-{self.seed}"


def read_suite(path: str | os.PathLike[str]) -> Suite:
    """Read and check the suite at ``path``. Raises `surefoot.files.yamlfile.FileError`, also for a level or a
    plan that is not there, a name or value given twice."""
    suite, located = read_yaml(path, Suite, "suite of playtests")
    beside = Path(path).parent
    names: set[str] = set()
    for k, level in enumerate(suite.levels):
        for key, file in (("file", level.file), ("plan", level.plan)):
            if file is not None and not (beside / file).is_file() and not (beside / file / INDEX).is_file():
                raise located.error(("levels", k, key), f"levels[{k}].{key}: no such file: {beside / file}")
        name = _name(level)
        if name in names:
            raise located.error(("levels", k), f"levels[{k}]: a second {name!r}; give it a name of its own")
        names.add(name)
    for key in ("bodies", "seeds"):
        values = getattr(suite, key)
        for k, value in enumerate(values):
            if value in values[:k]:
                raise located.error((key, k), f"{key}[{k}]: {value!r} a second time")
    return suite


def cells_of(suite: Suite, path: str | os.PathLike[str]) -> list[Cell]:
    """The playtests of the ``suite`` that was read from ``path``, by level, body and seed."""
    beside = Path(path).parent
    return [
        Cell(
            _name(level), beside / level.file, level.up, level.scale,
            None if level.plan is None else beside / level.plan, body, seed,
        )
        for level in suite.levels
        for body in suite.bodies
        for seed in suite.seeds
    ]  # fmt: skip


def _name(level: SuiteLevel) -> str:
    return level.name or Path(level.file).stem
