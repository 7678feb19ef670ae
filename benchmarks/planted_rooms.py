# pyright: reportArgumentType=false, reportReturnType=false, reportIndexIssue=false, reportCallIssue=false
# pyright: reportAttributeAccessIssue=false, reportGeneralTypeIssues=false, reportOptionalSubscript=false
# shapely's types do not tell one shape from an array of them.
"""Halls with one fault in them, or with something harmless that looks like one, at random sizes and places.

    hall = planted(rng, "narrow")     # or one of LOOK_ALIKES
    hall.mesh, hall.spawn, hall.fault

Halls are built of solid slabs, of faces without thickness, of tiles, or of small triangles; they are turned
by any angle and stand anywhere.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import shapely
import trimesh

from navmesh.surface.ledges import GAP

__all__ = ["FAULTS", "LOOK_ALIKES", "Hall", "Planted", "planted"]

Box = tuple[float, float, float, float, float, float]
"""x0, x1, y0, y1, z0, z1 [m]"""
STYLES = ("solid", "faces", "tiles", "small")
HEIGHT = 3.2  # [m] of walls
PIT = -3.0  # [m] floor of what nobody gets down to


@dataclass(frozen=True)
class Planted:
    """What a playtest has to say: the ``kind``; ``size`` [m] or [°] (None: nothing is measured); and where,
    in the hall's own coordinates: ``area``, seen from above."""

    kind: str
    size: float | None
    area: shapely.Geometry


@dataclass(frozen=True)
class Hall:
    """``mesh`` and ``spawn`` (3,) [m] in the level's coordinates; ``turn`` (4, 4) leads to them from the
    hall's; ``fault`` is None for what is harmless; ``says`` describes it."""

    mesh: trimesh.Trimesh
    spawn: np.ndarray
    turn: np.ndarray
    fault: Planted | None
    says: str

    def own(self, point: tuple[float, float, float]) -> np.ndarray:
        """(3,) [m]: ``point`` of the level in the hall's coordinates."""
        return (np.linalg.inv(self.turn) @ [*point, 1.0])[:3]


class _Plot:
    """A hall that is being built: its size, ``floor`` as seen from above, and what stands in it."""

    def __init__(self, rng: np.random.Generator, long: float = 0.0) -> None:
        self.rng = rng
        self.x, self.y = float(rng.uniform(13, 18)), max(float(rng.uniform(8, 12)), long)
        self.floor = shapely.box(0, 0, self.x, self.y)
        self.deeper: list[tuple[shapely.Geometry, float]] = []  # floors at other heights
        self.solids: list[Box] = []
        self.meshes: list[trimesh.Trimesh] = []
        self.walled = True

    def between(self, low: float, high: float) -> float:
        return float(self.rng.uniform(low, high))

    @property
    def middle(self) -> float:
        """Somewhere in the middle of its length."""
        return self.between(0.45, 0.6) * self.x

    def cut(self, area: shapely.Geometry) -> None:
        self.floor = shapely.difference(self.floor, area)

    def partition(self, doors: list[tuple[float, float, float]], thick: float | None = None) -> float:
        """A wall across with ``doors`` (middle, width, height); returns the x of its middle."""
        thick = self.between(0.1, 0.5) if thick is None else thick
        x0 = self.middle
        x1, at = x0 + thick, 0.0
        for middle, width, height in sorted(doors):
            self.solids.append((x0, x1, at, middle - 0.5 * width, 0.0, HEIGHT))
            at = middle + 0.5 * width
            if height < HEIGHT:
                self.solids.append((x0, x1, middle - 0.5 * width, at, height, HEIGHT))
        self.solids.append((x0, x1, at, self.y, 0.0, HEIGHT))
        return 0.5 * (x0 + x1)

    def stairs(self, x1: float, rise: float, count: int, tread: float = 0.3) -> None:
        """Steps up to ``x1``, all across."""
        for k in range(count):
            x0 = x1 - (count - k) * tread
            self.solids.append((x0, x0 + tread, 0.0, self.y, 0.0, (k + 1) * rise))

    def ramp(self, x1: float, degrees: float, height: float, to: float = 0.0) -> float:
        """A ramp up to ``x1``, all across, from height ``to``; returns where it begins."""
        x0 = x1 - height / math.tan(math.radians(degrees))
        corners = [(x, y, to + z) for y in (0.0, self.y) for x, z in ((x0, 0.0), (x1, 0.0), (x1, height))]
        self.meshes.append(trimesh.convex.convex_hull(np.array(corners)))
        return x0

    def rectangle(self, sides: tuple[float, float], margin: float = 1.4) -> shapely.Geometry:
        """A rectangle somewhere on the far half of the floor, turned by any angle."""
        reach = 0.5 * math.hypot(*sides) + margin
        x, y = self.between(max(reach, 5.0), self.x - reach), self.between(reach, self.y - reach)
        flat = shapely.box(-0.5 * sides[0], -0.5 * sides[1], 0.5 * sides[0], 0.5 * sides[1])
        turn = self.between(0.0, math.pi)
        spin = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
        return shapely.transform(flat, lambda points: points @ spin.T + [x, y])


def _slab(area: shapely.Geometry, top: float, bottom: float | None) -> trimesh.Trimesh:
    """The floor ``area`` at height ``top``; with sides and an underside where ``bottom`` is given."""
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(area))
    rings = np.array([shapely.get_coordinates(shapely.orient_polygons(each))[:3] for each in triangles])
    # rings of exteriors run counter-clockwise, as faces do that face up
    corners = [np.dstack([rings, np.full(rings.shape[:2], top)])]
    if bottom is not None:
        corners.append(np.dstack([rings[:, ::-1], np.full(rings.shape[:2], bottom)]))
        for polygon in shapely.get_parts(shapely.orient_polygons(area)):
            for ring in (polygon.exterior, *polygon.interiors):
                corners.append(_sides(shapely.get_coordinates(ring), top, bottom))
    points = np.concatenate(corners).reshape(-1, 3)
    return trimesh.Trimesh(points, np.arange(len(points)).reshape(-1, 3), process=False)


def _sides(ring: np.ndarray, top: float, bottom: float) -> np.ndarray:
    """(k, 3, 3): upright faces below ``ring`` (r, 2), the floor on its left."""
    a, b = ring[:-1], ring[1:]
    high, low = np.full((len(a), 1), top), np.full((len(a), 1), bottom)
    one, two = np.hstack([a, high]), np.hstack([b, high])
    three, four = np.hstack([b, low]), np.hstack([a, low])
    return np.concatenate([np.stack([one, four, three], axis=1), np.stack([one, three, two], axis=1)])


def _tiles(area: shapely.Geometry, side: float) -> list[shapely.Geometry]:
    x0, y0, x1, y1 = area.bounds
    found = []
    for x in np.arange(x0, x1, side):
        for y in np.arange(y0, y1, side):
            cut = shapely.intersection(area, shapely.box(x, y, x + side, y + side))
            found += [each for each in shapely.get_parts(cut) if shapely.area(each) > 1e-6]
    return found


def _built(plot: _Plot, style: str) -> trimesh.Trimesh:
    bottom = None if style == "faces" else 0.2
    parts = list(plot.meshes)
    for area, height in [(plot.floor, 0.0), *plot.deeper]:
        pieces = _tiles(area, 2.0) if style == "tiles" else shapely.get_parts(area)
        parts += [_slab(each, height, None if bottom is None else height - bottom) for each in pieces]
    solids = list(plot.solids)
    if plot.walled:
        x, y, low = plot.x, plot.y, min([0.0, *(height for _, height in plot.deeper)]) - 0.2
        high = HEIGHT + max([0.0, *(height for _, height in plot.deeper)])
        solids += [(-0.3, 0, -0.3, y + 0.3, low, high), (x, x + 0.3, -0.3, y + 0.3, low, high)]
        solids += [(0, x, -0.3, 0, low, high), (0, x, y, y + 0.3, low, high)]
    parts += [trimesh.creation.box(bounds=np.array(each).reshape(3, 2).T) for each in solids]
    mesh = trimesh.util.concatenate(parts)
    if style == "small":
        mesh = trimesh.Trimesh(
            *trimesh.remesh.subdivide_to_size(mesh.vertices, mesh.faces, 1.5), process=False
        )
    return mesh


# what is wrong


def _hole(plot: _Plot) -> Planted:
    sides = plot.between(0.6, 2.5), plot.between(0.6, 2.5)
    area = plot.rectangle(sides)
    plot.cut(area)
    return Planted("hole", min(sides), shapely.centroid(area))


def _narrow(plot: _Plot) -> Planted:
    width, at = plot.between(0.31, 0.57), plot.between(1.2, plot.y - 1.2)
    x = plot.partition([(at, width, HEIGHT if plot.rng.random() < 0.5 else plot.between(2.0, 2.4))])
    return Planted("narrow", width, shapely.Point(x, at))


def _narrow_shortcut(plot: _Plot) -> Planted:
    width, at = plot.between(0.31, 0.57), plot.between(1.2, 2.0)
    x = plot.partition([(at, width, HEIGHT), (plot.y - 1.2, plot.between(0.8, 1.2), HEIGHT)])
    return Planted("narrow", width, shapely.Point(x, at))


def _low(plot: _Plot) -> Planted:
    height, width = plot.between(1.0, 1.87), plot.between(0.75, 2.5)
    at = plot.between(1.5, plot.y - 1.5)
    x = plot.partition([(at, width, height)])
    return Planted("low", height, shapely.Point(x, at))


def _steep(plot: _Plot) -> Planted:
    degrees, height, x1 = plot.between(24, 57), plot.between(1.25, 2.0), plot.middle
    plot.solids.append((x1, plot.x, 0.0, plot.y, 0.0, height))
    x0 = plot.ramp(x1, degrees, height)
    return Planted("steep", degrees, shapely.box(x0, 0, x1, plot.y))


def _step(plot: _Plot) -> Planted:
    rise, x1 = plot.between(0.23, 0.33), plot.middle
    count = math.ceil(1.0 / rise)
    plot.solids.append((x1, plot.x, 0.0, plot.y, 0.0, (count + 1) * rise))
    plot.stairs(x1, rise, count)
    return Planted("step", rise, shapely.box(x1 - 0.3 * count, 0, x1, plot.y))


def _ledge(plot: _Plot) -> Planted:
    height, x1 = plot.between(0.75, 1.18), plot.middle
    plot.solids.append((x1, plot.x, 0.0, plot.y, 0.0, height))
    return Planted("ledge", height, shapely.LineString([(x1, 0), (x1, plot.y)]))


def _gap(plot: _Plot) -> Planted:
    width = plot.between(2.55, 3.4)
    area = _chasm(plot, width)
    return Planted("gap", width, area)


def _pit(plot: _Plot, sides: tuple[float, float], kind: str) -> Planted:
    deep = plot.between(0.8, 1.6)
    area = plot.rectangle(sides)
    _dug(plot, area, deep)
    return Planted(kind, deep, area)


def _trap(plot: _Plot) -> Planted:
    return _pit(plot, (plot.between(1.8, 3.0), plot.between(1.8, 3.0)), "trap")


def _one_way(plot: _Plot) -> Planted:
    x, deep = plot.middle, plot.between(0.8, 1.6)
    area = shapely.box(x, 0, plot.x, plot.y)
    _dug(plot, area, deep)
    return Planted("one_way", deep, area)


def _walled_off(plot: _Plot) -> Planted:
    x = plot.partition([])
    return Planted("walled_off", None, shapely.LineString([(x, 0), (x, plot.y)]))


def _chasm(plot: _Plot, width: float) -> shapely.Geometry:
    x = plot.middle - 0.5 * width
    area = shapely.box(x, 0, x + width, plot.y)
    _dug(plot, area, -PIT)
    return area


def _dug(plot: _Plot, area: shapely.Geometry, deep: float) -> None:
    """A pit with walls."""
    plot.cut(area)
    plot.deeper.append((area, -deep))
    inside = shapely.get_coordinates(shapely.orient_polygons(area))
    # seen from within, the earth is on the right of the ring
    faces = _sides(inside, 0.0, -deep)[:, ::-1]
    plot.meshes.append(
        trimesh.Trimesh(faces.reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3), process=False)
    )


# what only looks like it


def _wide_door(plot: _Plot) -> None:
    plot.partition([(plot.between(1.2, plot.y - 1.2), plot.between(0.63, 1.1), HEIGHT)])


def _crack(plot: _Plot) -> None:
    width, lean = plot.between(0.005, 0.98 * GAP), plot.between(-0.5, 0.5)
    line = shapely.LineString([(plot.middle - lean * plot.y, -1), (plot.middle + lean * plot.y, plot.y + 1)])
    plot.cut(shapely.buffer(line, 0.5 * width, cap_style="flat"))


def _high_lintel(plot: _Plot) -> None:
    plot.partition([(plot.between(1.5, plot.y - 1.5), plot.between(0.8, 2.0), plot.between(1.93, 2.3))])


def _gentle_ramp(plot: _Plot) -> None:
    height, x1 = plot.between(0.8, 1.2), plot.between(0.65, 0.7) * plot.x
    plot.solids.append((x1, plot.x, 0.0, plot.y, 0.0, height))
    plot.ramp(x1, plot.between(11, 18), height)


def _low_stairs(plot: _Plot) -> None:
    rise, x1 = plot.between(0.1, 0.19), plot.middle
    count = math.ceil(1.0 / rise)
    plot.solids.append((x1, plot.x, 0.0, plot.y, 0.0, (count + 1) * rise))
    plot.stairs(x1, rise, count)


def _low_ledge(plot: _Plot) -> None:
    x1 = plot.middle
    plot.solids.append((x1, plot.x, 0.0, plot.y, 0.0, plot.between(0.25, 0.68)))


def _leapable(plot: _Plot) -> None:
    _chasm(plot, plot.between(0.45, 2.3))


def _way_out(plot: _Plot) -> None:
    """Half of the hall lies deeper, and a ramp leads back."""
    deep, x1 = plot.between(0.8, 1.4), plot.between(0.3, 0.35) * plot.x
    area = shapely.box(x1, 0, plot.x, plot.y)
    plot.cut(area)
    plot.deeper.append((area, -deep))
    run = deep / math.tan(math.radians(plot.between(14, 18)))
    y1 = plot.between(1.5, plot.y - 1.5)
    corners = [
        (x, y, z) for y in (y1 - 1.2, y1 + 1.2) for x, z in ((x1, -deep), (x1, 0.0), (x1 + run, -deep))
    ]
    plot.meshes.append(trimesh.convex.convex_hull(np.array(corners)))
    plot.solids.append((x1 - 0.01, x1, 0.0, plot.y, -deep, 0.0))


def _no_walls(plot: _Plot) -> None:
    plot.walled = False


def _block(plot: _Plot) -> None:
    x, y = plot.between(5, plot.x - 4), plot.between(1.5, plot.y - 4)
    plot.solids.append((x, x + plot.between(1, 3), y, y + plot.between(1, 2.5), 0.0, plot.between(1.9, 3.0)))


def _two_doors(plot: _Plot) -> None:
    """A narrow door with a wide one beside it."""
    y = plot.between(1.2, plot.y - 4.0)
    plot.partition([(y, plot.between(0.32, 0.55), HEIGHT), (y + plot.between(1.5, 2.5), 0.9, HEIGHT)])


def _window(plot: _Plot) -> None:
    """A door, and a window beside it that is too small to be one."""
    y, thick = plot.between(1.2, plot.y - 4.0), 0.3
    x = plot.partition([(y, 0.9, HEIGHT), (y + 2.0, 0.6, HEIGHT)], thick)
    x0, x1 = x - 0.5 * thick, x + 0.5 * thick
    plot.solids += [(x0, x1, y + 1.7, y + 2.3, 0.0, 1.1), (x0, x1, y + 1.7, y + 2.3, 2.0, HEIGHT)]


FAULTS: dict[str, Callable[[_Plot], Planted]] = {
    "hole": _hole,
    "narrow": _narrow,
    "narrow shortcut": _narrow_shortcut,
    "low": _low,
    "steep": _steep,
    "step": _step,
    "ledge": _ledge,
    "gap": _gap,
    "trap": _trap,
    "one_way": _one_way,
    "walled_off": _walled_off,
}
LOOK_ALIKES: dict[str, Callable[[_Plot], None]] = {
    "wide door": _wide_door,
    "crack": _crack,
    "high lintel": _high_lintel,
    "gentle ramp": _gentle_ramp,
    "low stairs": _low_stairs,
    "low ledge": _low_ledge,
    "leapable gap": _leapable,
    "way out": _way_out,
    "no walls": _no_walls,
    "block": _block,
    "two doors": _two_doors,
    "window": _window,
}


def planted(rng: np.random.Generator, name: str, style: str | None = None) -> Hall:
    """A hall with ``name`` of `FAULTS` or `LOOK_ALIKES` in it; ``style`` of `STYLES`, or any."""
    style = str(rng.choice(STYLES)) if style is None else style
    plot = _Plot(rng, 15.0 if name == "narrow shortcut" else 0.0)
    fault = FAULTS[name](plot) if name in FAULTS else None
    if fault is None:
        LOOK_ALIKES[name](plot)
    mesh = _built(plot, style)
    degrees = float(rng.uniform(0.0, 360.0)) if rng.random() < 0.8 else 0.0
    turn = trimesh.transformations.rotation_matrix(math.radians(degrees), (0, 0, 1))
    turn[:3, 3] = rng.uniform((-200, -200, -20), (200, 200, 20))
    mesh.apply_transform(turn)
    spawn = (turn @ [2.0, 0.5 * plot.y, 0.0, 1.0])[:3]
    size = "" if fault is None or fault.size is None else f" of {fault.size:.2f}"
    return Hall(mesh, spawn, turn, fault, f"{name}{size}, {style}, turned by {degrees:.0f} degrees")
