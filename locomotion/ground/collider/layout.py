"""Columns of the arrays that hold a ground's triangles for kernels.

``rows`` (n, ROW) float64 and ``flags`` (n, FLAGS) int32 have one row per triangle, ``grid`` (4,) float64
gives the position of the cells that list the triangles. Coordinates [m] are relative to the ground's origin.
"""

__all__ = [
    "CONE",
    "CONE_ROW",
    "CORNER",
    "DEPTH_LIMIT",
    "EDGE_DEPTH_LIMIT",
    "EXPOSED",
    "FIRST_X",
    "FIRST_Y",
    "FLAGS",
    "HIGH_X",
    "HIGH_Y",
    "HIGH_Z",
    "LOW_X",
    "LOW_Y",
    "LOW_Z",
    "NX",
    "NY",
    "NZ",
    "OFFSET",
    "PER_METRE",
    "ROW",
    "SIDE",
    "SIDES_END",
    "SIDE_ROW",
    "SOUTH",
    "VERTEX",
    "WEST",
]  # fmt: skip

# --- rows
NX, NY, NZ, OFFSET = 0, 1, 2, 3
"""Unit normal and offset [m] of the plane: normal · point = offset on it, more in front of it."""
SIDE, SIDE_ROW, SIDES_END = 4, 4, 16
"""Three side planes, of SIDE_ROW columns each: unit normal outward in the plane, offset [m]."""
CORNER = 16
"""Three corners of three columns [m]."""
DEPTH_LIMIT = 25
"""[m] depth behind the face within which a body is still pushed out."""
CONE, CONE_ROW = 26, 6
"""For each edge the two sides (unit normals) of the cone of directions in which a body can touch it."""
LOW_X, LOW_Y, LOW_Z, HIGH_X, HIGH_Y, HIGH_Z = range(44, 50)
"""[m] bounds."""
EDGE_DEPTH_LIMIT = 50
"""[m] one for each edge: depth to which an axis may have come through it."""
ROW = 53

# --- flags
EXPOSED = 0
"""Bits 0 to 2: exposed edges that this triangle owns; bits 3 to 5: exposed corners."""
VERTEX = 1
"""Three columns: its welded vertices."""
FIRST_X, FIRST_Y = 4, 5
"""The first cell that lists it."""
FLAGS = 6

# --- grid
WEST, SOUTH, PER_METRE = 0, 1, 2
"""[m] least x and y of the cells; cells per metre. (A fourth number is not used.)"""
