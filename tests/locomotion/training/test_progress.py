"""How long training will still take."""

from types import SimpleNamespace

import numpy as np
import pytest

from locomotion.training.progress import Clock
from locomotion.training.search.loop import Stage, learn, simulated
from tests.locomotion.training.tiny import tiny_problem


def test_the_time_left_is_that_of_all_searches_and_not_of_what_was_done_before(monkeypatch, tmp_path) -> None:
    now = [0.0]
    monkeypatch.setattr("locomotion.training.progress.time", SimpleNamespace(monotonic=lambda: now[0]))
    stages = [Stage("a", 3, 1.0, np.ones(2), population=4, seconds=2.0), Stage("b", 1, 1.0, np.ones(2))]
    assert simulated(stages) == 3 * 4 * 2.0 + 32 * 1.0
    clock = Clock(simulated(stages))
    clock.skip(8.0)  # a generation of the first
    now[0] = 4.0
    assert clock.advance(8.0) == (4.0, pytest.approx(0.5 * (8.0 + 32.0)))
    told: list[float] = []
    learn(tiny_problem(), 5, tmp_path / "kept", 1, lambda p: told.append(p.remaining), Clock(100.0), 3)
    assert told == pytest.approx([0.0] * 3)  # no time goes by on this clock
    clock = Clock(100.0)
    learn(tiny_problem(), 5, tmp_path / "kept", 1, lambda p: None, clock)
    assert clock.ahead == pytest.approx(100.0 - simulated(tiny_problem().stages()))
