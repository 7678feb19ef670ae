"""Random floors of rooms with doors, to try what blocks and opens them."""

from typing import NamedTuple, cast

import numpy as np
import trimesh

from navmesh import Terrain

__all__ = ["Apartment", "apartment", "with_walls"]

_HEIGHT = 2.5  # [m] of walls
_THICK = (0.05, 0.4)  # [m] of walls
_WIDE = (0.7, 2.4)  # [m] of doorways


class Apartment(NamedTuple):
    """A floor of rooms."""

    terrain: Terrain
    doors: dict[str, np.ndarray]
    """Outlines (4, 3) [m] of the doorways, of walls that are turned as the whole floor is."""


def apartment(rooms: int, seed: int) -> Apartment:
    """``rooms`` x ``rooms`` rooms with a doorway in most walls between them, some of two wings, and
    pillars."""
    rng = np.random.default_rng(seed)
    lines = [np.concatenate([[0.0], np.cumsum(rng.uniform(3.0, 7.0, rooms))]) for _ in range(2)]
    boxes, doors = [], {}
    for axis in range(2):
        for i in range(rooms + 1):
            for j in range(rooms):
                thick = rng.uniform(*_THICK)
                at = lines[axis][i] + np.array([-0.5, 0.5]) * thick
                low, high = lines[1 - axis][j : j + 2]
                if i in (0, rooms) or rng.random() < 0.15:
                    boxes.append(_upright(axis, at, (low, high)))
                    continue
                wide = min(rng.uniform(*_WIDE), 0.8 * (high - low))
                begin = rng.uniform(low + 0.1, high - 0.1 - wide)
                boxes.append(_upright(axis, at, (low, begin)))
                boxes.append(_upright(axis, at, (begin + wide, high)))
                wings = 2 if wide > 1.4 and rng.random() < 0.5 else 1
                for k in range(wings):
                    along = begin + np.array([k, k + 1]) * wide / wings
                    x, y = (at, along) if axis == 0 else (along, at)
                    doors[f"door {len(doors)}"] = np.array(
                        [(x[0], y[0], 0.0), (x[1], y[0], 0.0), (x[1], y[1], 0.0), (x[0], y[1], 0.0)]
                    )
    far = lines[0][-1], lines[1][-1]
    for _ in range(rooms * rooms):
        x, y = rng.uniform(0.5, far[0] - 0.5), rng.uniform(0.5, far[1] - 0.5)
        side = rng.uniform(0.1, 0.6)
        boxes.append(((x, y, 0.0), (x + side, y + side, rng.uniform(0.6, _HEIGHT))))
    parts = [trimesh.creation.box(bounds=np.array(each)) for each in boxes]
    parts.append(
        trimesh.Trimesh(
            [(0, 0, 0), (far[0], 0, 0), (far[0], far[1], 0), (0, far[1], 0)], [(0, 1, 2), (0, 2, 3)]
        )
    )
    mesh = cast(trimesh.Trimesh, trimesh.util.concatenate(parts))
    turn = trimesh.transformations.rotation_matrix(rng.uniform(0.0, 2.0 * np.pi), (0, 0, 1))
    mesh.apply_transform(turn)
    doors = {name: outline @ turn[:3, :3].T for name, outline in doors.items()}
    return Apartment(
        Terrain.from_arrays(np.array(mesh.vertices), np.array(mesh.faces), name=f"apartment {seed}"), doors
    )


def _upright(axis: int, across: np.ndarray, along: tuple[float, float]) -> tuple:
    """The box of a wall at right angles to the ``axis``."""
    low, high = (across[0], along[0]), (across[1], along[1])
    if axis == 1:
        low, high = low[::-1], high[::-1]
    return (*low, 0.0), (*high, _HEIGHT)


def with_walls(terrain: Terrain, outlines: list[np.ndarray]) -> Terrain:
    """The level with upright sheets along ``outlines`` (k, 3) [m], as if they were blocked for ever."""
    vertices, faces = [terrain.vertices], [terrain.faces]
    count = len(terrain.vertices)
    for outline in outlines:
        size = len(outline)
        vertices += [outline, outline + np.array((0.0, 0.0, _HEIGHT))]
        for i in range(size):
            a, b = count + i, count + (i + 1) % size
            faces.append(np.array([(a, b, b + size), (a, b + size, a + size)]))
        count += 2 * size
    return Terrain.from_arrays(np.concatenate(vertices), np.concatenate(faces), name=terrain.name)
