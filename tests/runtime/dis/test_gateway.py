"""Gateways over UDP on this machine; packets are waited for by the kernel alone."""

import socket

import numpy as np
import pytest

from runtime import RuntimeInputError, World
from runtime.dis import Gateway, Options
from runtime.dis.udp import Udp
from tests.runtime.dis.entities import ORIGIN


@pytest.fixture
def two(graph):
    """Two gateways that talk to each other."""
    first = World(graph), World(graph)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    one = Gateway(first[0], 1, 1, 1, ORIGIN, ("127.0.0.1", port), Options(listen=("127.0.0.1", 0)))
    other = Gateway(first[1], 1, 2, 1, ORIGIN, ("127.0.0.1", one.port), Options(listen=("127.0.0.1", port)))
    yield first, one, other
    one.close()
    other.close()


def test_worlds_meet_on_this_machine(two):
    (here, there), one, other = two
    here.spawn("walker", (2.0, 3.0, 0.0)).go_to((9.0, 3.0, 0.0), speed=1.2)
    for _ in range(30):
        here.step(1 / 60)
        there.step(1 / 60)
        one.exchange()
        other.exchange()
    (agent,) = there.agents.values()
    assert agent.name == "dis:1:1:1" and one.counts["sent"] == other.counts["news"] > 0
    assert np.linalg.norm(agent.position - here.agents["walker1"].position) < 1.0
    one.close()
    other.exchange()
    assert not there.agents
    one.close()


@pytest.mark.parametrize(
    ("address", "options", "says"),
    [
        (("239.1.2.3", 3000), {}, "multicast address; ask for multicast"),
        (("127.255.255.255", 3000), {}, "broadcast address; ask for broadcast"),
        (("example.org", 3000), {}, "expected an IPv4 address"),
        (("127.0.0.1", 99999), {}, "expected 0 to 65535"),
        (("127.0.0.1", 3000), {"listen": ("203.0.113.7", 3000)}, "cannot listen at 203.0.113.7:3000"),
    ],
)
def test_addresses_are_checked(address, options, says):
    with pytest.raises(RuntimeInputError, match=says):
        Udp(address, **options)


def test_this_machine_is_where_it_listens_and_broadcast_is_heard_by_all():
    alone = Udp(("127.0.0.1", 0))
    assert alone._socket.getsockname()[0] == "127.0.0.1"
    alone.close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    pair = [Udp(("127.255.255.255", port), broadcast=True) for _ in range(2)]
    assert pair[0].send([b"hello", b"you"]) == 0
    assert [[data for data, _ in each.received()] for each in pair] == [[b"hello", b"you"]] * 2
    for each in pair:
        each.close()


def test_nobody_need_be_there():
    lonely = Udp(("127.0.0.1", 9), listen=("127.0.0.1", 0))
    for _ in range(3):
        assert lonely.send([b"x"]) in (0, 1) and list(lonely.received()) == []
    assert lonely.send([bytes(70_000)]) == 1
    lonely.close()
