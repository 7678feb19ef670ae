"""Which releases decide the last bit of a result, so that workers with others can be refused."""

import platform
from importlib.metadata import version

__all__ = ["differences", "own_versions"]

_DECIDING = ("surefoot", "numpy", "scipy", "numba", "mujoco", "trimesh")


def own_versions() -> dict[str, str]:
    """Releases of this process: of Python and of what computes."""
    return {"python": platform.python_version(), **{name: version(name) for name in _DECIDING}}


def differences(ours: dict[str, str], theirs: dict[str, str]) -> str:
    """What differs, in words; "" where nothing does."""
    names = [*ours, *(name for name in theirs if name not in ours)]
    return ", ".join(
        f"{name} {theirs.get(name, 'is missing')} (here {ours.get(name, 'none')})"
        for name in names
        if ours.get(name) != theirs.get(name)
    )
