"""Entity State PDUs of IEEE 1278.1 as bytes and as NumPy records, versions 5 to 7.

The layout is one structured dtype, big-endian. So what is read and written again is the same bytes, and many
PDUs are read in one go.
"""

import struct
from dataclasses import dataclass, field

import numpy as np

from runtime.errors import RuntimeInputError

__all__ = [
    "ENTITY_STATE",
    "PART",
    "SIZE",
    "VERSIONS",
    "EntityState",
    "Fault",
    "MalformedPdu",
    "decode",
    "fault_of",
    "length_at",
    "make_records",
]

VERSIONS = (5, 6, 7)
"""Protocol versions that are read: IEEE 1278.1-1995, 1278.1A-1998, 1278.1-2012."""
_ENTITY_STATE_TYPE, _ENTITY_INFORMATION = 1, 1
_HEADER = struct.Struct(">BBBBIH")
HEADER_SIZE = 12
"""Bytes of a PDU's header."""

ENTITY_TYPE = np.dtype(
    [
        ("kind", "u1"), ("domain", "u1"), ("country", ">u2"), ("category", "u1"), ("subcategory", "u1"),
        ("specific", "u1"), ("extra", "u1"),
    ]
)  # fmt: skip
ENTITY_STATE = np.dtype(
    [
        ("version", "u1"), ("exercise", "u1"), ("pdu_type", "u1"), ("family", "u1"), ("timestamp", ">u4"),
        ("length", ">u2"), ("status", "u1"), ("padding", "u1"),
        ("site", ">u2"), ("application", ">u2"), ("entity", ">u2"), ("force", "u1"), ("parts", "u1"),
        ("type", ENTITY_TYPE), ("alternative_type", ENTITY_TYPE),
        ("velocity", ">f4", 3), ("location", ">f8", 3), ("orientation", ">f4", 3), ("appearance", ">u4"),
        ("algorithm", "u1"), ("other_parameters", "u1", 15),
        ("acceleration", ">f4", 3), ("angular_velocity", ">f4", 3),
        ("character_set", "u1"), ("marking", "S11"), ("capabilities", ">u4"),
    ]
)  # fmt: skip
"""144 bytes. ``velocity`` [m/s] and ``acceleration`` [m/s²] are geocentric, or in body axes if the
dead-reckoning ``algorithm`` is 6 to 9; ``location`` [m] is geocentric; ``orientation`` [rad] is psi, theta,
phi from geocentric to body axes (x ahead, y right, z down); ``angular_velocity`` [rad/s] in body axes."""
SIZE = ENTITY_STATE.itemsize

PART = np.dtype(
    [
        ("record", "u1"), ("change", "u1"), ("attached_to", ">u2"), ("parameter", ">u4"), ("value", ">f4"),
        ("padding", ">u4"),
    ]
)  # fmt: skip
"""16 bytes after the PDU for each articulated (``record`` 0) or attached (1) part. Of an attached part, and
of the other records of version 7, ``value`` and ``padding`` hold something else; their bytes are kept."""


class Fault:
    """Why a PDU is dropped: what it is counted under."""

    CUT = "cut off"
    OVERSIZED = "oversized"
    LENGTH = "wrong length"
    VERSION = "another version"
    EXERCISE = "another exercise"
    OTHER = "not an entity state"
    NUMBERS = "numbers out of range"
    MODEL = "unknown dead reckoning"


class MalformedPdu(RuntimeInputError):
    """Bytes that are no Entity State PDU; ``fault`` is one of `Fault`."""

    def __init__(self, fault: str, message: str) -> None:
        super().__init__(message)
        self.fault = fault


@dataclass(frozen=True, eq=False)
class EntityState:
    """One PDU. ``record``: () of `ENTITY_STATE`; ``parts``: (n,) of `PART`."""

    record: np.ndarray
    parts: np.ndarray = field(default_factory=lambda: np.zeros(0, PART))

    def encode(self) -> bytes:
        """Its bytes. The fields for length and number of parts are written as they are."""
        return self.record.tobytes() + self.parts.tobytes()

    @property
    def name(self) -> tuple[int, int, int]:
        """Site, application and entity: its own in an exercise."""
        record = self.record
        return int(record["site"]), int(record["application"]), int(record["entity"])

    @property
    def marking(self) -> str:
        """What is written on it, where that is ASCII."""
        return self.record["marking"].item().decode("ascii", "replace")


def make_records(count: int, version: int = 7, exercise: int = 1) -> np.ndarray:
    """(count,) of `ENTITY_STATE` with headers filled in and everything else 0."""
    records = np.zeros(count, ENTITY_STATE)
    records["version"], records["exercise"] = version, exercise
    records["pdu_type"], records["family"] = _ENTITY_STATE_TYPE, _ENTITY_INFORMATION
    records["length"] = SIZE
    records["character_set"] = 1  # ASCII
    return records


def length_at(data: bytes, offset: int) -> int:
    """The length of the PDU that begins at ``offset``, 0 where there is none."""
    if offset + HEADER_SIZE > len(data):
        return 0
    length = _HEADER.unpack_from(data, offset)[5]
    return length if HEADER_SIZE <= length <= len(data) - offset else 0


def fault_of(data: bytes, offset: int, exercise: int | None = None) -> str | None:
    """Why the PDU at ``offset`` is no whole Entity State PDU (of an ``exercise``); None if it is one. Its
    numbers are not looked at."""
    if offset + HEADER_SIZE > len(data):
        return Fault.CUT
    version, its, kind, family, _, length = _HEADER.unpack_from(data, offset)
    if version not in VERSIONS:
        return Fault.VERSION
    if exercise is not None and its != exercise:
        return Fault.EXERCISE
    if (kind, family) != (_ENTITY_STATE_TYPE, _ENTITY_INFORMATION):
        return Fault.OTHER
    if offset + length > len(data):
        return Fault.CUT
    if length < SIZE or length != SIZE + PART.itemsize * data[offset + 19]:
        return Fault.LENGTH
    return None


def decode(data: bytes) -> EntityState:
    """Read one PDU that fills ``data``. Raises `MalformedPdu` for anything else."""
    fault = fault_of(data, 0)
    if fault is None and length_at(data, 0) != len(data):
        fault = Fault.LENGTH
    if fault is not None:
        raise MalformedPdu(
            fault,
            f"{len(data)} bytes are no Entity State PDU: {fault}; expected version 5, 6 or 7, PDU type 1, "
            f"and {SIZE} bytes and {PART.itemsize} for each part",
        )
    record = np.frombuffer(data, ENTITY_STATE, 1).reshape(())
    return EntityState(record, np.frombuffer(data, PART, offset=SIZE))
