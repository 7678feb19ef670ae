"""Location of the shared levels, queries and peers for benchmarks and tests, which are not part of the
product.

The environment variable ``SUREFOOT_SHARED`` names the folder; the default is ``shared`` beside the
repository.
"""

import os
from pathlib import Path

__all__ = ["LEVELS", "level_path", "queries_path", "shared_folder", "why_absent"]

LEVELS = ("nav_test", "dungeon", "undulating")
"""The three levels of the benchmark, Y up, in metres."""


def shared_folder() -> Path | None:
    """The folder of shared data, or None when this machine does not have it."""
    named = os.environ.get("SUREFOOT_SHARED")
    folder = Path(named) if named else Path(__file__).resolve().parents[2] / "shared"
    return folder if (folder / "levels").is_dir() else None


def why_absent() -> str:
    """The reason to give when something is skipped because `shared_folder` is None."""
    return "no shared data: set SUREFOOT_SHARED to the folder that holds levels/ and bench/"


def _inside(*parts: str) -> Path:
    folder = shared_folder()
    if folder is None:
        raise FileNotFoundError(why_absent())
    return folder.joinpath(*parts)


def level_path(name: str) -> Path:
    """The OBJ file of one of `LEVELS`."""
    return _inside("levels", f"{name}.obj")


def queries_path(name: str) -> Path:
    """The CSV file with 2,000 start and goal pairs on one of `LEVELS`."""
    return _inside("bench", "queries", f"{name}.csv")
