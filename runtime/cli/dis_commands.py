"""What `surefoot dis` does once its arguments are parsed: record, replay and show packets."""

import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from runtime.cli.commands import Result
from runtime.cli.dis_line import address_of
from runtime.dis.appearance import Appearance
from runtime.dis.dead_reckoning import MODELS
from runtime.dis.entity_state import SIZE, EntityState, decode, fault_of, length_at
from runtime.dis.geodesy import geodetic
from runtime.dis.pcap import Packet, read_pcap, write_pcap
from runtime.dis.udp import Udp
from runtime.errors import RuntimeInputError
from surefoot.files.archive import check_target
from surefoot.words import several

__all__ = ["record_packets", "replay_packets", "show_packets"]

_LOOKS = 0.01
"""[s] between two looks at the socket."""
_MOST = 1_000_000
"""Packets of a recording."""


def record_packets(file: Path, listen: str, seconds: float, multicast: bool, broadcast: bool) -> Result:
    """Write the packets that come within ``seconds`` [s] to ``file``."""
    check_target(file)
    if not seconds > 0.0:
        raise RuntimeInputError(f"seconds must be above 0, not {seconds!r}")
    here = address_of(listen)
    udp, packets = Udp(here, None if multicast or broadcast else here, multicast, broadcast), []
    ends = time.monotonic() + seconds
    try:
        while time.monotonic() < ends and len(packets) < _MOST:
            packets += [
                Packet(time.time(), data, sender, (here[0], udp.port)) for data, sender in udp.received()
            ]
            time.sleep(_LOOKS)
    finally:
        udp.close()
        write_pcap(file, packets)
    values = {"file": str(file), "packets": len(packets)}
    return Result(values, True, lambda: print(f"{file}: {several(len(packets), 'packet')}"))


def replay_packets(file: Path, to: str, speed: float, multicast: bool, broadcast: bool) -> Result:
    """Send the packets of ``file`` again, at their times divided by ``speed``."""
    if not speed > 0.0:
        raise RuntimeInputError(f"speed must be above 0, not {speed!r}")
    packets = list(read_pcap(file))
    udp = Udp(address_of(to), ("127.0.0.1", 0), multicast, broadcast)
    begun, failed = time.monotonic(), 0
    try:
        for packet in packets:
            due = begun + (packet.time - packets[0].time) / speed
            time.sleep(max(due - time.monotonic(), 0.0))
            failed += udp.send([packet.data])
    finally:
        udp.close()
    values = {"file": str(file), "packets": len(packets), "not_sent": failed}
    return Result(
        values, not failed, lambda: print(f"{several(len(packets), 'packet')} sent, {failed} of them not")
    )


@dataclass
class _Entity:
    """What a recording tells of an entity."""

    last: EntityState
    first: float
    until: float
    count: int = 0
    models: set[str] = field(default_factory=set)

    def values(self, name: tuple[int, int, int]) -> dict[str, Any]:
        record = self.last.record
        place = geodetic(record["location"][None].astype(float))[0]
        looks = Appearance.of(int(record["appearance"]))
        return {
            "entity": ":".join(map(str, name)),
            "marking": self.last.marking,
            "type": ".".join(str(each) for each in record["type"].item()),
            "packets": self.count,
            "seconds": round(self.until - self.first, 3),
            "latitude": round(float(place[0]), 7),
            "longitude": round(float(place[1]), 7),
            "height": round(float(place[2]), 3),
            "looks": looks.life_form.name.lower(),
            "dead_reckoning": sorted(self.models),
        }


def show_packets(file: Path) -> Result:
    """List the entities in ``file``, and what else is in it."""
    entities: dict[tuple[int, int, int], _Entity] = {}
    others: Counter[str] = Counter()
    for packet in read_pcap(file):
        offset = 0
        while (length := length_at(packet.data, offset)) or offset == 0:
            fault = fault_of(packet.data, offset)
            if fault is not None:
                others[fault] += 1
            else:
                state = decode(packet.data[offset : offset + max(length, SIZE)])
                entity = entities.setdefault(state.name, _Entity(state, packet.time, packet.time))
                entity.last, entity.until, entity.count = state, packet.time, entity.count + 1
                model = int(state.record["algorithm"])
                entity.models.add(MODELS[model] if model < len(MODELS) else str(model))
            if not length:
                break
            offset += length
    rows = [entity.values(name) for name, entity in sorted(entities.items())]
    values = {"file": str(file), "entities": rows, "others": dict(others)}

    def show() -> None:
        for row in rows:
            rate = row["packets"] / row["seconds"] if row["seconds"] else 0.0
            print(
                f"{row['entity']:14} {row['marking'] or '-':11} {row['type']:20} {row['looks']:10} "
                f"{row['latitude']:.6f}, {row['longitude']:.6f}, {row['height']:.1f} m, "
                f"{several(row['packets'], 'packet')}, {rate:.1f} a second"
            )
        for fault, count in sorted(others.items()):
            print(f"{count} {fault}")

    return Result(values, bool(rows), show)
