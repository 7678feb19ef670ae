"""What is shown while skills are learned, and how long that will still take."""

from types import SimpleNamespace

import numpy as np
import pytest

from locomotion.training.progress import Clock, Progress, show
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


def test_each_stage_is_shown_with_what_it_has_learned(capsys):
    for stage in ("walk", "run"):
        for generation in range(1, 21):
            show(
                Progress(stage, generation, 20, 30.0 - generation, 0.05 * generation, 60.0 * generation, 90.0)
            )
    lines = capsys.readouterr().err.splitlines()
    assert [line for line in lines if line in ("walk", "walk: done", "run", "run: done")] == [
        "walk", "walk: done", "run", "run: done",
    ]  # fmt: skip
    assert len(lines) == 2 * (2 + 9)
    assert lines[1] == ("walk: 10 %, generation 2/20, cost 28.00, survives 10 %, 2.0 min done, 1.5 min left")


def test_a_stage_that_is_gone_on_with_is_not_begun_again(capsys):
    show(Progress("jump", 3, 4, 1.0, 1.0, 1.0, 1.0))
    show(Progress("jump", 4, 4, 1.0, 1.0, 1.0, 1.0))
    assert capsys.readouterr().err.splitlines().count("jump") == 1
