"""A playtest that was interrupted goes on where it was."""

from dataclasses import asdict, replace

import numpy as np
import pytest

from runtime.playtest import run as module
from runtime.playtest.bots import BotRun, Passing, Trouble, Visit
from runtime.playtest.kept_runs import KeptRuns
from runtime.playtest.report import Setup
from runtime.playtest.run import open_stage
from tests.runtime.playtest.levels import FLOOR, room

RNG = np.random.default_rng(1)


def trouble(poses):
    return Trouble("stuck", 3.25, (1.0, 2.0, 0.1 + 0.2), -1, RNG.normal(size=(5, 4)), poses)


@pytest.mark.parametrize(
    "run",
    [
        BotRun(3, "explorer"),
        BotRun(
            7, "trier", 12.3, [RNG.normal(size=(4, 4)), RNG.normal(size=(2, 4))],
            [trouble(None), trouble(RNG.normal(size=(5, 3, 7)))],
            [Visit("gate", "stage", 1.5, 1.0 / 3.0, True)], [Passing(2, False)],
        ),
    ],
)  # fmt: skip
def test_a_run_is_read_as_it_was_kept(tmp_path, run):
    kept = KeptRuns(tmp_path, "a")
    assert kept.read(run.number) is None
    kept.keep(run)
    again = kept.read(run.number)
    assert np.array_equal(again.track, run.track)
    for one, other in zip(again.troubles, run.troubles, strict=True):
        assert np.array_equal(one.track, other.track)
        assert (one.poses is None) == (other.poses is None)
        assert one.poses is None or np.array_equal(one.poses, other.poses)
    plain = [asdict(each) | {"tracks": 0, "troubles": 0} for each in (again, run)]
    assert plain[0] == plain[1]
    assert KeptRuns(tmp_path, "b").read(run.number) is None
    kept.forget()
    assert not tmp_path.exists()


def test_only_bots_that_had_not_finished_run_again(tmp_path, monkeypatch):
    room(FLOOR).export(tmp_path / "room.obj")
    stage = open_stage(Setup(str(tmp_path / "room.obj"), None, None, None, "walker", 6, 4.0, 3))

    def play():
        return list(module._all_runs(stage, b"", 1, KeptRuns(tmp_path / "kept", "one")))

    whole, begun, run_bot = list(module._all_runs(stage, b"", 1, None)), [], module.run_bot

    def interrupted(site, goals, seed, number, seconds):
        begun.append(number)
        if number == 3 and len(begun) == 4:
            raise KeyboardInterrupt
        return run_bot(site, goals, seed, number, seconds)

    monkeypatch.setattr(module, "run_bot", interrupted)
    with pytest.raises(KeyboardInterrupt):
        play()
    next(tmp_path.rglob("000001.npz")).write_bytes(b"cut off")
    again = play()
    assert begun == [0, 1, 2, 3, 1, 3, 4, 5]
    assert [run.number for run in again] == list(range(6))
    assert all(np.array_equal(one.track, other.track) for one, other in zip(again, whole, strict=True))


def identity(setup):
    stage = open_stage(setup)
    return module._identity(stage, module._packed(stage.site.graph))


def test_another_level_seed_or_length_is_another_playtest(tmp_path):
    room(FLOOR, high=3.0).export(tmp_path / "room.obj")
    setup = Setup(str(tmp_path / "room.obj"), None, None, None, "walker", 6, 4.0, 3)
    one = identity(setup)
    assert identity(replace(setup, bots=60)) == one  # more of the same bots
    others = [replace(setup, seed=4), replace(setup, seconds=5.0), replace(setup, body="dog")]
    names = {identity(each) for each in others}
    room(FLOOR, high=3.5).export(tmp_path / "room.obj")
    names.add(identity(setup))
    assert len(names | {one}) == 5
