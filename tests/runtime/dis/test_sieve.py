"""What is let through, and what everything else is counted under."""

from collections import Counter

import numpy as np
import pytest

from runtime.dis.entity_state import ENTITY_STATE, Fault, make_records
from runtime.dis.sieve import OVERSIZED, Sieve
from tests.runtime.dis.entities import SENDER, entity


def changed(fields):
    record = np.frombuffer(bytearray(entity((0, 0, 0))), ENTITY_STATE)
    for name, value in fields.items():
        record[name] = value
    return record.tobytes()


def sift(*packets):
    counts = Counter()
    records, senders = Sieve(1, counts).passed([(data, SENDER) for data in packets])
    assert len(records) == len(senders)
    return records, +counts


def test_whole_pdus_pass_also_several_in_a_packet():
    other = bytearray(entity((1.0, 2.0, 0.0)))
    other[2] = 2  # a fire PDU
    records, counts = sift(entity((0, 0, 0)) + bytes(other) + entity((0, 0, 0), number=2), entity((5, 5, 0)))
    assert records["entity"].tolist() == [1, 2, 1]
    assert counts == {"packets": 2, Fault.OTHER: 1}


@pytest.mark.parametrize(
    ("fields", "fault"),
    [
        ({"version": 4}, Fault.VERSION),
        ({"exercise": 2}, Fault.EXERCISE),
        ({"length": 150}, Fault.CUT),
        ({"length": 0}, Fault.LENGTH),
        ({"parts": 1}, Fault.LENGTH),
        ({"algorithm": 10}, Fault.MODEL),
        ({"location": np.nan}, Fault.NUMBERS),
        ({"location": 1e300}, Fault.NUMBERS),
        ({"velocity": np.inf}, Fault.NUMBERS),
        ({"velocity": 1e30}, Fault.NUMBERS),
        ({"orientation": np.nan}, Fault.NUMBERS),
        ({"angular_velocity": 1e9}, Fault.NUMBERS),
        ({"acceleration": -np.inf}, Fault.NUMBERS),
    ],
)
def test_faults_are_counted(fields, fault):
    records, counts = sift(changed(fields), entity((0, 0, 0)))
    assert len(records) == 1 and counts == {"packets": 2, fault: 1}


def test_scraps_are_counted():
    for data, fault in ((b"", Fault.CUT), (b"\x07", Fault.CUT), (bytes(OVERSIZED + 1), Fault.OVERSIZED)):
        records, counts = sift(data)
        assert len(records) == 0 and counts == {"packets": 1, fault: 1}
    assert len(make_records(0)) == 0
