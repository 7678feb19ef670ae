"""`surefoot record`: what it lists and refuses. Recording itself takes half a minute:
`tests/locomotion/recorded` tests its parts."""

import json

import pytest

from runtime.cli.app import main


def run(*arguments):
    with pytest.raises(SystemExit) as end:
        main(["record", *map(str, arguments)])
    return end.value.code


def test_every_clip_is_listed_with_its_origin(capsys):
    assert run("--list", "--json") == 0
    clips = json.loads(capsys.readouterr().out)["clips"]
    assert all(clip["origin"] for clip in clips)
    assert run("--list") == 0
    assert "simulation of the learned walk" in capsys.readouterr().out


def test_wrong_input_is_refused(tmp_path, capsys):
    assert run() == 2
    assert "name a posture file" in capsys.readouterr().err
    assert run(tmp_path / "none.yaml", "-o", tmp_path / "motions.txt") == 2
    assert "use that ending" in capsys.readouterr().err
    (tmp_path / "broken.npz").write_bytes(b"x")
    assert run(tmp_path / "broken.npz", "--list") == 2
    assert "not a whole motion set" in capsys.readouterr().err
