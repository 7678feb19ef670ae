"""Timestamps of PDUs: time past the hour in 31 bits, and in the last bit whether that is UTC.

Relative ones count from a moment that only the sender knows. Absolute ones are meant to be UTC, but clocks of
machines differ; so `SenderClock` treats both alike.
"""

from dataclasses import dataclass

__all__ = ["HOUR", "SenderClock", "elapsed", "is_absolute", "past_the_hour", "timestamp"]

HOUR = 3600.0
"""[s]"""
_UNITS = 2**31  # to an hour
JUMP = 5.0
"""[s] by which a sender's clock and ours move differently from one packet to the next only if it was set."""
_STANDS = 0.5  # [s] after which a clock that still shows the same is taken for one that does not run
_MEMORY = 30.0  # [s] after which the quickest packet is forgotten, in one or two of which clocks drift apart


def timestamp(seconds: float, absolute: bool) -> int:
    """The field for a moment ``seconds`` [s] after any full hour."""
    units = round(seconds % HOUR / HOUR * _UNITS) % _UNITS
    return units << 1 | absolute


def past_the_hour(stamp: int) -> float:
    """[s] since the hour began, 0 to 3600."""
    return (stamp >> 1) * (HOUR / _UNITS)


def is_absolute(stamp: int) -> bool:
    """Whether it is UTC."""
    return bool(stamp & 1)


def elapsed(stamp: int, before: int) -> float:
    """[s, -1800 to 1800) from ``before`` to ``stamp``, the shorter way round the hour."""
    units = ((stamp >> 1) - (before >> 1) + _UNITS // 2) % _UNITS - _UNITS // 2
    return units * (HOUR / _UNITS)


@dataclass
class SenderClock:
    """One sender's clock, compared with ours by the packets that have come.

    The quickest packet of the last half to whole minute says how far the clocks are apart; what a packet
    comes later than that it was under way. Neither the difference between the clocks nor their drift matters.
    """

    stamp: int = -1
    time: float = 0.0
    """[s] of the sender's clock at ``stamp``, from its first packet on, over all full hours."""
    arrival: float = 0.0
    lead: float = 0.0
    """[s] that our clock was ahead of the sender's at the quickest packet of late."""
    former: float = 0.0
    """The same in the stretch before."""
    since: float = 0.0

    def age(self, stamp: int, arrival: float) -> float:
        """[s, at least 0] for which a packet was under way that arrived at ``arrival`` [s] of our clock."""
        later = 0.0 if self.stamp < 0 else elapsed(stamp, self.stamp)
        if self.stamp < 0 or abs(later - (arrival - self.arrival)) > JUMP:
            self.stamp, self.time, self.arrival = stamp, 0.0, arrival
            self.lead = self.former = arrival
            self.since = arrival
            return 0.0
        if later == 0.0 and arrival - self.arrival > _STANDS:
            return 0.0
        time = self.time + later
        lead = arrival - time
        if arrival - self.since > _MEMORY:
            self.former, self.lead, self.since = self.lead, lead, arrival
        self.lead = min(self.lead, lead)
        if later > 0.0:
            self.stamp, self.time, self.arrival = stamp, time, arrival
        return max(lead - min(self.lead, self.former), 0.0)
