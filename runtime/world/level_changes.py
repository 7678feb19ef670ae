"""Changes of a level that were asked for and have not been taken yet.

They are worked out one after the other, and taken at ticks of the world that were fixed when they were asked
for. So a run is the same on any machine.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import navmesh
from navmesh.level.chunks import check_changes
from runtime.errors import RuntimeInputError
from runtime.planning.level import Level
from runtime.world.upcoming import Upcoming

__all__ = ["ComingChange", "LevelChanges", "SavedMesh"]

_Chunks = Mapping[str, navmesh.Terrain | None]


class SavedMesh(NamedTuple):
    """The fields of a `navmesh.Terrain` of these names."""

    vertices: NDArray[np.float64]
    faces: Any
    materials: tuple[str, ...]
    face_material: Any


@dataclass(frozen=True)
class ComingChange:
    """What `World.save` keeps of a change: it comes before the tick of the number ``due``. ``chunks``: by
    name, the mesh to be put there, or None for a chunk to be removed."""

    due: int
    chunks: dict[str, SavedMesh | None]


class _Coming(NamedTuple):
    due: int
    changes: dict[str, navmesh.Terrain | None]


class LevelChanges:
    """Those of a world. ``next_level(level, changes)`` works one out, in a thread."""

    def __init__(self, next_level: Callable[[Level, _Chunks], Level]) -> None:
        self._upcoming: Upcoming[Level, _Chunks] = Upcoming(next_level)
        self._coming: list[_Coming] = []

    def check(self, level: Level, changes: _Chunks) -> None:
        """Raises `navmesh.NavmeshError` for ``changes`` of what is no chunk, for the removal of one that will
        not be there when all others have been taken, and when none is left. ``level``: as it is now."""
        terrain = level.graph.terrain
        names = [chunk.name for chunk in terrain.chunks]
        for each in self._coming:
            names = check_changes(names, each.changes, terrain.name)
        check_changes(names, changes, terrain.name)

    def begin(self, level: Level, changes: _Chunks, due: int) -> None:
        """Begin ``changes`` to be taken before the tick ``due``, on top of those that have begun, which are
        taken by then, too. ``level``: as it is now. Raises as `check`."""
        self.check(level, changes)
        self._coming = [each._replace(due=min(each.due, due)) for each in self._coming]
        self._coming.append(_Coming(due, dict(changes)))
        self._upcoming.begin(Level(level.graph, level.ground), self._coming[-1].changes)

    def due(self, tick: float) -> bool:
        """Whether one is to be taken before this ``tick``."""
        return bool(self._coming) and self._coming[0].due <= tick

    def end(self) -> Level:
        """The level after the first of them. Raises `navmesh.NavmeshError` if it cannot be made, such as
        where nothing walkable is left; that change is dropped."""
        changes = self._coming.pop(0).changes
        try:
            return self._upcoming.end()
        except navmesh.NavmeshError as error:
            names = ", ".join(map(repr, changes))
            raise navmesh.NavmeshError(
                f"the change of {names}, asked for before, is not made: {error}"
            ) from error

    def drop(self) -> None:
        """Forget all of them."""
        self._coming = []
        self._upcoming.drop()

    def digest(self) -> tuple:
        """What tells them from others."""
        return tuple(
            (each.due, [(name, None if mesh is None else mesh.digest) for name, mesh in each.changes.items()])
            for each in self._coming
        )

    def save(self) -> tuple[ComingChange, ...]:
        """All of them."""
        return tuple(
            ComingChange(each.due, {name: _saved(mesh) for name, mesh in each.changes.items()})
            for each in self._coming
        )

    def load(self, level: Level, coming: tuple[ComingChange, ...], tick: int) -> None:
        """Begin anew those that `save` gave at a ``tick``, and forget all others. Raises `RuntimeInputError`
        and `navmesh.NavmeshError` for what it cannot have given."""
        self.drop()
        for each in coming:
            if each.due < tick:
                raise RuntimeInputError(f"a change of the level was due at tick {each.due}")
            self.begin(level, {name: _mesh(name, saved) for name, saved in each.chunks.items()}, each.due)


def _saved(mesh: navmesh.Terrain | None) -> SavedMesh | None:
    if mesh is None:
        return None
    return SavedMesh(mesh.vertices, mesh.faces, mesh.materials, mesh.face_material)


def _mesh(name: str, saved: SavedMesh | None) -> navmesh.Terrain | None:
    if saved is None:
        return None
    materials = np.array(saved.materials)[saved.face_material] if saved.materials else None
    return navmesh.Terrain.from_arrays(saved.vertices, saved.faces, name=name, materials=materials)
