"""A page that plays a run in a browser: one HTML file that needs no server and no network."""

import os
from typing import Any

import numpy as np

from runtime.camera import agent_named, calm_track, size_of
from runtime.figure import Figure
from runtime.files import whole_file
from runtime.meshes import shape_mesh
from runtime.scenery import ALL, draw_level, draw_paths, silent
from runtime.trace import AgentTrace, Trace

__all__ = ["write_page"]

FRAME = 0.03
"""[s] least time between frames of the page."""
_AWAY = 4.5  # [sizes of the figure] from the camera to the one that it goes with


def write_page(trace: Trace, path: str | os.PathLike[str], follow: str | None = None) -> None:
    """Write the page to ``path``, whole or not at all: level, graph, obstacles, paths, figures, time line.

    The camera stands still, or goes with the agent called ``follow``; in both cases it can be turned by hand.
    Raises `RuntimeInputError` for an agent that is not there.
    """
    followed = None if follow is None else agent_named(trace, follow)
    with whole_file(path) as temporary:
        temporary.write_text(_page(trace, followed), encoding="utf-8")


def _page(trace: Trace, followed: AgentTrace | None) -> str:
    import viser

    with silent():  # viser makes its pages from a server's scene; this one listens to this machine alone
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        _set_up(server, trace, followed)
        # a page's camera cannot be moved, but all that it sees can: everything hangs on this frame
        everything = server.scene.add_frame(ALL, show_axes=False)
        track = None if followed is None else calm_track(followed, trace.times, trace.times)
        if track is not None:
            everything.position = -track[0]
        draw_level(server.scene, trace.level)
        for agent in trace.agents:
            for index, planned in enumerate(agent.paths):
                draw_paths(server.scene, f"{ALL}/paths/{agent.name} {index + 1}", [planned])
        bodies = [_draw_figure(server.scene, agent.name, agent.figure) for agent in trace.agents]
        recording = server.get_scene_serializer()
        last = -1.0
        for k, moment in enumerate(trace.times):
            if moment - last < FRAME - 1e-6 and k > 0:
                continue
            if k > 0:
                recording.insert_sleep(float(moment - last))
            last = float(moment)
            if track is not None:
                everything.position = -track[k]
            for agent, handles in zip(trace.agents, bodies, strict=True):
                for body, handle in handles:
                    handle.position, handle.wxyz = agent.poses[k, body, :3], agent.poses[k, body, 3:]
        return recording.as_html(dark_mode=False)
    finally:
        with silent():
            server.stop()


def _set_up(server: Any, trace: Trace, followed: AgentTrace | None) -> None:
    root = trace.agents[0].poses[:, 0, :3].astype(np.float64)
    middle = root.mean(axis=0)
    back = max(float(np.ptp(root[:, :2], axis=0).max()), 8.0)
    towards = np.array([-0.35, -0.75, 0.75])
    if followed is not None:  # from high up, where walls hide little
        middle, back, towards = np.zeros(3), _AWAY * size_of(followed), np.array([-0.3, -0.45, 0.85])
    server.scene.set_up_direction("+z")
    server.initial_camera.position = tuple(middle + towards * back)
    server.initial_camera.look_at = tuple(middle)


def _draw_figure(scene: Any, name: str, figure: Figure) -> list[tuple[int, Any]]:
    """One frame with its shapes for each body; returns (index of the body, handle)."""
    handles = []
    for body, label in enumerate(figure.bodies):
        own = np.flatnonzero(figure.owner == body)
        if len(own) == 0:
            continue
        handle = scene.add_frame(f"{ALL}/figures/{name}/{label}", show_axes=False)
        for k in own:
            mesh = shape_mesh(figure.shapes, int(k))
            scene.add_mesh_simple(
                f"{ALL}/figures/{name}/{label}/{k}",
                mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32),
                color=tuple(int(255 * part) for part in figure.shapes.colour[k]),
                position=figure.shapes.place[k, :3], wxyz=figure.shapes.place[k, 3:],
            )  # fmt: skip
        handles.append((body, handle))
    return handles
