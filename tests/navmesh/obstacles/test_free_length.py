"""How far one can walk straight on from a place on the surface."""

from pathlib import Path

import numpy as np
import pytest

import navmesh
from navmesh.obstacles.free_length import cells_of, march
from navmesh.surface.build import build_surface

COURTYARD = Path(__file__).resolve().parents[3] / "examples" / "levels" / "courtyard.obj"
RULES = navmesh.WalkRules()


def _slow_march(surface, cell, x, y, dx, dy, limit) -> float:
    """`march` by very small steps from square to square."""
    ny, size = surface.shape[1], surface.resolution
    t = 0.0
    column = int(surface.cell_column[cell])
    while t < limit:
        t += 1e-4
        ix, iy = int((x + t * dx) // size), int((y + t * dy) // size)
        if ix * ny + iy == column:
            continue
        step = (ix - column // ny, iy - column % ny)
        if abs(step[0]) + abs(step[1]) != 1:
            return t  # across a corner: the two answers may differ
        way = {(1, 0): 0, (0, 1): 1, (-1, 0): 2, (0, -1): 3}[step]
        cell = int(surface.link[cell, way])
        if cell < 0:
            return t
        column = int(surface.cell_column[cell])
    return limit


def test_march_agrees_with_very_small_steps() -> None:
    surface = build_surface(navmesh.Terrain.load(COURTYARD), RULES)
    cells = cells_of(surface)
    rng = np.random.default_rng(3)
    for cell in rng.integers(0, len(surface), 40):
        centre = surface.centers(np.array([cell]))[0] - surface.origin
        x, y = centre[:2] + rng.uniform(-0.1, 0.1, 2)
        heading = rng.uniform(-np.pi, np.pi)
        dx, dy = np.cos(heading), np.sin(heading)
        length, last = march(cells, int(cell), x, y, dx, dy, 6.0)
        assert length == pytest.approx(_slow_march(surface, int(cell), x, y, dx, dy, 6.0), abs=1e-3)
        there = np.array([x + (length - 1e-6) * dx, y + (length - 1e-6) * dy])
        centre = surface.centers(np.array([last]))[0] - surface.origin
        assert np.all(np.abs(there - centre[:2]) <= surface.resolution / 2 + 1e-6)
