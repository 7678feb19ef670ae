"""Makes the roofs: ``examples/levels/roofs.obj`` (metres, **Z up**).

    python examples/make_roofs.py [folder]

Four flat roofs in a row along x, 3 m above the street and 5 m wide, with alleys between them:

| what | where |
| ---- | ----- |
| roofs | x 0-12, 12.8-24, 25.2-37, 38.5-52; y 0-5 |
| alleys, 0.8, 1.2 and 1.5 m wide | in between |
| the street | all around, 1 m |
"""

import sys
from pathlib import Path

from make_levels import Yard, write_obj

ROOFS = ((0.0, 12.0), (12.8, 24.0), (25.2, 37.0), (38.5, 52.0))
"""x from, to [m]."""
WIDTH, HEIGHT, STREET = 5.0, 3.0, 1.0
"""[m]"""


def roofs():
    """The level that the head of this file describes."""
    ends = [x for roof in ROOFS for x in roof]
    yard = Yard([-STREET, *ends, ends[-1] + STREET], [-STREET, 0.0, WIDTH, WIDTH + STREET])
    for low, high in ROOFS:
        yard.raise_ground(low, high, 0.0, WIDTH, HEIGHT)
    return yard.mesh()


def main(folder: Path) -> None:
    """Write the roofs into ``folder``."""
    write_obj(roofs(), folder, "roofs", "make_roofs.py")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent / "levels")
