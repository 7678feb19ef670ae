"""Files of outcomes: resumed where they were, the same wherever the starts are tried."""

import numpy as np
import pytest

from locomotion import LocomotionError
from locomotion.preconditions.moments import Moment
from locomotion.training.preconditions import outcomes as module
from locomotion.training.preconditions.outcomes import STARTS, read_outcomes, sample
from locomotion.training.preconditions.sampling import ENDS, Noted, Outcome


@pytest.fixture
def tried(monkeypatch):
    """Instead of a simulation: two moments for each start, and who was asked for."""
    numbers = []

    def try_start(kind, start, rng):
        if rng is None:
            raise RuntimeError
        numbers.append(start.distance)
        outcome = Outcome(start, _obstacle(start), ENDS[int(start.size > 0.5) * 3], True)
        for off in (False, True):
            moment = Moment(rng.normal(size=127), rng.normal(size=4), np.zeros(2), 0.1)
            outcome.noted.append(Noted(moment, off, False, np.zeros(46), np.zeros(45)))
        return outcome

    monkeypatch.setattr(module, "try_start", try_start)
    monkeypatch.setattr(module, "_BLOCK", 2)
    return numbers


def _obstacle(start):
    from locomotion.skills.course import make_course

    return make_course([("jump", start.size, start.depth)], [start.distance]).obstacles[0]


def test_a_file_holds_starts_ends_and_moments(tmp_path, tried):
    made = sample("jump", 5, 3, tmp_path / "jump.npz")
    read = read_outcomes(tmp_path / "jump.npz")
    assert read.starts.shape == (5, len(STARTS)) and read.first.tolist() == [0, 2, 4, 6, 8, 10]
    assert (read.moments["state"] == made.moments["state"]).all() and read.start_of.tolist()[:3] == [0, 0, 1]
    assert read.header["seed"] == 3 and not (tmp_path / "jump.npz.parts").exists()


def test_an_interrupted_run_goes_on_and_a_longer_one_begins_with_what_is_there(tmp_path, tried, monkeypatch):
    whole, file = sample("jump", 6, 3, tmp_path / "whole.npz"), tmp_path / "jump.npz"
    tried.clear()
    working, left = module._try, [2]

    def stops(block):
        left[0] -= 1
        if left[0] < 0:
            raise KeyboardInterrupt
        return working(block)

    with monkeypatch.context() as patch:
        patch.setattr(module, "_try", stops)
        with pytest.raises(KeyboardInterrupt):
            sample("jump", 6, 3, file)
    assert len(tried) == 4 and not file.exists()
    sample("jump", 6, 3, file)
    assert len(tried) == 6 and file.read_bytes() == (tmp_path / "whole.npz").read_bytes()
    sample("jump", 8, 3, file)
    assert len(tried) == 8 and (read_outcomes(file).starts[:6] == whole.starts).all()
    sample("jump", 4, 4, file)
    assert len(tried) == 12  # another seed, from the beginning


def test_what_cannot_be_sampled_is_refused(tmp_path):
    with pytest.raises(LocomotionError, match="skill 'fly': valid: jump"):
        sample("fly", 1, 0, tmp_path / "x.npz")
    with pytest.raises(LocomotionError, match="no such file"):
        read_outcomes(tmp_path / "x.npz")
