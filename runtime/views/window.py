"""A page with moving bodies, drawn by a thread of its own.

The caller leaves a new moment and continues; the newest is drawn when there is time.
"""

import threading
import time
from collections import deque
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from runtime.bodies.figure import Figure, Shapes, rotate
from runtime.traces.trace import LevelTrace, PathTrace
from runtime.views.scenery import ALL, draw_level, draw_paths, silent

__all__ = ["Moment", "Window"]

_FRAME = 1 / 30
"""[s] least time between pictures."""
_KEPT, _APART = 600, 0.1
"""Moments on the time line, and [s] of world time between them."""
_CALM = 0.25  # [s] in which the camera covers most of its distance to the figure
_FROM, _NEAR = np.array([-0.25, -0.5, 0.5]), 5.0
"""Initial camera direction, and distance [m] from the figure."""
_NOBODY = "nobody"


@dataclass(frozen=True)
class Moment:
    """A moment to draw: ``level``, ``figures`` by name, ``poses`` (n, 7) of all their bodies one after the
    other, and their ``paths``, at ``time`` [s]."""

    time: float
    level: LevelTrace
    figures: Mapping[str, Figure]
    poses: np.ndarray
    paths: tuple[PathTrace, ...]


class Window:
    """A page at ``address`` that shows what is passed to `show`, with a time line and a camera that follows.
    ``host``: only this machine by default. ``port``: 0 for any free port."""

    def __init__(self, level: LevelTrace, host: str = "127.0.0.1", port: int = 0) -> None:
        import viser

        with silent():
            self._server = viser.ViserServer(host=host, port=port, verbose=False)
        self.address = f"http://{host}:{self._server.get_port()}"
        scene = self._server.scene
        scene.set_up_direction("+z")
        self._everything = scene.add_frame(ALL, show_axes=False)
        low, high = level.vertices.min(axis=0), level.vertices.max(axis=0)
        self._middle = 0.5 * (low + high)
        self._server.initial_camera.look_at = tuple(self._middle)
        self._server.initial_camera.position = tuple(self._middle + max((high - low)[:2].max(), 8.0) * _FROM)
        self._level: LevelTrace | None = None
        self._ground: Any = None
        self._show_level(level)
        self._paths: tuple[PathTrace, ...] = ()
        self._bodies = _Bodies(scene, {})
        self._changed = threading.Condition()
        self._newest: Moment | None = None
        self._seen: deque[Moment] = deque(maxlen=_KEPT)
        self._news = self._closing = False
        self._add_controls()
        self._thread = threading.Thread(target=self._draw_all, name="surefoot view", daemon=True)
        self._thread.start()

    @property
    def watched(self) -> bool:
        """Whether a browser shows it."""
        return bool(self._server.get_clients())

    @property
    def is_live(self) -> bool:
        """Whether it shows the newest moment."""
        return self._live.value

    def show(self, moment: Moment) -> None:
        """Draw ``moment`` when there is time, unless a newer one comes first; does not wait."""
        with self._changed:
            self._newest, self._news = moment, True
            self._changed.notify()

    def close(self) -> None:
        """Close the page."""
        with self._changed:
            self._closing = True
            self._changed.notify()
        self._thread.join()
        with silent():
            self._server.stop()

    # --- controls
    def _add_controls(self) -> None:
        gui = self._server.gui
        self._follow: Any = gui.add_dropdown("follow", (_NOBODY,))
        self._live = gui.add_checkbox("live", initial_value=True)
        self._time = gui.add_slider("time [s]", min=0.0, max=0.1, step=_APART, initial_value=0.0)

        @self._live.on_update
        def _(_: Any) -> None:
            self._wake()

        @self._follow.on_update
        def _(event: Any) -> None:
            if event.client is not None and self._follow.value != _NOBODY:
                event.client.camera.look_at = tuple(self._middle)
                event.client.camera.position = tuple(self._middle + _NEAR * _FROM)
            self._wake()

        @self._time.on_update
        def _(event: Any) -> None:
            if event.client is not None:  # moved by hand
                self._live.value = False
                self._wake()

    def _wake(self) -> None:
        with self._changed:
            self._news = True
            self._changed.notify()

    # --- drawing
    def _draw_all(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closing or self._news)
                if self._closing:
                    return
                newest, self._news = self._newest, False
            begun = time.monotonic()
            if newest is not None:
                self._keep(newest)
                with self._server.atomic():
                    self._draw(self._chosen(newest))
            time.sleep(max(_FRAME - (time.monotonic() - begun), 0.0))

    def _chosen(self, newest: Moment) -> Moment:
        """The newest moment, or the one on the time line."""
        if self._live.value:
            return newest
        return min(self._seen, key=lambda moment: abs(moment.time - self._time.value))

    def _keep(self, moment: Moment) -> None:
        """Add a moment to the time line."""
        if self._seen and moment.time < self._seen[-1].time:
            self._seen.clear()  # the world was restored to an earlier moment
        if self._seen and moment.time - self._seen[-1].time < _APART:
            return
        self._seen.append(moment)
        if len(self._seen) > 1:
            self._time.max = moment.time
            self._time.min = self._seen[0].time
        if self._live.value:
            self._time.value = moment.time

    def _draw(self, moment: Moment) -> None:
        scene = self._server.scene
        self._show_level(moment.level)
        if not _same(self._paths, moment.paths):
            self._paths = moment.paths
            draw_paths(scene, f"{ALL}/paths", moment.paths)
        if not self._bodies.are(moment.figures):
            self._bodies = _Bodies(scene, moment.figures)
            self._follow.options = (_NOBODY, *moment.figures)
        self._bodies.draw(moment.poses)
        self._go_with(moment)

    def _show_level(self, level: LevelTrace) -> None:
        if self._level is not level:
            if self._ground is not None:
                self._ground.remove()
            self._level, self._ground = level, draw_level(self._server.scene, level)

    def _go_with(self, moment: Moment) -> None:
        """Move everything so that the figure stays in front of the camera, which the user controls."""
        root = self._bodies.root_of.get(self._follow.value)
        here = np.asarray(self._everything.position)
        wanted = np.zeros(3) if root is None else self._middle - moment.poses[root, :3]
        share = min(_FRAME / _CALM, 1.0)
        self._everything.position = wanted if root is None else here + share * (wanted - here)


class _Bodies:
    """All figures as two batches: balls, and tubes between the two balls of a capsule."""

    def __init__(self, scene: Any, figures: Mapping[str, Figure]) -> None:
        import trimesh

        self._figures = dict(figures)
        each = list(figures.values())
        starts = np.cumsum([0, *(len(figure.bodies) for figure in each)])
        self.root_of = dict(zip(figures, starts[:-1].tolist(), strict=True))
        own = Shapes(
            *(
                np.concatenate([np.empty(empty), *(getattr(figure.shapes, name) for figure in each)])
                for name, empty in (("place", (0, 7)), ("size", (0, 3)), ("round", 0), ("colour", (0, 3)))
            )
        )
        owner = [figure.owner + start for figure, start in zip(each, starts[:-1], strict=True)]
        self._all = Figure((), np.empty(0), np.concatenate([np.empty(0, np.int64), *owner]), own)
        self._round = own.round.astype(bool)
        colour = (255.0 * own.colour).astype(np.uint8)
        tube, size = ~self._round, own.size
        radius = size[tube, :1]
        ball = trimesh.creation.icosphere(subdivisions=2)
        pipe = trimesh.creation.cylinder(radius=1.0, height=2.0, sections=16, cap=False)
        balls = np.concatenate([size[self._round], *[np.repeat(radius, 3, axis=1)] * 2])
        tubes = np.column_stack([radius, radius, size[tube, 1:2]])
        self._balls = self._batch(
            scene, "balls", ball, balls, np.concatenate([colour[self._round], *[colour[tube]] * 2])
        )
        self._tubes = self._batch(scene, "tubes", pipe, tubes, colour[tube])

    def _batch(self, scene: Any, name: str, mesh: Any, scales: np.ndarray, colours: np.ndarray) -> Any:
        name = f"{ALL}/figures/{name}"
        if not len(scales):
            scene.add_frame(name, show_axes=False)
            return None
        places = np.zeros((len(scales), 3), dtype=np.float32)
        turns = np.tile(np.array([1.0, 0.0, 0.0, 0.0], dtype=np.float32), (len(scales), 1))
        return scene.add_batched_meshes_simple(
            name, mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32), turns, places,
            batched_scales=scales.astype(np.float32), batched_colors=colours, lod="off",
        )  # fmt: skip

    def are(self, figures: Mapping[str, Figure]) -> bool:
        """Whether these are the same figures."""
        return list(figures) == list(self._figures) and _same(figures.values(), self._figures.values())

    def draw(self, poses: np.ndarray) -> None:
        """``poses`` (n, 7) of all bodies."""
        placed = self._all.posed(poses)
        ball, tube = placed.place[self._round], placed.place[~self._round]
        half = np.zeros((len(tube), 3))
        half[:, 2] = placed.size[~self._round, 1]
        along = rotate(tube[:, 3:], half)
        if self._balls is not None:
            self._balls.batched_positions = np.concatenate(
                [ball[:, :3], tube[:, :3] + along, tube[:, :3] - along]
            ).astype(np.float32)
            self._balls.batched_wxyzs = np.concatenate([ball[:, 3:], tube[:, 3:], tube[:, 3:]]).astype(
                np.float32
            )
        if self._tubes is not None:
            self._tubes.batched_positions = tube[:, :3].astype(np.float32)
            self._tubes.batched_wxyzs = tube[:, 3:].astype(np.float32)


def _same(some: Collection[object], others: Collection[object]) -> bool:
    """Whether these are the very same objects in the same order."""
    return len(some) == len(others) and all(a is b for a, b in zip(some, others, strict=True))
