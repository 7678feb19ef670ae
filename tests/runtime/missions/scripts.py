"""Missions of a few lines on the small level."""

import pytest

from runtime.missions.check import prepare_mission
from runtime.missions.mission import load_mission
from runtime.missions.run import run_mission
from surefoot.files.yamlfile import FileError
from surefoot.progress import Progress
from tests.small_level import obj_text

HEAD = """\
level: {file: level.obj}
time_limit: 30
waypoints: {west: [2, 3, 0], east: [9, 3, 0], north: [6, 5, 0]}
regions:
  east side: {min: [5, 0, -1], max: [12, 6, 1]}
  north side: {center: [6, 6, 0], radius: 2}
agents:
"""
HEAD = HEAD.replace(" side:", "_side:")
REX = "  - {name: rex, body: dog, start: west, speed: 2, "


def load(tmp_path, agents, triggers=""):
    """The mission of ``agents`` on the small level."""
    (tmp_path / "level.obj").write_text(obj_text())
    (tmp_path / "mission.yaml").write_text(HEAD + agents + triggers)
    return load_mission(tmp_path / "mission.yaml")


def run(graph, *parts):
    loaded = load(*parts)
    return run_mission(loaded, prepared=prepare_mission(loaded, Progress(shown=False), graph))


def verdicts(result):
    return {(check.agent, check.expected): check.held for check in result.checks}


def path_of(result, name):
    agent = next(each for each in result.trace.agents if each.name == name)
    return result.trace.times, agent.poses[:, 0, :2].astype(float)


def refused(call, text, at, says):
    """``call`` is refused with a message about the place of ``at`` in the eighth line, ``text``."""
    with pytest.raises(FileError) as caught:
        call()
    assert f"mission.yaml:8:{text.index(at) + 1}: " in str(caught.value) and says in str(caught.value)
