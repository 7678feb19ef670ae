"""The line to other simulators, and real time."""

import pytest

from runtime import RuntimeInputError, World
from runtime.cli.dis_line import DisLine, RealTime, address_of


def test_addresses_have_a_port():
    assert address_of("10.0.0.1:3000") == ("10.0.0.1", 3000)
    for text in ("10.0.0.1", "10.0.0.1:x", ""):
        with pytest.raises(RuntimeInputError, match=r"127\.0\.0\.1:3000"):
            address_of(text)


def test_a_world_is_held_to_real_time_and_exchanges(graph, monkeypatch):
    clock, world = [100.0], World(graph)
    monkeypatch.setattr("time.monotonic", lambda: clock[0])
    monkeypatch.setattr("time.sleep", lambda seconds: clock.__setitem__(0, clock[0] + seconds))
    world.spawn("walker", (2.0, 3.0, 0.0))
    line = DisLine("127.0.0.1:9", "127.0.0.1:0", "1:2:3", (48.0, 11.0, 0.0))
    gateway = line.gateway(world)
    with RealTime(gateway) as real_time:
        for _ in range(10):
            world.step(0.1)
            real_time.keep(world)
    assert clock[0] == pytest.approx(101.0) and gateway.counts["sent"] == 2  # its first and its last
