"""Entity State PDUs as Wireshark's dissector (`tshark`) reads them."""

import subprocess
from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from runtime.dis.entity_state import ENTITY_STATE, PART, SIZE, make_records
from runtime.dis.pcap import Packet, write_pcap

__all__ = ["differences", "random_pdus"]

_DIGITS = {">f8": 1e-14, ">f4": 1e-5}
"""Relative size of the last digit that tshark prints."""
_TYPE = ("entityKind", "entityDomain", "country", "category", "subcategory", "specific", "extra")
_VECTORS = {
    "velocity": "entity_linear_velocity", "location": "entity_location",
    "acceleration": "entity_linear_acceleration", "angular_velocity": "entity_angular_velocity",
}  # fmt: skip


def random_pdus(count: int, seed: int) -> list[tuple[np.ndarray, np.ndarray]]:
    """``count`` PDUs with every field drawn at random, of versions 5 to 7, with up to three articulated
    parts: records of `ENTITY_STATE` () and of `PART` (n,)."""
    chance = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        parts = np.zeros(int(chance.integers(0, 4)), PART)
        for name in ("change", "attached_to", "parameter"):
            parts[name] = chance.integers(0, 200, len(parts))
        parts["value"] = chance.normal(0.0, 1.0, len(parts))
        record = make_records(1, int(chance.integers(5, 8)), int(chance.integers(1, 256))).reshape(())
        record["timestamp"] = chance.integers(0, 2**32)
        for name in ("site", "application", "entity"):
            record[name] = chance.integers(1, 65535)
        record["force"], record["parts"] = chance.integers(0, 4), len(parts)
        for kind in ("type", "alternative_type"):
            for name in record[kind].dtype.names:
                record[kind][name] = chance.integers(1, 200)
            record[kind]["kind"], record[kind]["domain"] = 3, 1
        record["location"] = chance.normal(0.0, 4e6, 3)
        record["orientation"] = chance.uniform(-np.pi, np.pi, 3)
        for name in ("velocity", "acceleration", "angular_velocity"):
            record[name] = chance.normal(0.0, 10.0, 3)
        record["appearance"], record["capabilities"] = chance.integers(0, 2**32, 2)
        record["algorithm"] = chance.integers(0, 10)
        record["other_parameters"] = chance.integers(0, 256, 15)
        record["marking"] = bytes(chance.integers(65, 91, int(chance.integers(1, 12))).tolist())
        record["length"] = SIZE + PART.itemsize * len(parts)
        made.append((record, parts))
    return made


def differences(pdus: list[tuple[np.ndarray, np.ndarray]], folder: Path) -> list[str]:
    """Fields that tshark reads otherwise than they were written, in words."""
    path = folder / "pdus.pcap"
    data = [record.tobytes() + parts.tobytes() for record, parts in pdus]
    write_pcap(path, [Packet(float(k), each) for k, each in enumerate(data)])
    command = ["tshark", "-n", "-r", str(path), "-d", "udp.port==3000,dis", "-T", "pdml"]
    text = subprocess.run(command, capture_output=True, check=True, timeout=300).stdout
    found = [packet.find("proto[@name='dis']") for packet in ElementTree.fromstring(text)]
    if len(found) != len(pdus) or any(each is None for each in found):
        return [f"{len(pdus)} PDUs were written, {len(found)} read"]
    wrong: list[str] = []
    for k, (proto, (record, parts)) in enumerate(zip(found, pdus, strict=True)):
        begin = int(proto.get("pos"))
        read = [
            (each.get("name"), each.get("show"), int(each.get("pos")) - begin, int(each.get("size")))
            for each in proto.iter("field")
            if each.get("name")
        ]
        wrong += [f"PDU {k}: {each}" for each in _wrong(read, record, parts)]
    return wrong


def _expected(record: np.ndarray, parts: np.ndarray) -> list[tuple[str, int, np.dtype, object]]:
    """Name at tshark, offset, type and value of every field."""

    def at(name: str, *, dtype: np.dtype = ENTITY_STATE, base: int = 0) -> tuple[np.dtype, int]:
        assert dtype.fields is not None
        return dtype.fields[name][0], base + dtype.fields[name][1]

    names = {
        "version": "proto_ver", "exercise": "exer_id", "pdu_type": "pdu_type", "family": "proto_fam",
        "timestamp": "timestamp", "length": "pdu_length", "site": "entity_id_site",
        "application": "entity_id_application", "entity": "entity_id_entity", "force": "force_id",
        "parts": "num_articulation_params", "appearance": "appearance",
        "algorithm": "entity_marking_character_set", "other_parameters": "dead_reckoning_other_parameters",
        "character_set": "entity_marking_character_set", "marking": "entity_marking",
        "capabilities": "capabilities",
    }  # fmt: skip
    told = [(theirs, at(name)[1], at(name)[0], record[name]) for name, theirs in names.items()]
    for kind in ("type", "alternative_type"):
        dtype, base = at(kind)
        for name, theirs in zip(dtype.names or (), _TYPE, strict=True):
            # tshark names a category after its domain
            theirs = "category.land" if theirs == "category" and record[kind]["domain"] == 9 else theirs
            told.append((theirs, at(name, dtype=dtype, base=base)[1], dtype[name], record[kind][name]))
    for name, theirs in _VECTORS.items():
        dtype, base = at(name)
        told += [
            (f"{theirs}.{axis}", base + n * dtype.base.itemsize, dtype.base, record[name][n])
            for n, axis in enumerate("xyz")
        ]
    base = at("orientation")[1]
    told += [
        (f"entity_orientation.{axis}", base + 4 * n, np.dtype(">f4"), record["orientation"][n])
        for n, axis in enumerate(("psi", "theta", "phi"))
    ]
    of_parts = {
        "change": "vp.change", "attached_to": "vp.part_attached_to_id",
        "parameter": "vp.artic_param_type", "value": "vp.parameter_value",
    }  # fmt: skip
    for n, part in enumerate(parts):
        for name, theirs in of_parts.items():
            dtype, base = at(name, dtype=PART, base=SIZE + n * PART.itemsize)
            told.append((theirs, base, dtype, part[name]))
    return told


def _wrong(read: list[tuple[str, str, int, int]], record: np.ndarray, parts: np.ndarray) -> list[str]:
    there = {(name.removeprefix("dis."), pos): (show, size) for name, show, pos, size in read}
    wrong = []
    for name, offset, dtype, value in _expected(record, parts):
        show, size = there.get((name, offset), ("nothing", 0))
        if size != dtype.itemsize or not _equal(name, show, dtype, value):
            wrong.append(f"{name} at {offset}: written {value}, read {show} ({size} bytes)")
    return wrong


def _equal(name: str, show: str, dtype: np.dtype, value: object) -> bool:
    if name == "timestamp":  # [s], cut after the nanoseconds
        units = int(value) >> 1  # type: ignore[call-overload]
        return abs(float(show) - units * (3600.0 / 2**31)) < 2e-6
    if dtype.str in _DIGITS:
        return bool(np.isclose(float(show), float(value), rtol=_DIGITS[dtype.str], atol=0.0))  # type: ignore
    if dtype.kind == "S":
        return show == np.asarray(value).item().decode()
    if dtype.subdtype is not None:
        return bytes.fromhex(show.replace(":", "")) == np.asarray(value).tobytes()
    return int(show, 0) == int(value)  # type: ignore[call-overload]
