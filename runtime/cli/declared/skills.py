"""Commands on what bodies learn and do: ``surefoot train``, ``evaluate``, ``clip`` and so on."""

from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperCommand

from runtime.cli.declared.options import ClusterOption, JsonOption, Up
from runtime.cli.starting import begin, finish, loaded, reads

PRECONDITIONS = "preconditions"
"""What is trained and evaluated of all skills together."""


def _skills() -> tuple[str, ...]:
    """What can be trained: gaits, skills that clear obstacles, and when these hold."""
    loaded()
    from locomotion.skills.registry import skill_words

    return (
        "run",
        "walk",
        "walk-policy",
        "speed-up",
        "slow-down",
        "brake",
        "brake-residual",
        *skill_words(),
        "slippery-roll",
        "landing-residual",
        PRECONDITIONS,
    )


def _skill(name: str) -> str:
    if not name.endswith((".yaml", ".yml")) and name not in _skills():
        raise typer.BadParameter(
            f"{name!r}: valid: {', '.join(_skills())}, or the .yaml file that describes one"
        )
    return name


SkillArgument = typer.Argument(
    parser=_skill, callback=reads,
    help="A built-in skill, or the file (.yaml) that describes one of your own.",
)  # fmt: skip


class OnSkills(TyperCommand):
    """A command on a skill. Which there are is looked up only when it is called: that imports a lot."""

    def get_params(self, ctx: Any) -> list[Any]:
        parameters = super().get_params(ctx)
        for parameter in parameters:
            if parameter.name == "skill":
                parameter.metavar = f"[{'|'.join(_skills())}|FILE.yaml]"
        return parameters


def train(
    skill: Annotated[str | None, SkillArgument] = None,
    everything: Annotated[
        bool, typer.Option("--all", help="Train all built-in skills, one after another.")
    ] = False,
    output: Annotated[
        Path | None,
        typer.Option(
            "--output",
            "-o",
            help="Output file for the skill (preconditions: a folder); default: as FILE.yaml says, or the "
            "built-in one (--replace).",
        ),
    ] = None,
    seed: Annotated[int, typer.Option(min=0, help="The same seed gives the same skill.")] = 0,
    workers: Annotated[int, typer.Option(min=1, help="Processes.")] = 2,
    cluster: ClusterOption = None,
    checkpoint: Annotated[
        Path | None,
        typer.Option(
            help="Folder for intermediate results; default: SKILL.checkpoint in the current folder."
        ),
    ] = None,
    effort: Annotated[
        float,
        typer.Option(min=0.01, max=100.0, help="Multiplies the generations, or starts."),
    ] = 1.0,
    replace: Annotated[bool, typer.Option("--replace", help="Overwrite the built-in skills.")] = False,
) -> None:
    """Train a skill, or the preconditions of all skills. If interrupted, run it again to continue from its
    checkpoint. A skill that never works is not written, and the exit code is 1."""
    if (skill is None) is not everything or (everything and (output or checkpoint)):
        raise typer.BadParameter("name one skill, or --all without --output and --checkpoint")
    begin()
    from runtime.cli import skill_commands
    from runtime.cli.precondition_commands import train_all_preconditions

    if skill == PRECONDITIONS:
        result = train_all_preconditions(seed, cluster or workers, checkpoint, effort, output, replace)
    elif skill is None:
        result = skill_commands.train_library(seed, cluster or workers, effort, replace)
    else:
        result = skill_commands.train_skill(
            skill, output, seed, cluster or workers, checkpoint, effort, replace
        )
    finish(result, as_json=False)


def evaluate(
    skill: Annotated[str, SkillArgument],
    trials: Annotated[int, typer.Option(min=1, help="Number of trials in each test.")] = 20,
    seed: Annotated[int, typer.Option(min=0, help="Of the trials.")] = 0,
    picture: Annotated[
        Path | None, typer.Option(help="Output file for a picture of which trials held (.png).")
    ] = None,
    processes: Annotated[
        int, typer.Option(min=1, help="Number of processes; does not change the result.")
    ] = 1,
    cluster: ClusterOption = None,
    as_json: JsonOption = False,
) -> None:
    """Try a learned skill from many starts and print how often it holds; of preconditions, how good their
    odds are."""
    begin()
    from runtime.cli.precondition_commands import evaluate_preconditions
    from runtime.cli.skill_commands import evaluate_skill

    if skill == PRECONDITIONS:
        finish(evaluate_preconditions(trials, seed, picture, cluster or processes), as_json)
    else:
        finish(evaluate_skill(skill, trials, seed, picture, cluster or processes), as_json)


def _sampled(name: str) -> str:
    loaded()
    from locomotion.training.preconditions.train import sampled_skills

    if name not in sampled_skills():
        raise typer.BadParameter(f"{name!r}: valid: {', '.join(sampled_skills())}")
    return name


def sample(
    skill: Annotated[
        str,
        typer.Argument(parser=_sampled, metavar="SKILL", help="A skill for obstacles, or a change of gait."),
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="Output file (.npz).")],
    count: Annotated[int, typer.Option(min=1, help="Number of starts.")] = 1000,
    seed: Annotated[int, typer.Option(min=0, help="Of the starts.")] = 0,
    processes: Annotated[int, typer.Option(min=1, help="Number of processes; does not change the file.")] = 1,
    cluster: ClusterOption = None,
    as_json: JsonOption = False,
) -> None:
    """Try a skill without rehearsals from many starts, easy and hopeless ones, and write what comes of them.
    If interrupted, run it again to continue."""
    begin()
    from runtime.cli.precondition_commands import sample_skill

    finish(sample_skill(skill, count, seed, output, cluster or processes), as_json)


def clip(
    source: Annotated[
        Path,
        typer.Argument(
            callback=reads, help="Clip of keyframes (.yaml), captured motion (.bvh) or saved motion (.npz)."
        ),
    ],
    mapping: Annotated[
        Path | None,
        typer.Option(
            "--map",
            callback=reads,
            help="File that maps parts of the person to joints of the capture (.yaml).",
        ),
    ] = None,
    units: Annotated[str, typer.Option(help="Unit of length of a .bvh file: m, cm, mm, in or ft.")] = "cm",
    up: Annotated[Up, typer.Option(help="Up axis of a .bvh file.")] = Up.y,
    film: Annotated[Path | None, typer.Option(help="Output file for a film strip (.png).")] = None,
    stretch: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="BEGIN END", help="[s] Part of the motion to use."),
    ] = None,
    mirror: Annotated[bool, typer.Option("--mirror", help="Swap left and right.")] = False,
    output: Annotated[
        Path | None,
        typer.Option("--output", "-o", help="Output file for the motion (.npz) or its keyframes (.yaml)."),
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Show a motion and report where it exceeds joint ranges, sinks into the ground or floats."""
    begin()
    from runtime.cli.skill_commands import show_clip

    finish(show_clip(source, mapping, units, up.value, stretch, mirror, film, output), as_json)
