"""A page that plays a run in a browser: one HTML file that needs no server and no network."""

import contextlib
import io
import os
from typing import Any

import numpy as np

from runtime.camera import agent_named, calm_track, size_of
from runtime.figure import Figure
from runtime.files import whole_file
from runtime.meshes import shape_mesh
from runtime.trace import AgentTrace, LevelTrace, PathTrace, Trace

__all__ = ["write_page"]

FRAME = 0.03
"""[s] least time between frames of the page."""
_ALL = "/run"
_AWAY = 4.5  # [sizes of the figure] from the camera to the one that it goes with
_RAW, _PULLED, _SMOOTH = (120, 120, 120), (31, 119, 180), (214, 39, 40)
_AFFORDANCES = {"jump": (209, 73, 91), "vault": (142, 68, 173), "drop": (237, 174, 73), "gap": (0, 121, 140)}


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

    silent = contextlib.redirect_stdout(io.StringIO())
    with (
        silent
    ):  # viser makes its pages from a server's scene; this one listens to this machine alone, for a moment
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    try:
        _set_up(server, trace, followed)
        # a page's camera cannot be moved, but all that it sees can: everything hangs on this frame
        everything = server.scene.add_frame(_ALL, show_axes=False)
        track = None if followed is None else calm_track(followed, trace.times, trace.times)
        if track is not None:
            everything.position = -track[0]
        _draw_level(server.scene, trace.level)
        for agent in trace.agents:
            for index, planned in enumerate(agent.paths):
                _draw_paths(server.scene, f"{_ALL}/paths/{agent.name} {index + 1}", planned)
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
        with silent:
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


def _draw_level(scene: Any, level: LevelTrace) -> None:
    scene.add_mesh_simple(
        f"{_ALL}/level", level.vertices.astype(np.float32), level.faces.astype(np.uint32),
        color=(205, 203, 196), flat_shading=True, side="front",
    )  # fmt: skip
    wide = level.radii > 0.3
    lift = np.array([0.0, 0.0, 0.04])
    scene.add_line_segments(
        f"{_ALL}/graph/discs", _circles(level.positions[wide] + lift, level.radii[wide]),
        colors=(42, 157, 143), thickness=1.0, thickness_units="screen",
    )  # fmt: skip
    joined = wide[level.edges].all(axis=1)
    if joined.any():
        scene.add_line_segments(
            f"{_ALL}/graph/edges", (level.positions[level.edges[joined]] + lift).astype(np.float32),
            colors=(20, 110, 100), thickness=1.5, thickness_units="screen",
        )  # fmt: skip
    for k, affordance in enumerate(level.affordances):
        name = f"{_ALL}/obstacles/{affordance} {k}"
        rim = (level.rim[k] + lift).astype(np.float32)[None]
        scene.add_line_segments(
            name, rim, colors=_AFFORDANCES[affordance], thickness=5.0, thickness_units="screen"
        )
        if np.linalg.norm(rim[0, 1] - rim[0, 0]) > 2.0:
            text = f"{affordance} {abs(level.height[k]):.2f} m"
            scene.add_label(f"{name}/label", text, position=rim[0].mean(axis=0) + np.array([0.0, 0.0, 0.3]))


def _circles(centers: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """Line segments (n * 20, 2, 3) float32 around horizontal circles."""
    angle = np.linspace(0.0, 2.0 * np.pi, 21)
    round_ = np.stack([np.cos(angle), np.sin(angle), np.zeros(21)], axis=1)
    points = centers[:, None] + radii[:, None, None] * round_
    return np.stack([points[:, :-1], points[:, 1:]], axis=2).reshape(-1, 2, 3).astype(np.float32)


def _draw_paths(scene: Any, name: str, planned: PathTrace) -> None:
    for label, points, colour, height in (
        ("raw", planned.raw, _RAW, 0.06), ("pulled", planned.pulled, _PULLED, 0.08),
        ("smoothed", planned.smooth, _SMOOTH, 0.10),
    ):  # fmt: skip
        raised = points + np.array([0.0, 0.0, height])
        lines = np.stack([raised[:-1], raised[1:]], axis=1).astype(np.float32)
        if len(lines):
            scene.add_line_segments(
                f"{name}/{label}", lines, colors=colour, thickness=3.0, thickness_units="screen"
            )


def _draw_figure(scene: Any, name: str, figure: Figure) -> list[tuple[int, Any]]:
    """One frame with its shapes for each body; returns (index of the body, handle)."""
    handles = []
    for body, label in enumerate(figure.bodies):
        own = np.flatnonzero(figure.owner == body)
        if len(own) == 0:
            continue
        handle = scene.add_frame(f"{_ALL}/figures/{name}/{label}", show_axes=False)
        for k in own:
            mesh = shape_mesh(figure.shapes, int(k))
            scene.add_mesh_simple(
                f"{_ALL}/figures/{name}/{label}/{k}",
                mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32),
                color=tuple(int(255 * part) for part in figure.shapes.colour[k]),
                position=figure.shapes.place[k, :3], wxyz=figure.shapes.place[k, 3:],
            )  # fmt: skip
        handles.append((body, handle))
    return handles
