"""`surefoot postures`: what it prints, draws and returns."""

import json

import pytest

from runtime.cli.app import main
from tests.locomotion.postures.test_playback import PERSON
from tests.locomotion.postures.test_posture_file import GRAPH, written


def run(*arguments):
    with pytest.raises(SystemExit) as end:
        main(["postures", *map(str, arguments)])
    return end.value.code


def test_a_graph_is_listed_and_drawn(tmp_path, capsys):
    film = tmp_path / "bow.png"
    assert run(written(tmp_path, GRAPH), "--film", film, "--json") == 0
    found = json.loads(capsys.readouterr().out)
    assert found["postures"] == ["stand", "bow"] and found["faults"] == []
    assert found["arcs"][1] == {"from": "bow", "to": "stand", "seconds": 0.5}
    assert film.read_bytes().startswith(b"\x89PNG")


def test_faults_are_printed_and_make_it_fail(tmp_path, capsys):
    file = written(tmp_path, GRAPH.replace("waist_pitch: 40", "waist_pitch: 80"))
    assert run(file) == 1
    assert f"{file}:3:" in capsys.readouterr().out
    assert run(PERSON) == 0
    assert "nothing is wrong" in capsys.readouterr().out


def test_a_wrong_file_is_refused(tmp_path, capsys):
    assert run(written(tmp_path, "postures: {}")) == 2
    assert "a graph has at least one posture" in capsys.readouterr().err
