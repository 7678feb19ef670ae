"""Makes the picture of ``docs/guides/recorded-motion.md``: motions at the three levels of detail.

python examples/recorded_film.py [file]
"""

import sys

import numpy as np
from matplotlib.figure import Figure as Sheet

from locomotion.body.models import figure
from locomotion.body.person import BODY_NAMES
from locomotion.recorded.motion_set import load_motions
from locomotion.recorded.posing import posed, whole_figures
from locomotion.recorded.sampling import sample_clips
from locomotion.recorded.skeletons import LEVELS, skeleton
from runtime.bodies.figure import Figure
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render

CLIPS = {
    "walk 1.25": 3,
    "run 3": 3,
    "crawl 0.5": 2,
    "stand to kneel": 2,
    "get up after a fall backward": 3,
}
"""Clips, and how many moments of each are shown."""
HALF = 50.0  # [m] of the ground


def main() -> None:
    """Draw all."""
    file = sys.argv[1] if len(sys.argv) > 1 else "docs/pictures/recorded-levels.png"
    motions, shown = load_motions(), Figure.from_model(figure())
    order = [BODY_NAMES.index(name) for name in shown.bodies]
    corners = HALF * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
    ground = Triangles(corners, np.array([[0, 1, 2], [0, 2, 3]]))
    sheet = Sheet(figsize=(18, 7.0), dpi=75, layout="constrained")
    for level, row in enumerate(sheet.subplots(len(LEVELS), sum(CLIPS.values()))):
        panels, own = iter(row), skeleton(LEVELS[level])
        for name, count in CLIPS.items():
            clip = motions.clip(name)
            for moment in motions.seconds[clip] * (np.arange(count) + 0.5) / count:
                sample = sample_clips(motions, level, [clip], [moment])
                places = whole_figures(own, posed(own, *sample))[0][order]
                target = np.array([*places[0, :2], 0.8])
                camera = Camera(target + np.array([0.8, -3.4, 0.4]), target, 0.62)
                axes = next(panels)
                show_frame(axes, render(ground, [shown.posed(places)], camera, (210, 330)), "")
                words = f"{moment:.2f} s" if level else name if moment < motions.seconds[clip] / count else ""
                told = axes.text(0.02, 1.03, words, transform=axes.transAxes, fontsize=10)
                told.set_in_layout(False)  # it may be wider than its picture
        row[0].text(0.05, 0.9, LEVELS[level], transform=row[0].transAxes, fontsize=13)
    sheet.get_layout_engine().set(rect=(0.0, 0.0, 1.0, 0.97))  # room for the words above the first row
    sheet.savefig(file)


if __name__ == "__main__":
    main()
