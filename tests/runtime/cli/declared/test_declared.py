"""The commands as one types them."""

import inspect
import subprocess
import sys
from enum import Enum

import pytest
import typer

from runtime.cli.app import app
from runtime.cli.declared import (
    kernels,
    levels,
    missions,
    motions,
    options,
    playtests,
    servers,
    skills,
    views,
)

GROUPS = (kernels, levels, missions, motions, playtests, servers, skills, views)
COMMANDS = typer.main.get_command(app).commands  # type: ignore[attr-defined]


@pytest.mark.parametrize("group", GROUPS, ids=lambda group: group.__name__.rpartition(".")[2])
def test_what_a_module_declares_is_a_command(group):
    own = [
        name
        for name, each in inspect.getmembers(group, inspect.isfunction)
        if each.__module__ == group.__name__ and not name.startswith("_")
    ]
    assert own and set(own) <= set(COMMANDS)


def test_every_command_and_every_option_says_what_it_is():
    for name, command in COMMANDS.items():
        assert command.help, name
        for each in command.params:
            assert getattr(each, "help", None), f"{name}: {each.name}"


def test_help_imports_nothing_that_takes_long():
    program = (
        "import sys; from runtime.cli.app import main\n"
        "try: main(['--help'])\nexcept SystemExit: pass\n"
        "print([name for name in ('numpy', 'mujoco', 'runtime.cli.commands') if name in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.endswith("[]\n")


def test_an_axis_is_one_of_three():
    assert issubclass(options.Up, Enum) and [each.value for each in options.Up] == ["x", "y", "z"]
