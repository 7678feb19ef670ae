"""Sending only what changed."""

import numpy as np
import pytest

from locomotion.errors import LocomotionError
from locomotion.recorded.changes import STEPS, applied, changes, decoded, encoded, in_steps, moment_of
from locomotion.recorded.skeletons import FULL, LEVELS, LOW, MEDIUM


def test_what_is_received_is_what_was_sent():
    """With values of one byte and of two."""
    rng, sent, received = np.random.default_rng(4), None, None
    for k in range(50):
        level = LOW if k % 2 else FULL
        angles = in_steps(level, np.where(rng.random(17) < 0.3, rng.uniform(-3, 3, 17), 0.5))
        update = changes(sent, angles)
        if update is not None:
            figure, got = decoded(encoded(70_000 + k, update))
            assert figure == 70_000 + k
            received = applied(np.zeros(17, np.int16) if received is None else received, got)
        assert np.array_equal(received, angles)
        sent = angles


def test_who_does_not_move_costs_nothing():
    angles = in_steps(FULL, np.linspace(-1.0, 1.0, 39))
    assert changes(angles, angles) is None
    assert len(changes(None, angles).indices) == 39


def test_each_level_is_told_at_its_own_rate():
    times = np.arange(6000) / 600.0
    told = [len({moment_of(level, time) for time in times}) for level in (FULL, MEDIUM, LOW)]
    assert told == [601, 301, 151]  # the first and the last moment in half
    assert len(STEPS) == len(LEVELS)
    assert moment_of(FULL, 0.1 + 0.2) == 18


@pytest.mark.parametrize(("level", "rate"), [(FULL, 60), (MEDIUM, 30), (LOW, 15)])
def test_states_60_times_a_second_on_ticks_of_10_ms_lose_no_moment(level, rate):
    times = np.floor(np.arange(1, 601) / 60.0 * 100.0 + 1e-9) / 100.0
    assert len({moment_of(level, time) for time in times}) in (10 * rate, 10 * rate + 1)


def test_angles_are_off_by_half_a_step_at_most():
    angles = np.random.default_rng(1).uniform(-3.1, 3.1, 1000)
    for level, step in enumerate(STEPS):
        assert np.abs(in_steps(level, angles) * step - angles).max() <= 0.5 * step + 1e-12


def test_damaged_packets_are_refused():
    packet = encoded(1, changes(None, in_steps(LOW, np.zeros(17))))
    for wrong in (b"", packet[:4], packet[:-1], packet + b"x"):
        with pytest.raises(LocomotionError, match="a packet of"):
            decoded(wrong)
