"""Data of the package: learned skills, clips, descriptions of bodies, recorded motions, names of bones. No
code."""

from pathlib import Path

__all__ = ["BODIES", "CHARACTERS", "CLIPS", "MOTIONS", "POSTURES", "PRECONDITIONS", "SKILLS"]

_HERE = Path(__file__).parent
PRECONDITIONS = _HERE / "preconditions"
SKILLS, CLIPS, BODIES = _HERE / "skills", _HERE / "clips", _HERE / "bodies"
POSTURES, MOTIONS, CHARACTERS = _HERE / "postures", _HERE / "motions", _HERE / "characters"
