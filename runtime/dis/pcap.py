"""UDP packets in pcap files, as tcpdump and Wireshark write and read them.

Read are classic pcap files of either byte order, in micro- or nanoseconds, with Ethernet (also with VLAN
tags), Linux cooked, loopback or raw IP frames, IPv4 and IPv6. Written are raw IPv4 frames.
"""

import ipaddress
import os
import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from runtime.errors import RuntimeInputError
from surefoot.files.atomic_write import whole_file

__all__ = ["Packet", "read_pcap", "write_pcap"]

_MAGIC = {0xA1B2C3D4: 1e-6, 0xA1B23C4D: 1e-9}
_PCAPNG = 0x0A0D0D0A
_RAW, _LONGEST = 101, 262_144
_LINK_HEADERS = {0: 4, 108: 4, 1: 14, 101: 0, 228: 0, 229: 0, 113: 16, 276: 20}
"""Bytes before the IP header, by kind of link."""
_UDP = 17


@dataclass(frozen=True)
class Packet:
    """A datagram. ``time`` [s] since 1970, or since any other moment; ``source`` and ``target``: address and
    port."""

    time: float
    data: bytes
    source: tuple[str, int] = ("127.0.0.1", 3000)
    target: tuple[str, int] = ("127.0.0.1", 3000)


def read_pcap(path: str | os.PathLike[str]) -> Iterator[Packet]:
    """The UDP packets of a file in their order; all else in it is left out, fragments too.

    Raises `RuntimeInputError` for a file that is missing, cut off, or of another kind.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise RuntimeInputError(f"{path}: {error.strerror}") from None
    order, unit, link = _global_header(path, data)
    record, offset = struct.Struct(f"{order}IIII"), 24
    while offset < len(data):
        if offset + record.size > len(data):
            raise RuntimeInputError(f"{path}: cut off in the record at byte {offset}")
        seconds, parts, kept, _ = record.unpack_from(data, offset)
        begin = offset + record.size
        if kept > _LONGEST or begin + kept > len(data):
            raise RuntimeInputError(f"{path}: the record at byte {offset} is cut off or damaged")
        offset = begin + kept
        found = _datagram(data[begin:offset], link)
        if found is not None:
            yield Packet(seconds + parts * unit, *found)


def _global_header(path: str | os.PathLike[str], data: bytes) -> tuple[str, float, int]:
    for order in "<>":
        if len(data) >= 24:
            magic, *_, link = struct.unpack_from(f"{order}IHHiIII", data)
            if magic in _MAGIC:
                link &= 0xFFFF
                if link not in _LINK_HEADERS:
                    raise RuntimeInputError(f"{path}: link type {link}; expected Ethernet, cooked or raw IP")
                return order, _MAGIC[magic], link
    if data[:4] == struct.pack(">I", _PCAPNG):
        raise RuntimeInputError(f"{path}: is pcapng; expected pcap: `tshark -r {path} -F pcap -w new.pcap`")
    raise RuntimeInputError(f"{path}: is no pcap file")


def _datagram(frame: bytes, link: int) -> tuple[bytes, tuple[str, int], tuple[str, int]] | None:
    """Payload, source and target of a frame with a whole UDP packet over IP."""
    begin = _LINK_HEADERS[link]
    while link == 1 and frame[begin - 2 : begin] in (b"\x81\x00", b"\x88\xa8"):
        begin += 4
    ip = frame[begin:]
    if len(ip) >= 20 and ip[0] >> 4 == 4:
        head, protocol = 4 * (ip[0] & 15), ip[9]
        source, target = ip[12:16], ip[16:20]
        if int.from_bytes(ip[6:8], "big") & 0x3FFF:
            return None  # a fragment
    elif len(ip) >= 40 and ip[0] >> 4 == 6:
        head, protocol, source, target = 40, ip[6], ip[8:24], ip[24:40]
    else:
        return None
    if protocol != _UDP or len(ip) < head + 8:
        return None
    here, there, length = struct.unpack_from(">HHH", ip, head)
    if length < 8 or head + length > len(ip):
        return None
    payload = bytes(ip[head + 8 : head + length])
    return payload, (str(ipaddress.ip_address(source)), here), (str(ipaddress.ip_address(target)), there)


def write_pcap(path: str | os.PathLike[str], packets: Iterable[Packet]) -> int:
    """Write ``packets`` to a file, whole or not at all; how many there were. Times are kept to the
    microsecond. Raises `RuntimeInputError` for an address that is not IPv4."""
    count = 0
    with whole_file(path) as temporary, temporary.open("wb") as file:
        file.write(struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, _LONGEST, _RAW))
        for count, packet in enumerate(packets, start=1):  # noqa: B007
            frame = _frame(packet)
            seconds, micro = divmod(round(packet.time * 1e6), 1_000_000)
            file.write(struct.pack("<IIII", seconds, micro, len(frame), len(frame)) + frame)
    return count


def _frame(packet: Packet) -> bytes:
    """A raw IPv4 frame."""
    try:
        source, target = (ipaddress.IPv4Address(each[0]).packed for each in (packet.source, packet.target))
    except ipaddress.AddressValueError as error:
        raise RuntimeInputError(f"{error}: packets are written with IPv4 addresses") from None
    length = 8 + len(packet.data)
    udp = struct.pack(">HHHH", packet.source[1], packet.target[1], length, 0)
    pseudo = source + target + struct.pack(">BBH", 0, _UDP, length)
    total = _checksum(pseudo + udp + packet.data) or 0xFFFF
    udp = udp[:6] + total.to_bytes(2, "big")
    ip = struct.pack(">BBHHHBBH4s4s", 0x45, 0, 20 + length, 0, 0, 64, _UDP, 0, source, target)
    ip = ip[:10] + _checksum(ip).to_bytes(2, "big") + ip[12:]
    return ip + udp + packet.data


def _checksum(data: bytes) -> int:
    """The internet checksum (RFC 1071)."""
    total = sum(struct.unpack(f">{(len(data) + 1) // 2}H", data + b"\0" * (len(data) % 2)))
    while total > 0xFFFF:
        total = (total & 0xFFFF) + (total >> 16)
    return 0xFFFF - total
