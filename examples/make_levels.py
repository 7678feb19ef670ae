"""Makes the level of our own: ``examples/levels/courtyard.obj`` (metres, **Z up**).

    python examples/make_levels.py [folder]

A walled yard of 60 x 40 m (x to the east, y to the north). The southern half is a parkour course: three
parallel lanes that are walked as a serpent, each a storey step higher than the one before. Each platform
spans its lane from wall to wall, so that whoever wants to get on has to jump:

| platform | rise [m] | floor, before and on top [m] | middle of the edge | run to | run-up [m] | on top [m] |
| -------- | -------- | ---------------------------- | ------------------ | ------ | ---------- | ---------- |
| lane 1   | 0.3      | 0.0, 0.3                     | (25, 3.4)          | +x     | 24.6       | 34.6       |
| lane 2   | 0.4      | 0.3, 0.7                     | (34, 9.6)          | -x     | 25.6       | 29.2       |
| lane 3   | 0.5      | 0.7, 1.2                     | (30, 15.8)         | +x     | 25.2       | 29.6       |

Way of the course: yard (z = 0) - corridor along the west wall (x 0.4-4.4), through a doorway of 1.2 m at
(2.4, 19) - lane 1 eastward - round its east end - lane 2 westward - round its west end - lane 3 eastward -
down into the yard by the drop of 1.2 m at (52, 19.2) or the ramp of 13.5 degrees at (58.3, 19.2-24.2).
A good start for a mission is (2.4, 26, 0) in the yard; (1.5, 3.4, 0) is the head of lane 1.

In the yard (y 19.2-39.6, z = 0):

| what | where |
| ---- | ----- |
| mound, 0.9 m high, at most 14.4 degrees | centre (14, 28), radius 5.5 |
| wall with doorways of 0.7, 0.9, 1.2, 2.0 m, lintels at 2.2 m | x 24-24.3, y = 21.5, 24.5, 28.6, 33 |
| stage, 0.45 m high | x 27-33, y 25-33 |
| wall to vault, 0.8 m high, 0.3 m thick | x 36-36.3, y 23-31 |
| hedge to vault, 0.9 m high, 0.5 m thick | x 46-51, y 30-30.5 |
| trench to leap, 1.6 m wide, 2.5 m deep | x 42-43.6, y 21-33 |
| walkway of the second storey at z = 3, with a parapet and a gap of 1.5 m at x 20-21.5 | x 12-40, y 36-39.6 |
| ramp to the walkway, 14 degrees | x 40-52, y 36-39.6 |
| pillars, 0.6 x 0.6 m | several |

The mesh is one conforming skin: no overlapping solids, no cracks, no T-junctions.
"""

import itertools
import sys
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import trimesh

Corners = tuple[float, float, float, float]  # heights at (x0, y0), (x1, y0), (x1, y1), (x0, y1)


class Yard:
    """Solids over a rectilinear grid: in each cell a ground with four corner heights, and slabs above it."""

    def __init__(self, x: Iterable[float], y: Iterable[float]) -> None:
        self.x = np.array(sorted(set(x)))
        self.y = np.array(sorted(set(y)))
        shape = (len(self.x) - 1, len(self.y) - 1)
        self.ground = np.zeros((*shape, 4))
        self.slabs: dict[tuple[int, int], list[tuple[float, float]]] = {}

    def cells(self, x0: float, x1: float, y0: float, y1: float) -> list[tuple[int, int]]:
        """The cells of a rectangle whose sides are grid lines."""
        for value, lines in ((x0, self.x), (x1, self.x), (y0, self.y), (y1, self.y)):
            if value not in lines:
                raise ValueError(f"{value} is not a grid line")
        columns = range(int(np.searchsorted(self.x, x0)), int(np.searchsorted(self.x, x1)))
        rows = range(int(np.searchsorted(self.y, y0)), int(np.searchsorted(self.y, y1)))
        return [(i, j) for i in columns for j in rows]

    def corners(self, i: int, j: int) -> np.ndarray:
        """(4, 2) x and y of a cell's corners, counter-clockwise."""
        (x0, x1), (y0, y1) = self.x[i : i + 2], self.y[j : j + 2]
        return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])

    def raise_ground(self, x0: float, x1: float, y0: float, y1: float, height) -> None:
        """Set the ground of a rectangle: a number, or a function of x and y (arrays) [m]."""
        for i, j in self.cells(x0, x1, y0, y1):
            xy = self.corners(i, j)
            self.ground[i, j] = height(xy[:, 0], xy[:, 1]) if callable(height) else height

    def slab(self, x0: float, x1: float, y0: float, y1: float, bottom: float, top: float) -> None:
        """Hang a slab over the ground of a rectangle; slabs of one cell may not overlap."""
        for cell in self.cells(x0, x1, y0, y1):
            self.slabs.setdefault(cell, []).append((bottom, top))

    def solids(self, i: int, j: int) -> list[tuple[Corners | None, Corners]]:
        """(bottom, top) of every solid of a cell; the ground has no bottom. Outside the yard: ground at 0."""
        if not (0 <= i < len(self.x) - 1 and 0 <= j < len(self.y) - 1):
            return [(None, (0.0, 0.0, 0.0, 0.0))]
        a, b, c, d = (float(v) for v in self.ground[i, j])
        above = [((z0,) * 4, (z1,) * 4) for z0, z1 in self.slabs.get((i, j), [])]
        return [(None, (a, b, c, d)), *above]

    def mesh(self) -> trimesh.Trimesh:
        """The skin of the solids, one vertex per corner, no cracks and no T-junctions."""
        level: list[list[np.ndarray]] = []  # quads
        upright: list[tuple[np.ndarray, np.ndarray]] = []  # left and right end, each (bottom, top) (2, 3)
        for i in range(len(self.x)):
            for j in range(len(self.y)):
                if i < len(self.x) - 1 and j < len(self.y) - 1:
                    xy = self.corners(i, j)
                    for bottom, top in self.solids(i, j):
                        level.append(list(np.column_stack((xy, top))))
                        if bottom is not None:
                            level.append(list(np.column_stack((xy, bottom)))[::-1])
                if j < len(self.y) - 1:  # the border between (i - 1, j) and (i, j), seen from the west
                    line = np.array([(self.x[i], self.y[j]), (self.x[i], self.y[j + 1])])
                    upright += _border(line, self.solids(i - 1, j), (1, 2), self.solids(i, j), (0, 3))
                if i < len(self.x) - 1:  # the border between (i, j - 1) and (i, j), seen from the south
                    line = np.array([(self.x[i + 1], self.y[j]), (self.x[i], self.y[j])])
                    upright += _border(line, self.solids(i, j - 1), (2, 3), self.solids(i, j), (1, 0))
        return _skin(level, upright)


def _border(line, before, before_ends, after, after_ends) -> list[tuple[np.ndarray, np.ndarray]]:
    """The upright faces on the border of two cells, the first of the pair being the left end for a
    viewer outside the solid. ``line`` (2, 2) runs from the right to the left as seen from ``before``."""
    profiles: list[tuple[float, float]] = []
    spans = []
    for solids, (p, q) in ((before, before_ends), (after, after_ends)):
        own = []
        for bottom, top in solids:
            low = (-np.inf, -np.inf) if bottom is None else (bottom[p], bottom[q])
            high = (top[p], top[q])
            own.append((low, high))
            profiles += [low, high]
        spans.append(own)
    order = sorted(set(profiles), key=sum)
    faces = []
    for low, high in itertools.pairwise(order):
        middle = (sum(low) + sum(high)) / 4
        if not np.isfinite(middle):
            continue
        solid = [any(sum(b) / 2 < middle < sum(t) / 2 for b, t in own) for own in spans]
        if solid[0] == solid[1]:
            continue
        ends = [np.array([(*xy, low[k]), (*xy, high[k])]) for k, xy in enumerate(line)]
        faces.append((ends[0], ends[1]) if solid[0] else (ends[1], ends[0]))
    return faces


def _skin(level, upright) -> trimesh.Trimesh:
    """Weld quads and upright faces; upright faces take up every vertex that lies on their ends."""
    stack: dict[tuple[float, float], set[float]] = {}
    corners = [point for quad in level for point in quad]
    corners += [point for face in upright for end in face for point in end]
    for x, y, z in corners:
        stack.setdefault((x, y), set()).add(round(float(z), 9))
    triangles = [(q[a], q[b], q[c]) for q in level for a, b, c in ((0, 1, 2), (0, 2, 3))]
    for left, right in upright:
        chains = []
        for low, high in (left, right):
            x, y = low[:2]
            heights = sorted(z for z in stack[x, y] if low[2] - 1e-9 <= z <= high[2] + 1e-9)
            chains.append([np.array((x, y, z)) for z in heights])
        a, b = chains
        while len(a) > 1 or len(b) > 1:  # zip the two ends together, the lower end first
            if len(b) == 1 or (len(a) > 1 and a[1][2] <= b[1][2]):
                triangles.append((a[0], b[0], a[1]))
                a = a[1:]
            else:
                triangles.append((a[0], b[0], b[1]))
                b = b[1:]
    points = np.array(triangles).reshape(-1, 3).round(9)
    vertices, index = np.unique(points, axis=0, return_inverse=True)
    return trimesh.Trimesh(vertices, index.reshape(-1, 3), process=False)


def courtyard() -> trimesh.Trimesh:
    """The level that the head of this file describes."""
    wall = 3.2
    mound_x, mound_y = np.arange(8.0, 20.1, 1.0), np.arange(22.0, 34.1, 1.0)
    pillars = [(x, 21.8) for x in (27.0, 31.0, 34.4)] + [(5.0, 24.0)]
    pillars += [(x, 34.0) for x in (5.0, 29.0, 46.0, 55.0)]
    posts = [12.0, 16.0, 24.0, 28.0, 32.0, 36.0]
    doors = [(21.15, 21.85), (24.05, 24.95), (28.0, 29.2), (32.0, 34.0)]
    x = [0, 0.4, 1.8, 3.0, 4.4, 4.8, 9.4, 24, 24.3, 25, 27, 30, 33, 34, 36, 36.3, 42, 43.6, 46]
    x += [50, 51, 54, 55, 57, 59.6, 60]
    y = [0, 0.4, 6.4, 6.8, 12.4, 12.8, 18.8, 19.2, 21, 23, 24.2, 25, 30, 30.5, 31, 33]
    y += [36, 36.2, 39.6, 40]
    x += [12, 12.2, 20, 21.5, 40, 52, *mound_x, *(v for p in pillars for v in (p[0], p[0] + 0.6))]
    x += [v for post in posts for v in (post, post + 0.4)]
    y += [*mound_y, *(v for p in pillars for v in (p[1], p[1] + 0.6)), *(v for door in doors for v in door)]
    yard = Yard((round(float(v), 6) for v in x), (round(float(v), 6) for v in y))

    # The course: three lanes, each with its platform, and the way down.
    yard.raise_ground(25, 59.6, 0.4, 6.4, 0.3)
    yard.raise_ground(34, 59.6, 6.4, 12.4, 0.3)
    yard.raise_ground(4.8, 34, 6.8, 12.4, 0.7)
    yard.raise_ground(4.8, 30, 12.4, 18.8, 0.7)
    yard.raise_ground(30, 59.6, 12.8, 19.2, 1.2)
    yard.raise_ground(57, 59.6, 19.2, 24.2, lambda _, v: 1.2 * (24.2 - v) / 5.0)
    yard.raise_ground(4.4, 55, 6.4, 6.8, wall)
    yard.raise_ground(9.4, 59.6, 12.4, 12.8, wall)
    yard.raise_ground(4.4, 4.8, 6.4, 18.8, wall)
    for x0, x1 in ((0.4, 1.8), (3.0, 50), (54, 57)):
        yard.raise_ground(x0, x1, 18.8, 19.2, wall)
    yard.slab(1.8, 3.0, 18.8, 19.2, 2.4, wall)

    # The yard.
    def mound(px: np.ndarray, py: np.ndarray) -> np.ndarray:
        distance = np.minimum(np.hypot(px - 14.0, py - 28.0), 5.5)
        return (0.45 * (1 + np.cos(np.pi * distance / 5.5))).round(4)

    yard.raise_ground(8, 20, 22, 34, mound)
    yard.raise_ground(24, 24.3, 19.2, 36, wall)
    for y0, y1 in doors:
        yard.raise_ground(24, 24.3, y0, y1, 0.0)
        yard.slab(24, 24.3, y0, y1, 2.2, wall)
    yard.raise_ground(27, 33, 25, 33, 0.45)
    yard.raise_ground(36, 36.3, 23, 31, 0.8)
    yard.raise_ground(46, 51, 30, 30.5, 0.9)
    yard.raise_ground(42, 43.6, 21, 33, -2.5)
    for px, py in pillars:
        yard.raise_ground(px, round(px + 0.6, 6), py, round(py + 0.6, 6), wall)

    # The second storey: slab, parapet, posts, ramp.
    yard.slab(12, 12.2, 36.2, 39.6, 2.7, 4.0)
    for x0, x1 in ((12.2, 20), (21.5, 40)):
        yard.slab(x0, x1, 36.2, 39.6, 2.7, 3.0)
    below = set()
    for post in posts:
        yard.raise_ground(post, post + 0.4, 36.0, 36.2, 4.0)
        below |= set(yard.cells(post, post + 0.4, 36, 36.2))
    for cell in set(yard.cells(12, 20, 36, 36.2) + yard.cells(21.5, 40, 36, 36.2)) - below:
        yard.slabs[cell] = [(2.7, 4.0)]
    yard.raise_ground(40, 52, 36, 39.6, lambda u, _: 3.0 * (52 - u) / 12.0)

    # The walls around.
    for x0, x1, y0, y1 in ((0, 60, 0, 0.4), (0, 60, 39.6, 40), (0, 0.4, 0, 40), (59.6, 60, 0, 40)):
        yard.raise_ground(x0, x1, y0, y1, wall + 1.8)
    return yard.mesh()


def write_obj(mesh: trimesh.Trimesh, folder: Path, name: str, maker: str) -> None:
    """Write a mesh into ``folder`` as an OBJ with nothing but vertices and faces (metres, Z up)."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.obj"
    lines = [f"# {name}: metres, Z up; made by examples/{maker}"]
    lines += ["v " + " ".join(f"{value:.6g}" for value in vertex) for vertex in mesh.vertices]
    lines += ["f " + " ".join(str(index + 1) for index in face) for face in mesh.faces]
    path.write_text("\n".join(lines) + "\n")
    print(f"{path}: {len(mesh.faces)} triangles, {len(mesh.vertices)} vertices")


def main(folder: Path) -> None:
    """Write every level of ours into ``folder``."""
    write_obj(courtyard(), folder, "courtyard", "make_levels.py")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "levels")
