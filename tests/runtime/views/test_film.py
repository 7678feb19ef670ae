"""Videos: they decode to the frames that were drawn, and appear whole or not at all."""

import dataclasses
from itertools import pairwise

import numpy as np
import pytest

from runtime.errors import RuntimeInputError
from runtime.views.camera import agent_named, follow
from runtime.views.film import RATE, frames, write_film

av = pytest.importorskip("av", reason="PyAV is not there: pip install -e '.[video]'")
SIZE = (96, 64)


def decoded(path):
    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


def test_a_film_decodes_to_its_frames(trace, tmp_path):
    write_film(trace, tmp_path / "run.mp4", "ada", size=SIZE)
    drawn = list(frames(trace, trace.agents[0], SIZE))
    shown = decoded(tmp_path / "run.mp4")
    assert [each.name for each in tmp_path.iterdir()] == ["run.mp4"]
    assert len(shown) == len(drawn) == int(np.ptp(trace.times) * RATE) + 1
    for a, b in zip(drawn, shown, strict=True):
        assert a.shape == b.shape == (64, 96, 3)
        assert np.abs(a.astype(int) - b).mean() < 6.0
    blue = shown[-1].astype(int)[..., 2] - shown[-1][..., 0] > 25  # the shirt, in the middle
    assert blue[16:48, 32:64].sum() > 8


def test_the_same_trace_is_the_same_film(trace, tmp_path):
    for name in ("a.mp4", "b.mp4"):
        write_film(trace, tmp_path / name, size=SIZE)
    assert (tmp_path / "a.mp4").read_bytes() == (tmp_path / "b.mp4").read_bytes()


def test_an_interrupted_film_leaves_nothing(trace, tmp_path, monkeypatch):
    def interrupted(*_):
        yield next(frames(trace, trace.agents[0], SIZE))
        raise KeyboardInterrupt

    monkeypatch.setattr("runtime.views.film.frames", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_film(trace, tmp_path / "run.mp4", size=SIZE)
    assert list(tmp_path.iterdir()) == []


def test_the_camera_keeps_the_figure_in_sight(trace):
    agent = trace.agents[0]
    moments = np.linspace(trace.times[0], trace.times[-1], 9)
    cameras = follow(agent, trace.times, moments, 4.0)
    steps = [np.linalg.norm(b.eye - a.eye) for a, b in pairwise(cameras)]
    assert max(steps) < 0.5
    for moment, camera in zip(moments, cameras, strict=True):
        root = [np.interp(moment, trace.times, agent.poses[:, 0, axis].astype(float)) for axis in range(3)]
        sight, there = camera.target - camera.eye, np.array(root) - camera.eye
        angle = np.arccos(sight @ there / np.linalg.norm(sight) / np.linalg.norm(there))
        assert angle < 0.3


def test_agents_are_named(trace):
    assert agent_named(trace, None).name == agent_named(trace, "ada").name == "ada"
    with pytest.raises(RuntimeInputError, match="no agent is called 'rex'; valid: ada"):
        agent_named(dataclasses.replace(trace), "rex")
