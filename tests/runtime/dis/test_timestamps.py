"""Timestamps: units, the full hour, and clocks that differ."""

import numpy as np
import pytest

from runtime.dis.timestamps import SenderClock, elapsed, is_absolute, past_the_hour, timestamp


def test_an_hour_has_two_to_the_31_units():
    assert timestamp(0.0, False) == 0 and timestamp(0.0, True) == 1
    assert timestamp(1800.0, False) == 2**31 and past_the_hour(2**31) == 1800.0
    assert timestamp(3600.0 - 1e-7, False) == 0  # rounds up to the full hour
    for seconds in np.random.default_rng(1).uniform(0.0, 20_000.0, 200):
        stamp = timestamp(seconds, True)
        assert is_absolute(stamp) and abs(past_the_hour(stamp) - seconds % 3600.0) < 1e-6


def test_time_goes_on_past_the_hour():
    before, after = timestamp(3599.5, False), timestamp(3600.25, False)
    assert elapsed(after, before) == pytest.approx(0.75, abs=1e-5)
    assert elapsed(before, after) == pytest.approx(-0.75, abs=1e-5)


@pytest.mark.parametrize("apart", [0.0, -1234.5, 5000.0])
def test_delays_are_found_whatever_the_clocks_show(apart):
    """Over two full hours, with a drift of 1 in 10,000; delays of 0.05 s and sometimes more."""
    chance, clock = np.random.default_rng(4), SenderClock()
    worst = 0.0
    for k in range(8000):
        sent = 0.9 * k
        late = 0.0 if k % 5 == 0 else float(chance.uniform(0.0, 0.8))
        told = clock.age(timestamp(sent + apart, False), sent * (1.0 + 1e-4) + 0.05 + late)
        if k > 5:
            worst = max(worst, abs(told - late))
    assert worst < 0.01


def test_a_clock_that_is_set_starts_anew():
    clock = SenderClock()
    assert clock.age(timestamp(100.0, False), 0.0) == 0.0
    assert clock.age(timestamp(101.0, False), 1.5) == pytest.approx(0.5, abs=1e-5)
    assert clock.age(timestamp(900.0, False), 2.0) == 0.0
    assert clock.age(timestamp(901.0, False), 3.2) == pytest.approx(0.2, abs=1e-5)


def test_a_clock_that_stands_delays_nothing():
    clock = SenderClock()
    assert [clock.age(0, arrival) for arrival in (0.0, 1.0, 4.0, 30.0)] == [0.0] * 4


def test_a_late_packet_is_old():
    clock = SenderClock()
    for k in range(3):
        clock.age(timestamp(1.0 * k, False), 1.0 * k)
    assert clock.age(timestamp(1.5, False), 2.6) == pytest.approx(1.1, abs=1e-5)
