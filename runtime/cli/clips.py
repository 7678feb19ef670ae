"""Load clips and captured motions for the command line, and draw them as film strips."""

import os
from pathlib import Path
from typing import TYPE_CHECKING

import mujoco
import numpy as np

from locomotion.body.models import figure
from locomotion.clips.bvh import read_bvh
from locomotion.clips.clip import load_clip
from locomotion.clips.motion import Motion, load_motion, motion_of_clip
from locomotion.clips.retargeting import load_mapping, retarget
from runtime.bodies.figure import Figure
from runtime.errors import RuntimeInputError
from runtime.views.filmstrip import show_frame
from runtime.views.render import Camera, Triangles, render
from surefoot.files.atomic_write import whole_file
from surefoot.progress import Progress

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["MotionArtist", "read_motion", "write_motion_film"]

_FRAMES, _COLUMNS = 8, 4
_SIZE = (400, 330)
_FROM = np.array([-0.8, -3.2, 0.3])  # [m] from the figure to the camera
_GROUND = 50.0  # [m]


def read_motion(source: Path, mapping: Path | None, units: str, up: str) -> Motion:
    """A motion from keyframes (.yaml), a capture (.bvh, which needs a ``mapping``) or a saved motion
    (.npz)."""
    kind = source.suffix.lower()
    if kind in (".yaml", ".yml"):
        return motion_of_clip(load_clip(source))
    if kind == ".npz":
        return load_motion(source)
    if kind != ".bvh":
        raise RuntimeInputError(f"{source}: a motion is a .yaml, .bvh or .npz file, not {kind or 'this'}")
    if mapping is None:
        raise RuntimeInputError(f"{source}: a capture needs a file that maps its joints (--map FILE)")
    joints = load_mapping(mapping)
    return retarget(read_bvh(source, units, up), joints)


class MotionArtist:
    """Draws the person in any pose, on level ground, seen from its right."""

    def __init__(self) -> None:
        self._model = figure()
        self._data, self._figure = mujoco.MjData(self._model), Figure.from_model(self._model)
        corners = _GROUND * np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
        self._ground = Triangles(corners, np.array([[0, 1, 2], [0, 2, 3]]))

    def draw(self, axes: "Axes", pose: np.ndarray, label: str) -> None:
        """Draw a ``pose`` (46,), the person's ``qpos``, with its ``label``."""
        self._data.qpos[:] = pose
        mujoco.mj_kinematics(self._model, self._data)
        target = np.array([pose[0], pose[1], max(pose[2] - 0.1, 0.5)])
        shapes = self._figure.posed(np.hstack([self._data.xpos, self._data.xquat])[1:])
        show_frame(axes, render(self._ground, [shapes], Camera(target + _FROM, target, 0.62), _SIZE), label)


def write_motion_film(motion: Motion, path: str | os.PathLike[str], progress: Progress) -> None:
    """Draw eight moments of a motion, seen from its right, to ``path`` (PNG). The file appears whole or not
    at all."""
    from matplotlib.figure import Figure as Page

    rows = -(-_FRAMES // _COLUMNS)
    page = Page(figsize=(_COLUMNS * 3.2, rows * 2.64 + 0.4), dpi=125, layout="constrained")
    page.suptitle(motion.name, fontsize=11)
    artist, picks = MotionArtist(), np.linspace(0, len(motion.qpos) - 1, _FRAMES).round().astype(int)
    with progress.stage("drawing the film strip") as stage:
        for k, (axes, pick) in enumerate(zip(page.subplots(rows, _COLUMNS).flat, picks, strict=True)):
            stage.update(k / _FRAMES)
            artist.draw(axes, motion.qpos[pick], f"{pick / motion.rate:.2f} s")
    with whole_file(path) as temporary:
        page.savefig(temporary, format="png")
