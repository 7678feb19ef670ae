"""What every command does first and last."""

import json
from dataclasses import dataclass, field

import pytest
import typer

from runtime.cli.starting import finish, inputs, reads


@dataclass
class Answer:
    held: bool
    values: dict = field(default_factory=lambda: {"way": 3.5})
    show = staticmethod(lambda: print("as words"))


@pytest.mark.parametrize("as_json", [False, True])
def test_a_result_is_printed_and_what_does_not_hold_is_exit_code_1(capsys, as_json):
    finish(Answer(True), as_json)
    with pytest.raises(typer.Exit) as left:
        finish(Answer(False), as_json)
    assert left.value.exit_code == 1
    told = json.dumps({"way": 3.5}, indent=1) if as_json else "as words"
    assert capsys.readouterr().out == f"{told}\n{told}\n"


def test_files_that_a_command_reads_are_noted(monkeypatch):
    monkeypatch.setattr("runtime.cli.starting.inputs", noted := [])
    assert reads("a.obj") == "a.obj" and reads(["b", "c"]) == ["b", "c"] and reads(None) is None
    assert noted == ["a.obj", "b", "c"] and noted is not inputs
