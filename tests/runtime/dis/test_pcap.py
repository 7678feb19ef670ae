"""pcap files: ours come back, and those of others are read."""

import struct

import pytest

from runtime.dis.pcap import Packet, read_pcap, write_pcap
from runtime.errors import RuntimeInputError

PACKETS = [
    Packet(0.25, b"", ("10.0.0.1", 1), ("10.0.0.255", 3000)),
    Packet(1_700_000_000.123456, b"odd", ("127.0.0.1", 65535), ("239.1.2.3", 3000)),
    Packet(2.0, bytes(range(256)) * 5),
]


def test_packets_come_back(tmp_path):
    assert write_pcap(tmp_path / "a.pcap", PACKETS) == 3
    read = list(read_pcap(tmp_path / "a.pcap"))
    assert [(each.data, each.source, each.target) for each in read] == [
        (each.data, each.source, each.target) for each in PACKETS
    ]
    assert [each.time for each in read] == pytest.approx([each.time for each in PACKETS], abs=1e-6)


def capture(order, magic, link, frames):
    data = struct.pack(f"{order}IHHiIII", magic, 2, 4, 0, 0, 65535, link)
    for frame in frames:
        data += struct.pack(f"{order}IIII", 7, 500, len(frame), len(frame)) + frame
    return data


def ip_frame(payload=b"hello", version=4, more=0):
    udp = struct.pack(">HHHH", 4000, 3000, 8 + len(payload), 0) + payload
    if version == 6:
        return (
            struct.pack(">IHBB", 6 << 28, len(udp), 17, 64) + bytes(15) + b"\x01" + bytes(15) + b"\x02" + udp
        )
    return (
        struct.pack(">BBHHHBBH", 0x45, 0, 20 + len(udp), 0, more, 64, 17, 0)
        + bytes([1, 2, 3, 4, 5, 6, 7, 8])
        + udp
    )


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize(("magic", "unit"), [(0xA1B2C3D4, 1e-6), (0xA1B23C4D, 1e-9)])
@pytest.mark.parametrize(
    ("link", "head"),
    [(1, bytes(12) + b"\x08\x00"), (1, bytes(12) + b"\x81\x00\x00\x05\x08\x00"), (101, b""), (0, bytes(4)),
     (113, bytes(16)), (276, bytes(20))],
)  # fmt: skip
def test_captures_of_others_are_read(tmp_path, order, magic, unit, link, head):
    junk = [head + b"", head + ip_frame(more=0x2000), head + ip_frame()[:30], b"\x00"]
    (tmp_path / "a.pcap").write_bytes(capture(order, magic, link, [head + ip_frame(), *junk]))
    (packet,) = read_pcap(tmp_path / "a.pcap")
    assert packet.data == b"hello" and packet.source == ("1.2.3.4", 4000)
    assert packet.target == ("5.6.7.8", 3000) and packet.time == pytest.approx(7 + 500 * unit)


def test_ipv6_is_read(tmp_path):
    (tmp_path / "a.pcap").write_bytes(capture("<", 0xA1B2C3D4, 229, [ip_frame(version=6)]))
    assert next(read_pcap(tmp_path / "a.pcap")).source == ("::1", 4000)


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "no pcap file"),
        (b"\x0a\x0d\x0d\x0a" + bytes(40), "pcapng; expected pcap"),
        (capture("<", 0xA1B2C3D4, 147, []), "link type 147"),
        (capture("<", 0xA1B2C3D4, 101, [ip_frame()])[:-1], "byte 24 is cut off"),
        (capture("<", 0xA1B2C3D4, 101, []) + b"\x00" * 9, "byte 24"),
    ],
)
def test_damage_is_named(tmp_path, data, says):
    (tmp_path / "a.pcap").write_bytes(data)
    with pytest.raises(RuntimeInputError, match=says):
        list(read_pcap(tmp_path / "a.pcap"))
    with pytest.raises(RuntimeInputError, match="No such file"):
        list(read_pcap(tmp_path / "none.pcap"))


def test_only_ipv4_is_written(tmp_path):
    with pytest.raises(RuntimeInputError, match="IPv4"):
        write_pcap(tmp_path / "a.pcap", [Packet(0.0, b"", ("::1", 1))])
    assert not (tmp_path / "a.pcap").exists()
