"""Trace files hold a run and refuse to be something else."""

import numpy as np
import pytest

from runtime.traces.trace import Trace
from surefoot.files.archive import ArchiveError, write_archive


def test_comes_back_as_it_was_written(trace, tmp_path):
    trace.write(tmp_path / "trace.npz")
    again = Trace.read(tmp_path / "trace.npz")
    assert np.array_equal(again.times, trace.times)
    assert again.state_hash == trace.state_hash
    assert [dict(event) for event in again.events] == [
        {key: list(value) if isinstance(value, tuple) else value for key, value in event.items()}
        for event in trace.events
    ]
    for old, new in zip(trace.agents, again.agents, strict=True):
        assert new.name == old.name and new.figure.bodies == old.figure.bodies
        assert np.array_equal(new.poses, old.poses)
        assert np.array_equal(new.paths[0].smooth, old.paths[0].smooth)
    assert np.array_equal(again.level.faces, trace.level.faces)


def test_refuses_a_cut_file_and_another_kind(trace, tmp_path):
    path = tmp_path / "trace.npz"
    trace.write(path)
    content = path.read_bytes()
    for length in (0, 10, len(content) // 2, len(content) - 30):
        path.write_bytes(content[:length])
        with pytest.raises(ArchiveError):
            Trace.read(path)
    write_archive(path, "surefoot trace", 1, {"agents": []}, {})
    with pytest.raises(ArchiveError, match="header"):
        Trace.read(path)
    write_archive(path, "skill", 1, {}, {})
    with pytest.raises(ArchiveError, match="skill"):
        Trace.read(path)
