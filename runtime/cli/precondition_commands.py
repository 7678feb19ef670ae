"""What the commands for preconditions do once their arguments are parsed."""

import math
import tempfile
from dataclasses import asdict
from pathlib import Path

import numpy as np

from runtime.cli.commands import Result, check_picture, ready
from runtime.errors import RuntimeInputError
from surefoot.files.archive import check_target
from surefoot.workers.pool import Place

__all__ = ["evaluate_preconditions", "sample_skill", "train_all_preconditions"]


def sample_skill(skill: str, count: int, seed: int, output: Path, place: Place) -> Result:
    """Try ``skill`` from ``count`` starts and write what came of them."""
    from locomotion.training.preconditions.outcomes import sample
    from locomotion.training.preconditions.sampling import ENDS

    check_target(output)
    outcomes = sample(skill, count, seed, output, place, ready())
    ends = dict(zip(ENDS, np.bincount(outcomes.ends, minlength=len(ENDS)).tolist(), strict=True))
    values = {"skill": skill, "seed": seed, "starts": count, "ends": ends, "output": str(output)}

    def show() -> None:
        print(f"{skill}: " + ", ".join(f"{number} {end}" for end, number in ends.items() if number))

    return Result(values, True, show)


def train_all_preconditions(
    seed: int, place: Place, kept: Path | None, effort: float, output: Path | None, replace: bool
) -> Result:
    """Learn the preconditions of all skills. ``output``: a folder, None for the package's. Raises
    `RuntimeInputError` if the package's would be overwritten without ``replace``."""
    from locomotion.preconditions.precondition import precondition_file
    from locomotion.training.preconditions.train import STARTS, sampled_skills, train_preconditions

    there = [skill for skill in sampled_skills() if precondition_file(skill).exists()]
    if output is None and there and not replace:
        raise RuntimeInputError(
            f"{precondition_file(there[0])}: is the built-in precondition of {there[0]}; use --replace to "
            "overwrite them all, or write them to a folder of your own (-o FOLDER)"
        )
    if output is not None and not output.is_dir():
        raise RuntimeInputError(f"{output}: no such folder to write preconditions to")
    ready()
    count = max(round(effort * STARTS), 1)
    learned = train_preconditions(kept or Path("preconditions.checkpoint"), seed, count, place, output)
    values = {each.skill: dict(each.meta) for each in learned}

    def show() -> None:
        for skill, meta in values.items():
            best = ", ".join(f"{name} {counts:.3f}" for name, counts in list(meta["features"].items())[:5])
            print(f"{skill}: {meta['starts']} starts, {100.0 * meta['holds']:.0f} % hold; {best}")

    return Result(values, True, show)


def evaluate_preconditions(trials: int, seed: int, picture: Path | None = None, place: Place = 1) -> Result:
    """Try all skills from ``trials`` starts each and compare what came of them with the odds. ``picture``:
    file for a reliability diagram."""
    from locomotion.preconditions.precondition import load_precondition, precondition_file
    from locomotion.training.preconditions.outcomes import sample
    from locomotion.training.preconditions.train import sampled_skills
    from runtime.evaluation.preconditions import judge
    from runtime.evaluation.reliability_plot import plot_reliability

    if picture is not None:
        check_picture(picture)
    progress, judgements, bins = ready(), [], {}
    with tempfile.TemporaryDirectory() as folder:
        for skill in sampled_skills():
            precondition = load_precondition(precondition_file(skill))
            if precondition.meta["seed"] == seed:
                raise RuntimeInputError(f"seed {seed} is what the odds were learned from; give another")
            outcomes = sample(skill, trials, seed, Path(folder) / f"{skill}.npz", place, progress)
            found, bins[skill] = judge(precondition, outcomes)
            judgements += found
    better = [each.brier < each.usual for each in judgements if each.count >= 50 and not each.within]
    bins = {skill: some for skill, some in bins.items() if some}
    if not better or not bins:
        raise RuntimeInputError(f"{trials} trials give too few moments to judge by; give more")
    if picture is not None:
        plot_reliability(bins, picture)
    rows = [
        {name: None if value != value else value for name, value in asdict(each).items()}
        for each in judgements
    ]
    reliability = {skill: [asdict(each) for each in some] for skill, some in bins.items()}
    values = {"seed": seed, "trials": trials, "judgements": rows, "reliability": reliability}

    def show() -> None:
        print("| skill | asked | sizes | moments | hold | AUC | Brier (usual) | false go | false stop |")
        print("| --- | --- | --- | --- | --- | --- | --- | --- | --- |")
        for each in judgements:
            print(
                f"| {each.skill} | {each.moment} | {'learned' if each.within else 'all'} | {each.count} "
                f"| {_share(each.held)} | {each.area:.2f} | {each.brier:.3f} ({each.usual:.3f}) "
                f"| {_share(each.false_go)} | {_share(each.false_stop)} of {_share(each.stopped)} |"
            )
        for skill, some in bins.items():
            told = ", ".join(f"{each.odds:.2f}: {each.held:.2f} of {each.count}" for each in some)
            print(f"{skill}, odds and share that holds: {told}")

    return Result(values, all(better), show)


def _share(value: float) -> str:
    return "-" if math.isnan(value) else f"{100.0 * value:.0f} %"
