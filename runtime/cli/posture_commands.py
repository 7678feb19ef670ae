"""What the command for posture graphs does once its arguments are parsed."""

import os
from pathlib import Path

import numpy as np

from locomotion.postures.posture_file import check_posture_file
from locomotion.postures.posture_graph import PostureGraph
from locomotion.postures.step_order import step_name
from runtime.cli.clips import MotionArtist
from runtime.cli.commands import Result, check_picture
from surefoot.files.atomic_write import whole_file
from surefoot.progress import Progress

__all__ = ["show_postures"]

_MOMENTS, _COLUMNS = 6, 8
"""Pictures of each arc, and of all in a row."""


def show_postures(file: Path, film: Path | None) -> Result:
    """Check a posture file and draw its postures and arcs to ``film``. Holds if nothing is wrong with it."""
    if film is not None:
        check_picture(film)
    graph, faults = check_posture_file(file)
    if film is not None:
        _draw(graph, film, Progress())
    names = graph.postures
    arcs = [
        {
            "from": names[graph.start[a]],
            "to": names[graph.end[a]],
            "seconds": round(float(graph.seconds[a]), 3),
        }
        for a in range(len(graph.start))
    ]
    values = {
        "name": graph.name,
        "postures": list(names),
        "arcs": arcs,
        "gaits": [gait.name for gait in graph.gaits],
        "faults": [str(f) for f in faults],
    }

    def show() -> None:
        print(f"{graph.name}: {len(names)} postures ({', '.join(names)})")
        for a, arc in enumerate(arcs):
            more = ", played backwards" if graph.backwards[a] else ""
            print(f"  {arc['from']} to {arc['to']}: {arc['seconds']:g} s{more}")
        for gait in graph.gaits:
            steps = ", ".join(step_name(gait, k) for k in range(len(gait.steps)))
            speeds = f"{gait.slowest:g} to {gait.fastest:g} m/s"
            print(f"  {gait.name}: {speeds} from {names[gait.posture]} ({steps})")
        print("\n".join(str(fault) for fault in faults) or "nothing is wrong")

    return Result(values, not faults, show)


def _draw(graph: PostureGraph, path: str | os.PathLike[str], progress: Progress) -> None:
    """The postures in the first rows, then an arc in each row, seen from the right."""
    from matplotlib.figure import Figure as Page

    arcs = np.flatnonzero(~graph.backwards)
    first = -(-len(graph.postures) // _COLUMNS)  # rows of postures
    page = Page(figsize=(_COLUMNS * 2.4, (first + len(arcs)) * 2.2), dpi=90)
    page.subplots_adjust(0.01, 0.01, 0.99, 0.99, 0.04, 0.04)
    panels = page.subplots(first + len(arcs), _COLUMNS, squeeze=False)
    for axes in panels.flat:
        axes.axis("off")
    artist = MotionArtist()
    with progress.stage("drawing the postures") as stage:
        for axes, name, pose in zip(panels.flat, graph.postures, graph.poses, strict=False):
            artist.draw(axes, pose, name.replace("/", "\n"))
        for row, arc in enumerate(arcs, first):
            stage.update(row / (first + len(arcs)))
            ends = f"{graph.postures[graph.start[arc]]}\nto {graph.postures[graph.end[arc]]}"
            for axes, share in zip(panels[row], np.linspace(0.0, 1.0, _MOMENTS), strict=False):
                frame = graph.frames[graph.first[arc] + round(share * (graph.count[arc] - 1))]
                artist.draw(axes, frame, f"{ends}, {share * graph.seconds[arc]:.2f} s")
    with whole_file(path) as temporary:
        page.savefig(temporary, format="png")
