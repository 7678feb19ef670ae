"""A film strip of 200 walkers that change halls through a doorway of 1.2 m, as docs/pictures/crowd-door.png.

python -m examples.crowd_film docs/pictures/crowd-door.png
"""

import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection

from benchmarks.crowd import DOOR, TICK, door_crowd

MOMENTS = (0.0, 10.0, 40.0, 80.0, 140.0, 210.0)
"""[s]"""


def main(path: str) -> None:
    """Draw the strip into the file ``path``."""
    crowd = door_crowd(0.3, 200, np.random.default_rng(1))
    figure, axes = plt.subplots(2, 3, figsize=(13.5, 5.6), layout="constrained")
    colours = np.repeat(["tab:red", "tab:blue"], 100)
    for axis, moment in zip(axes.flat, MOMENTS, strict=True):
        while crowd.walkers[0].time < moment - 0.5 * TICK:
            crowd.tick()
        wide = np.full(len(crowd), 0.6)
        discs = EllipseCollection(
            wide, wide, 0.0 * wide, units="xy", offsets=crowd.positions[:, :2], facecolors=colours,
            offset_transform=axis.transData,
        )  # fmt: skip
        axis.add_collection(discs)
        for low, high in ((0.0, 7.0 - 0.5 * DOOR), (7.0 + 0.5 * DOOR, 14.0)):
            axis.fill_between([12.0, 12.2], low, high, color="black")
        axis.set(
            xlim=(0.0, 24.2), ylim=(0.0, 14.0), aspect="equal", title=f"{moment:.0f} s", xticks=[], yticks=[]
        )
    figure.savefig(path, dpi=70)


if __name__ == "__main__":
    main(sys.argv[1])
