"""Makes the dog's room: ``examples/levels/room.obj`` (metres, **Z up**).

    python examples/make_room.py [folder]

A cluttered living room of 7 x 5.6 m, x to the east, y to the north:

| what | where |
| ---- | ----- |
| table, top 0.80-0.84 m high, on four legs; dogs walk under it | x 2.2-3.8, y 2.0-3.2 |
| sofa, 0.45 m high, solid | x 0.8-1.7, y 1.2-3.6 |
| cupboard, 1.8 m high; behind it a dead end of 0.5 m, open to the west | x 4.0-6.8, y 4.7-4.9 and on |
| dais, 0.14 m high, with the armchair on it | x 5.0-6.8, y 0.2-2.2 |
| boxes | several, 0.3-0.6 m apart |
"""

import sys
from pathlib import Path

from make_levels import Yard, write_obj

WALL = 2.4
BOXES = [
    (1.0, 4.3, 0.5, 0.4),
    (2.1, 4.1, 0.4, 0.5),
    (4.4, 3.4, 0.4, 0.4),
    (5.6, 3.2, 0.5, 0.5),
    (3.2, 0.8, 0.5, 0.4),
]
"""x, y of the south-western corner, size in x and y [m]."""
LEGS = [(2.2, 2.0), (3.7, 2.0), (2.2, 3.1), (3.7, 3.1)]


def room():
    """The level that the head of this file describes."""
    x = [0, 0.2, 0.8, 1.7, 2.2, 2.3, 3.7, 3.8, 4.0, 5.0, 5.7, 6.5, 6.8, 7.0]
    y = [0, 0.2, 0.5, 1.2, 1.3, 2.0, 2.1, 2.2, 3.1, 3.2, 3.6, 4.7, 4.9, 5.4, 5.6]
    x += [v for bx, _, w, _ in BOXES for v in (bx, bx + w)]
    y += [v for _, by, _, d in BOXES for v in (by, by + d)]
    yard = Yard((round(float(v), 6) for v in x), (round(float(v), 6) for v in y))
    for x0, x1, y0, y1 in ((0, 7, 0, 0.2), (0, 7, 5.4, 5.6), (0, 0.2, 0, 5.6), (6.8, 7, 0, 5.6)):
        yard.raise_ground(x0, x1, y0, y1, WALL)
    yard.raise_ground(0.8, 1.7, 1.2, 3.6, 0.45)
    yard.raise_ground(4.0, 6.8, 4.7, 4.9, 1.8)
    yard.raise_ground(5.0, 6.8, 0.2, 2.2, 0.14)
    yard.raise_ground(5.7, 6.5, 0.5, 1.3, 0.6)
    for bx, by, w, d in BOXES:
        yard.raise_ground(bx, round(bx + w, 6), by, round(by + d, 6), 0.5)
    yard.slab(2.2, 3.8, 2.0, 3.2, 0.80, 0.84)
    for lx, ly in LEGS:
        yard.raise_ground(lx, round(lx + 0.1, 6), ly, round(ly + 0.1, 6), 0.80)
        for cell in yard.cells(lx, round(lx + 0.1, 6), ly, round(ly + 0.1, 6)):
            yard.slabs.pop(cell, None)
            yard.ground[cell] = 0.84
    return yard.mesh()


def main(folder: Path) -> None:
    """Write the room into ``folder``."""
    write_obj(room(), folder, "room", "make_room.py")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "levels")
