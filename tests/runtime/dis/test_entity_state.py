"""Entity State PDUs: the bytes of others come back as they were, faults have names."""

from pathlib import Path

import numpy as np
import pytest

from benchmarks.dis_wireshark import random_pdus
from benchmarks.shared_data import shared_folder
from runtime.dis.entity_state import (
    ENTITY_STATE,
    PART,
    SIZE,
    EntityState,
    Fault,
    MalformedPdu,
    decode,
    fault_of,
    length_at,
    make_records,
)

RECORDED = sorted(((shared_folder() or Path("/")) / "dis").glob("*.raw"))


def encoded(seed=0, count=1):
    return [record.tobytes() + parts.tobytes() for record, parts in random_pdus(count, seed)]


def test_the_layout_is_that_of_the_standard():
    """Offsets of IEEE 1278.1-2012, table 68."""
    offsets = {name: ENTITY_STATE.fields[name][1] for name in ENTITY_STATE.names}
    assert SIZE == 144 and PART.itemsize == 16
    for name, offset in (
        ("timestamp", 4), ("length", 8), ("site", 12), ("force", 18), ("parts", 19), ("type", 20),
        ("alternative_type", 28), ("velocity", 36), ("location", 48), ("orientation", 72),
        ("appearance", 84), ("algorithm", 88), ("acceleration", 104), ("angular_velocity", 116),
        ("character_set", 128), ("marking", 129), ("capabilities", 140),
    ):  # fmt: skip
        assert offsets[name] == offset, name


def test_what_is_written_is_read_again():
    for data in encoded(seed=5, count=50):
        state = decode(data)
        assert state.encode() == data and len(state.parts) == state.record["parts"]
    record = make_records(1).reshape(())
    record["marking"], record["site"], record["application"], record["entity"] = b"ada", 1, 2, 3
    assert EntityState(record).marking == "ada" and EntityState(record).name == (1, 2, 3)


@pytest.mark.skipif(not RECORDED, reason="no recorded PDUs: set SUREFOOT_SHARED to a folder with dis/")
def test_recorded_pdus_come_back_as_the_same_bytes():
    assert len(RECORDED) == 6
    for path in RECORDED:
        data = path.read_bytes()
        state = decode(data)
        assert state.encode() == data, path.name
        assert np.isfinite(state.record["location"]).all()
    leopard = decode(RECORDED[1].read_bytes())
    assert leopard.marking == "Leopard2" and leopard.name == (1, 200, 1)
    assert leopard.parts["parameter"].tolist() == [0x100B, 0x114D]
    assert leopard.parts["value"] == pytest.approx([-1.783, 1.281], abs=1e-3)


@pytest.mark.parametrize(
    ("change", "fault"),
    [
        (lambda data: data[:11], Fault.CUT),
        (lambda data: data[:143], Fault.CUT),
        (lambda data: b"\x04" + data[1:], Fault.VERSION),
        (lambda data: data[:2] + b"\x02" + data[3:], Fault.OTHER),
        (lambda data: data[:8] + b"\x00\x80" + data[10:], Fault.LENGTH),
        (lambda data: data[:19] + b"\x09" + data[20:], Fault.LENGTH),
        (lambda data: data + b"\x00", Fault.LENGTH),
    ],
)
def test_what_is_no_pdu_is_refused_by_name(change, fault):
    data = make_records(1).tobytes()
    with pytest.raises(MalformedPdu, match=f"no Entity State PDU: {fault}") as error:
        decode(change(data))
    assert error.value.fault == fault


def test_pdus_in_one_packet_are_told_apart():
    first, second = encoded(seed=3, count=2)
    both = first + second
    assert length_at(both, 0) == len(first) and length_at(both, len(first)) == len(second)
    assert length_at(both, len(both)) == 0 and fault_of(both, len(first)) is None
    assert fault_of(both, 0, exercise=0) == Fault.EXERCISE
