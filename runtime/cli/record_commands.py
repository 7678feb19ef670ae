"""What the command that records motion does once its arguments are parsed."""

from collections import Counter
from pathlib import Path

from locomotion.postures.posture_file import load_postures
from locomotion.recorded.motion_set import MotionSet, load_motions
from locomotion.recorded.recorder import record_person
from locomotion.recorded.skeletons import LEVELS, skeleton
from runtime.cli.commands import Result
from runtime.errors import RuntimeInputError
from surefoot.files.archive import check_target
from surefoot.progress import Progress

__all__ = ["list_motions", "record_motions"]


def record_motions(graph: Path, output: Path) -> Result:
    """Record the motions of the person and of a posture ``graph`` (.yaml), and write them to ``output``."""
    if output.suffix.lower() != ".npz":
        raise RuntimeInputError(f"{output}: motions are written as .npz; use that ending")
    check_target(output)
    recorded = record_person(load_postures(graph), f"keys and motions of {graph.name}", Progress())
    recorded.motions.save(output)
    values = {"output": str(output), **_values(recorded.motions), "warnings": list(recorded.warnings)}

    def show() -> None:
        print(_summary(recorded.motions))
        print("\n".join(recorded.warnings) or "all hands and feet are within their tolerances")
        print(f"written to {output}, {output.stat().st_size / 1e6:.2f} MB")

    return Result(values, True, show)


def list_motions(motions: Path | None) -> Result:
    """List the clips of a set of motions, or of the package's own, and where each comes from."""
    found = load_motions() if motions is None else load_motions(motions)

    def show() -> None:
        print(_summary(found))
        for clip in found.clips:
            print(f"  {clip.name}: {clip.kind}, {clip.seconds:.2f} s; {clip.origin}")

    return Result(_values(found), True, show)


def _values(motions: MotionSet) -> dict:
    return {"clips": [clip.model_dump() for clip in motions.clips]}


def _summary(motions: MotionSet) -> str:
    kinds = Counter(clip.kind for clip in motions.clips)
    parts = ", ".join(f"{count} of kind {kind}" for kind, count in kinds.items())
    levels = ", ".join(
        f"{name}: {len(skeleton(name).channels)} joints at {skeleton(name).rate:g} Hz" for name in LEVELS
    )
    return f"{len(motions.clips)} clips ({parts}); {levels}"
