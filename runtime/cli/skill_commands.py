"""What the commands for skills and clips do once their arguments are parsed."""

import os
import sys
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import psutil
from filelock import FileLock, Timeout

from runtime.cli.commands import Result, check_picture, ready
from runtime.errors import RuntimeInputError
from surefoot.files.archive import check_target
from surefoot.files.atomic_write import whole_file
from surefoot.progress import Progress
from surefoot.workers.pool import Place

if TYPE_CHECKING:
    from locomotion.training import progress
    from runtime.evaluation.evaluation import Attempt

__all__ = ["evaluate_skill", "show_clip", "train_library", "train_skill"]

_WITHOUT_A_PLANE = (
    "walk",
    "walk-policy",
    "speed-up",
    "slow-down",
    "brake",
    "brake-residual",
    "slippery-roll",
    "landing-residual",
)
"""Skills whose trials do not vary in two numbers, so that no coverage picture can be drawn."""


def _trainers() -> Mapping[str, Callable[..., Any]]:
    """How each skill is trained, in the order in which they build on one another."""
    from locomotion.skills.registry import skill_kinds
    from locomotion.training.gaits.brake import train_brake
    from locomotion.training.gaits.run import train_run
    from locomotion.training.gaits.slow_down import train_slow_down
    from locomotion.training.gaits.speed_up import train_speed_up
    from locomotion.training.gaits.walk import train_walk
    from locomotion.training.policies.walk import train_walk_policy
    from locomotion.training.residual.train import train_brake_residual, train_landing_residual
    from locomotion.training.skills.slippery_roll import train_slippery_roll

    return {
        "walk": train_walk, "run": train_run, "speed-up": train_speed_up, "slow-down": train_slow_down,
        "brake": train_brake, "brake-residual": train_brake_residual, "walk-policy": train_walk_policy,
        **{kind.skill: kind.train for kind in skill_kinds() if kind.train is not None},
        "slippery-roll": train_slippery_roll, "landing-residual": train_landing_residual,
    }  # fmt: skip


def train_skill(
    skill: str,
    output: Path | None,
    seed: int,
    workers: Place,
    checkpoint: Path | None,
    effort: float,
    replace: bool,
) -> Result:
    """Train ``skill``, a built-in one or one described by a file, and write it to ``output`` (None: where its
    description says, or the built-in place).

    Holds if the learned skill works; only then is it written. The values include the CPU time [min], also
    that of interrupted runs. Raises `RuntimeInputError` if a built-in skill would be overwritten without
    ``replace``, or if another process uses the same checkpoint.
    """
    name = Path(skill).stem
    kept = checkpoint or Path(f"{name}.checkpoint")
    if not kept.parent.is_dir():
        raise RuntimeInputError(f"{kept}: no folder {str(kept.parent)!r} to keep checkpoints in")
    from locomotion.training.skills.jump import train_described
    from locomotion.training.training import NotLearnedError, Training

    trainers = _trainers()
    train, fault = trainers.get(skill, partial(train_described, skill)), ""
    out = _package_file(skill, replace) if output is None and skill in trainers else output
    try:
        with FileLock(f"{kept}.lock", timeout=0):
            timer = _Timer(kept)
            try:
                train(Training(seed, kept, workers, effort, timer.told), out=out)
            except NotLearnedError as error:
                fault = str(error)
            timer.keep()
    except Timeout:
        raise RuntimeInputError(
            f"{kept}: another process is using this checkpoint; wait for it, or use another --checkpoint"
        ) from None
    values = {"skill": skill, "works": not fault, "core-minutes": timer.minutes}

    def show() -> None:
        if fault:
            print(f"surefoot: {fault}. No skill was written; {kept} holds what was learned", file=sys.stderr)
        else:
            print(f"{name} learned in {timer.minutes:.1f} core-minutes; {kept} is no longer needed")
        if output is None:
            _tell_outdated()

    return Result(values, not fault, show)


def _tell_outdated() -> None:
    """Say which corrections and which preconditions belong to skills as they were before."""
    from locomotion.preconditions.precondition import outdated_preconditions
    from locomotion.training.residual.train import outdated_residuals

    for name in outdated_residuals():
        print(
            f"surefoot: {name} corrects skills as they were before; learn it anew (surefoot train {name} "
            "--replace)",
            file=sys.stderr,
        )
    if outdated := outdated_preconditions():
        print(
            f"surefoot: the preconditions of {', '.join(outdated)} belong to the skills before, and are "
            "refused from now on; learn them anew (surefoot train preconditions --replace)",
            file=sys.stderr,
        )


def _package_file(skill: str, replace: bool) -> Path:
    """File of a built-in ``skill``; raises `RuntimeInputError` if it exists and must not be replaced."""
    from locomotion.skills.library import package_skill

    file = package_skill(skill)
    if file.exists() and not replace:
        raise RuntimeInputError(
            f"{file}: is the built-in {skill}; use --replace to overwrite it, or write "
            f"one skill to a file of your own (-o {file.name})"
        )
    return file


class _Timer:
    """CPU time of training, kept in a file beside the checkpoint so that it adds up over interrupted runs."""

    def __init__(self, checkpoint: Path) -> None:
        self._file = Path(f"{checkpoint}.minutes")
        self.minutes = self._before() if checkpoint.exists() and self._file.exists() else 0.0
        self._begun = _cpu_minutes() - self.minutes

    def _before(self) -> float:
        try:
            return float(self._file.read_text(encoding="utf-8"))
        except ValueError:
            raise RuntimeInputError(
                f"{self._file}: expected the minutes trained so far; remove the file to count from zero"
            ) from None

    def told(self, now: "progress.Progress") -> None:
        from locomotion.training.progress import show

        show(now)
        self.keep()

    def keep(self) -> None:
        self.minutes = _cpu_minutes() - self._begun
        with whole_file(self._file) as temporary:
            temporary.write_text(f"{self.minutes:.3f}\n", encoding="utf-8")


def _cpu_minutes() -> float:
    """[min] CPU time of this process and of its workers, those that have ended included."""
    running = (worker.cpu_times() for worker in psutil.Process().children())
    return (sum(os.times()[:4]) + sum(each.user + each.system for each in running)) / 60.0


def train_library(seed: int, workers: Place, effort: float, replace: bool) -> Result:
    """Train all built-in skills in order and print what each cost; stops after the first that does not work.
    Raises `RuntimeInputError` if one would be overwritten without ``replace``."""
    for skill in _trainers():
        _package_file(skill, replace)
    minutes: dict[str, float] = {}
    for skill in _trainers():
        result = train_skill(skill, None, seed, workers, None, effort, replace)
        if not result.held:
            return result
        result.show()
        minutes[skill] = result.values["core-minutes"]
    minutes["in all"] = sum(minutes.values())

    def show() -> None:
        for skill, each in minutes.items():
            print(f"{skill:12} {each:7.1f} core-minutes")

    return Result({"core-minutes": minutes}, True, show)


def evaluate_skill(
    skill: str, trials: int, seed: int, picture: Path | None = None, place: Place = 1
) -> Result:
    """Try ``skill``; holds if at least nine of ten trials of each test do, but for those that are only there
    to compare with. ``picture``: file for a plot of which trials held. ``place``: who makes them."""
    if picture is not None:
        if skill in _WITHOUT_A_PLANE:
            raise RuntimeInputError(
                f"the tests of {skill} do not vary in two numbers that could be plotted; leave --picture out"
            )
        check_picture(picture)
    from runtime.evaluation.evaluate import evaluate

    attempts = evaluate(skill, trials, seed, place, ready())
    if picture is not None:
        from runtime.evaluation.coverage_plot import plot_coverage

        plot_coverage(skill, attempts, picture)
    tests = [
        {
            "test": test,
            "trials": len(tried),
            "held": sum(each.held for each in tried),
            "ends": dict(Counter(each.status for each in tried)),
            "means": _over(tried, np.mean),
            "medians": _over(tried, np.median),
            "percentiles 95": _over(tried, partial(np.percentile, q=95)),
        }
        for test, tried in _by_test(attempts).items()
    ]
    values = {"skill": skill, "seed": seed, "tests": tests, "attempts": [asdict(each) for each in attempts]}

    def show() -> None:
        for attempt in attempts:
            if not attempt.held:
                print(f"{attempt.test}: {attempt.what}: {attempt.status}")
        print(f"| {skill} | held | of those |")
        print("| --- | --- | --- |")
        for test in tests:
            share = 100.0 * test["held"] / test["trials"]
            figures = ", ".join(_shown(test, name) for name in test["means"])
            print(f"| {test['test']} | {share:.1f} % of {test['trials']} | {figures} |")

    compared = {each.test for each in attempts if each.compared}
    counted = [test for test in tests if test["test"] not in compared]
    return Result(values, all(test["held"] >= 0.9 * test["trials"] for test in counted), show)


def _shown(test: dict[str, Any], name: str) -> str:
    """One figure of a test: its mean, and for lengths also median and 95th percentile."""
    mean = f"{name} {test['means'][name]:.3g}"
    if not name.endswith("[m]"):
        return mean
    return f"{mean} (median {test['medians'][name]:.3g}, 95 % up to {test['percentiles 95'][name]:.3g})"


def _by_test(attempts: Sequence["Attempt"]) -> dict[str, list["Attempt"]]:
    """The attempts of each test, in order."""
    return {test: [a for a in attempts if a.test == test] for test in dict.fromkeys(a.test for a in attempts)}


def _over(attempts: Sequence["Attempt"], statistic: Callable[[list[float]], Any]) -> dict[str, float]:
    """A ``statistic`` of each figure, over the attempts that have it."""
    names = dict.fromkeys(name for each in attempts for name in each.figures)
    return {
        name: float(statistic([each.figures[name] for each in attempts if name in each.figures]))
        for name in names
    }


def show_clip(
    source: Path,
    mapping: Path | None,
    units: str,
    up: str,
    stretch: tuple[float, float] | None,
    mirror: bool,
    film: Path | None,
    output: Path | None,
) -> Result:
    """Check a clip or captured motion, or a ``stretch`` of it [s]; draw it to ``film``, and save it to
    ``output`` as a motion or as keyframes."""
    from locomotion.clips.keyframes import keyframes_of, mirrored, save_clip, stretch_of
    from locomotion.clips.motion_check import check_motion
    from runtime.cli.clips import read_motion, write_motion_film

    motion = read_motion(source, mapping, units, up)
    if film is not None:
        check_picture(film)
    if output is not None:
        check_target(output)
    keyframes = output is not None and output.suffix.lower() in (".yaml", ".yml")
    if output is not None and not keyframes and output.suffix.lower() != ".npz":
        raise RuntimeInputError(f"{output}: a motion is written to .npz, keyframes to .yaml")
    if stretch is not None:
        motion = stretch_of(motion, *stretch)
    if mirror:
        motion = mirrored(motion)
    faults = check_motion(motion)
    if film is not None:
        write_motion_film(motion, film, Progress())
    if output is not None:
        if keyframes:
            save_clip(keyframes_of(motion), output)
        else:
            motion.save(output)
    values = {
        "name": motion.name,
        "seconds": round(motion.duration, 3),
        "rate": motion.rate,
        "faults": [asdict(fault) for fault in faults],
    }

    def show() -> None:
        print(f"{motion.name}: {motion.duration:.2f} s at {motion.rate:.0f} Hz")
        print("\n".join(f"  {fault}" for fault in faults) or "  within its joint ranges, on the ground")

    return Result(values, not faults, show)
