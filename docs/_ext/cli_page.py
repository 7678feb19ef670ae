"""The page of all commands, as ``surefoot COMMAND --help`` tells of them."""

from typing import Any

import typer

from runtime.cli.app import app


def page() -> str:
    """Markdown: each command with its arguments and options."""
    group: Any = typer.main.get_command(app)
    parts = [
        "# Commands",
        f"{group.help} `surefoot COMMAND --help` prints the same as this page.",
        *(_command(name, command) for name, command in sorted(group.commands.items())),
    ]
    return "\n\n".join(parts) + "\n"


def _command(name: str, command: Any) -> str:
    context = command.make_context(name, [], resilient_parsing=True)
    usage = " ".join(["surefoot", name, *command.collect_usage_pieces(context)])
    about = " ".join(command.help.split())
    parts = [f"## surefoot {name}", f"    {usage}", about]
    rows = [_row(parameter, context) for parameter in command.params if parameter.name != "help"]
    if rows:
        parts.append("\n".join(["| | |", "| --- | --- |", *rows]))
    return "\n\n".join(parts)


def _row(parameter: Any, context: Any) -> str:
    shown, about = parameter.get_help_record(context)
    return f"| `{_cell(shown)}` | {_cell(about)} |"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
