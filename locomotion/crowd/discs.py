"""Bodies as discs on the ground: how a crowd tells where its own are, and hears of others.

A disc is a row (6,) float64: x, y, z of the floor under it [m], its velocity in x and y [m/s], its radius
[m]. ``rows`` are those of a crowd (`locomotion.crowd.layout`), relative to ``origin`` (3,) [m].
"""

from locomotion.crowd import layout as at
from surefoot.kernels import kernel

__all__ = ["add_discs", "write_discs"]

_VX, _VY, _RADIUS = range(3, 6)  # places in the row of a disc


@kernel
def write_discs(rows, origin, discs):
    """Where the bodies of ``rows`` (n, ROW) are, into ``discs`` (n, 6)."""
    for k in range(len(discs)):
        row, disc = rows[k], discs[k]
        for axis in range(3):
            disc[axis] = row[at.X + axis] + origin[axis]
        disc[_VX], disc[_VY], disc[_RADIUS] = row[at.VX], row[at.VY], row[at.RADIUS]


@kernel
def add_discs(rows, origin, discs):
    """Make ``rows`` (n, ROW) bodies that others move, where ``discs`` (n, 6) are."""
    for k in range(len(discs)):
        row, disc = rows[k], discs[k]
        row[:] = 0.0
        for axis in range(3):
            row[at.X + axis] = disc[axis] - origin[axis]
        row[at.VX], row[at.VY] = disc[_VX], disc[_VY]
        row[at.GO_X], row[at.GO_Y] = disc[_VX], disc[_VY]
        row[at.RADIUS], row[at.MODE] = disc[_RADIUS], at.LED
        row[at.WEIGHT], row[at.CELL] = at.UNMOVED, -1.0
