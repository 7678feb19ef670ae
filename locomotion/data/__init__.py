"""Data of the package: learned skills, clips, descriptions of bodies. No code."""

from pathlib import Path

__all__ = ["BODIES", "CLIPS", "SKILLS"]

_HERE = Path(__file__).parent
SKILLS, CLIPS, BODIES = _HERE / "skills", _HERE / "clips", _HERE / "bodies"
