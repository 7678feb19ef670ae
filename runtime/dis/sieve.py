"""What of all that arrives is let through: whole Entity State PDUs of our exercise, with numbers that make
sense. All else is counted by kind and dropped."""

from collections import Counter
from collections.abc import Iterable

import numpy as np

from runtime.dis.dead_reckoning import MODELS
from runtime.dis.entity_state import ENTITY_STATE, SIZE, Fault, fault_of, length_at

__all__ = ["Address", "Sieve"]

Address = tuple[str, int]
OVERSIZED = 8192
"""Bytes of a PDU at most, and so of what we look at."""
_FASTEST, _SPINNING, _FARTHEST = 2000.0, 100.0, 1e8  # [m/s] and [m/s²], [rad/s], [m]


class Sieve:
    """``counts``: what was dropped, by `Fault` and other words; grows by these words only."""

    def __init__(self, exercise: int, counts: Counter[str]) -> None:
        self._exercise, self.counts = exercise, counts

    def passed(self, packets: Iterable[tuple[bytes, Address]]) -> tuple[np.ndarray, list[Address]]:
        """The PDUs (n,) of `ENTITY_STATE` in datagrams, in their order, and who sent each."""
        whole: list[bytes] = []
        senders: list[Address] = []
        for data, sender in packets:
            self.counts["packets"] += 1
            for offset in self._begins(data):
                whole.append(data[offset : offset + SIZE])
                senders.append(sender)
        records = np.frombuffer(b"".join(whole), ENTITY_STATE)
        good = self._sensible(records)
        if good.all():
            return records, senders
        return records[good], [sender for sender, holds in zip(senders, good, strict=True) if holds]

    def _begins(self, data: bytes) -> Iterable[int]:
        """Where whole Entity State PDUs begin in a datagram; several may be bundled in one."""
        if len(data) > OVERSIZED:
            self.counts[Fault.OVERSIZED] += 1
            return
        offset = 0
        while offset < len(data) or not data:
            fault = fault_of(data, offset, self._exercise)
            if fault is None:
                yield offset
            else:
                self.counts[fault] += 1
            length = length_at(data, offset)
            if length == 0:
                return
            offset += length

    def _sensible(self, records: np.ndarray) -> np.ndarray:
        """(n,) bool: whose numbers can be meant."""
        limits = {
            "location": _FARTHEST, "velocity": _FASTEST, "acceleration": _FASTEST,
            "angular_velocity": _SPINNING, "orientation": _SPINNING,
        }  # fmt: skip
        fits = np.ones(len(records), dtype=bool)
        for name, most in limits.items():
            fits &= (np.abs(records[name]) <= most).all(axis=1)  # not for NaN
        known = records["algorithm"] < len(MODELS)
        self.counts[Fault.NUMBERS] += int((~fits).sum())
        self.counts[Fault.MODEL] += int((fits & ~known).sum())
        return fits & known
