"""A video of a run: frames drawn by `runtime.views.render`, encoded as H.264 by PyAV."""

import os
from collections.abc import Iterator

import numpy as np

from locomotion import Rig
from runtime.bodies.pose import between
from runtime.traces.trace import AgentTrace, Trace
from runtime.views.camera import agent_named, follow, size_of
from runtime.views.meshes import optional
from runtime.views.render import Triangles, render
from runtime.views.worn import Wardrobe, wearers, wears
from surefoot.files.atomic_write import whole_file
from surefoot.progress import Progress

__all__ = ["RATE", "frames", "write_film"]

RATE = 25
"""Frames per second."""
_SIZE = (640, 360)
_AWAY = 3.2  # [sizes of the figure] from the camera to it


def write_film(
    trace: Trace,
    path: str | os.PathLike[str],
    of: str | None = None,
    progress: Progress | None = None,
    size: tuple[int, int] = _SIZE,
    character: Rig | None = None,
) -> None:
    """Write the run as a video (.mp4) to ``path``, whole or not at all.

    The camera follows the agent ``of``, by default the first; ``size`` [pixels] must be even. People wear
    the ``character``, if there is one. Raises `RuntimeInputError` without PyAV, for an unknown agent, and for
    a character that nobody can wear.
    """
    av = optional("av", "video", "a video")
    agent = agent_named(trace, of)
    if character is not None:
        wearers(trace.agents)
    count = len(_moments(trace))
    with (
        (progress or Progress(shown=False)).stage("drawing the film") as stage,
        whole_file(path) as temporary,
    ):
        with av.open(str(temporary), "w", format="mp4") as container:
            stream = container.add_stream("libx264", rate=RATE, options={"crf": "20"})
            stream.width, stream.height = size
            stream.pix_fmt, stream.thread_count = "yuv420p", 1
            for k, picture in enumerate(frames(trace, agent, size, character)):
                container.mux(stream.encode(av.VideoFrame.from_ndarray(picture, format="rgb24")))
                stage.update((k + 1) / count, f"frame {k + 1} of {count}")
            container.mux(stream.encode())


def frames(
    trace: Trace, agent: AgentTrace, size: tuple[int, int], character: Rig | None = None
) -> Iterator[np.ndarray]:
    """The pictures (height, width, 3) uint8 of the run, 25 for each second of it."""
    people = [agent for agent in trace.agents if wears(agent)]
    wardrobe = None if character is None else Wardrobe(character, trace, people)
    level = Triangles(trace.level.vertices, trace.level.faces)
    moments = _moments(trace)
    distance = _AWAY * size_of(agent)
    for moment, camera in zip(moments, follow(agent, trace.times, moments, distance), strict=True):
        plain, skins, shadows = [], [], []
        before, share = _place_of(trace.times, moment)
        for each in trace.agents:
            if wardrobe is not None and wears(each):
                skin, held, shadow = wardrobe.worn(each, before, share)
                plain += held
                skins.append(skin)
                shadows.append(shadow)
            else:
                ends = each.poses[[before, min(before + 1, len(each.poses) - 1)]].astype(np.float64)
                plain.append(each.posed(before, between(ends[0], ends[1], share)))
        yield render(level, plain, camera, size, cutaway=0.75 * distance, skins=skins, shadows=shadows)


def _moments(trace: Trace) -> np.ndarray:
    """[s] times of the frames."""
    length = float(trace.times[-1] - trace.times[0])
    return trace.times[0] + np.arange(int(length * RATE + 1e-9) + 1) / RATE


def _place_of(times: np.ndarray, moment: float) -> tuple[int, float]:
    """The number of the pose before a moment, and the share of the way to the next."""
    if len(times) == 1:
        return 0, 0.0
    before = int(np.clip(np.searchsorted(times, moment), 1, len(times) - 1)) - 1
    begin, end = times[before : before + 2]
    return before, float(np.clip((moment - begin) / (end - begin), 0.0, 1.0))
