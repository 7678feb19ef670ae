"""Compiling the kernels before they are needed, so that a first run says what it waits for."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

import navmesh
from runtime.progress import Progress
from surefoot.compiling import TIME, counted

__all__ = ["compile_kernels", "is_compiled", "load_kernels", "prepare"]

KERNEL_MODULES = (
    ("navmesh", "search"),
    ("pathsmooth", "kernels"),
    ("locomotion", "jump"),
    ("locomotion/quadruped", "advance"),
    ("locomotion/crowd", "advance"),
)
"""Folder and module of kernels that a first run compiles, the last ones among them."""

_EDGE = 12.0  # [m]
_KERNELS = 400  # that are compiled, about


def is_compiled() -> bool:
    """Whether compiled kernels of the main packages, as they are now, lie in Numba's cache."""
    import numba

    root = Path(navmesh.__file__).parent.parent
    chosen = numba.config.CACHE_DIR  # type: ignore[attr-defined]
    elsewhere = Path(chosen) if chosen else Path.home() / ".cache" / "numba"
    for package, module in KERNEL_MODULES:
        made = (root / package / f"{module}.py").stat().st_mtime
        kept = [] if chosen else [*(root / package / "__pycache__").glob(f"{module}.*.nbi")]
        kept = kept or [*elsewhere.rglob(f"{module}.*.nbi")]
        if not any(index.stat().st_mtime >= made for index in kept):
            return False
    return True


def prepare(progress: Callable[[float, str], object] | None = None) -> None:
    """Compile all kernels and keep them on this machine, so that nothing compiles later: 3 to 6 minutes the
    first time, a second or two afterwards. For the start of a program, or the building of an image.

    ``progress(share, what)`` is called as it goes on, ``share`` from 0 to 1.
    """
    _compile(progress or (lambda share, what: None))


def compile_kernels(progress: Progress) -> None:
    """`prepare`, told as a stage of ``progress``."""
    with progress.stage(f"compiling kernels, once: {TIME}") as stage:
        _compile(stage.update)


def _compile(told: Callable[[float, str], object]) -> None:
    """Run everything once on a level of a few metres: compiles every kernel and keeps it in the cache."""
    from runtime.world import World

    doing = "navigation graph"

    def one(count: int) -> None:
        told(min(count / _KERNELS, 1.0), doing)

    with counted(one):
        told(0.0, doing)
        world = World(_tiny_level())
        doing = "paths"
        agent = world.spawn("human", (1.5, 2.0, 0.0))
        agent.go_to((16.5, 2.0, 0.4), speed=3.0)
        doing = "running and jumping"
        while agent.moving and agent.status != "jumping" and world.time < 15.0:
            world.step(0.1)
        world.step(0.1)
        doing = "dogs and walkers"
        dog = world.spawn("dog", (1.5, 1.0, 0.0))
        dog.go_to((4.5, 1.0, 0.0), speed=1.5)
        walker = world.spawn("walker", (1.5, 3.0, 0.0))
        walker.go_to((4.5, 3.0, 0.0), speed=1.5)
        world.step(0.5)
    told(1.0, doing)


def load_kernels() -> None:
    """Let one of each kind take a step, so that the first one of somebody who waits for it takes no longer
    than the others."""
    from runtime.world import World

    world = World(_tiny_level())
    for y, body in enumerate(("human", "dog", "walker"), start=1):
        world.spawn(body, (1.5, y, 0.0)).go_to((4.5, y, 0.0), speed=1.0)
    world.step(0.1)


def _tiny_level() -> navmesh.Terrain:
    """A floor of 12 x 4 m, long enough to run up, before a platform of 0.4 m."""
    corners, faces = [], []
    for x0, x1, z in ((0.0, _EDGE, 0.0), (_EDGE, 18.0, 0.4)):
        faces += [[len(corners) + k for k in triangle] for triangle in ((0, 1, 2), (0, 2, 3))]
        corners += [(x0, 0.0, z), (x1, 0.0, z), (x1, 4.0, z), (x0, 4.0, z)]
    faces += [[len(corners) + k for k in triangle] for triangle in ((0, 1, 2), (0, 2, 3))]
    corners += [(_EDGE, 4.0, 0.0), (_EDGE, 0.0, 0.0), (_EDGE, 0.0, 0.4), (_EDGE, 4.0, 0.4)]
    return navmesh.Terrain.from_arrays(np.array(corners), np.array(faces), name="warm-up level")
