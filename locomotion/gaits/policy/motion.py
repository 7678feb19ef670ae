"""The reference motion of a policy at run time: targets of its joints over the cycle, at each speed."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

__all__ = ["Motion", "Place"]


@dataclass(frozen=True)
class Place:
    """Rows of a table around some speeds and shares of the cycle, and their weights; all (n,)."""

    slower: NDArray[np.int64]
    earlier: NDArray[np.int64]
    later: NDArray[np.int64]
    faster_share: NDArray[np.float64]
    later_share: NDArray[np.float64]

    def read(self, table: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values of a ``table`` (s, n, ...) there, linear between its rows, (n, ...)."""
        shape = (-1,) + (1,) * (table.ndim - 2)
        a, b = self.faster_share.reshape(shape), self.later_share.reshape(shape)
        i = self.slower
        slow = (1.0 - b) * table[i, self.earlier] + b * table[i, self.later]
        fast = (1.0 - b) * table[i + 1, self.earlier] + b * table[i + 1, self.later]
        return (1.0 - a) * slow + a * fast

    def read_rows(self, table: NDArray[np.float64]) -> NDArray[np.float64]:
        """The same of a ``table`` (s, k) that does not change over the cycle, (n, k)."""
        a = self.faster_share[:, None]
        return (1.0 - a) * table[self.slower] + a * table[self.slower + 1]


@dataclass(frozen=True)
class Motion:
    """Angles of `layout.JOINTS` over the cycle, and in a stand.

    Attributes:
      speeds, periods: (s,) float64: [m/s], from 0 (steps in place), and [s] of a cycle there.
      joints, rates: (1 + s, n, 24) float64 [rad], [rad/s] at equal shares of the cycle: first of the stand,
        which is the same at all of them, then at each speed.
      stance: (2,) float64: where the middle of the feet is ahead of the root in a stand, and how far their
        middles are apart [m].
    """

    speeds: NDArray[np.float64]
    periods: NDArray[np.float64]
    joints: NDArray[np.float64]
    rates: NDArray[np.float64]
    stance: NDArray[np.float64]

    @cached_property
    def means(self) -> NDArray[np.float64]:
        """(1 + s, 24) float64, mean angles over the cycle [rad]."""
        return self.joints.mean(axis=1)

    @property
    def stand(self) -> NDArray[np.float64]:
        """(24,) float64, angles of the stand [rad]."""
        return self.joints[0, 0]

    def at(
        self, phase: NDArray[np.float64], speed: NDArray[np.float64], running: NDArray[np.float64]
    ) -> Place:
        """Where the shares ``phase`` of the cycle at ``speed`` [m/s] lie in the tables; the stand where
        ``running`` is 0; all (n,)."""
        v = np.clip(speed, self.speeds[0], self.speeds[-1])
        slower = np.clip(np.searchsorted(self.speeds, v, side="right") - 1, 0, len(self.speeds) - 2)
        share = (v - self.speeds[slower]) / (self.speeds[slower + 1] - self.speeds[slower])
        goes_on = running > 0.0
        samples = self.joints.shape[1]
        x = (phase - np.floor(phase)) * samples
        low = x.astype(np.int64)
        earlier = low % samples
        return Place(
            np.where(goes_on, 1 + slower, 0),
            earlier,
            (earlier + 1) % samples,
            np.where(goes_on, share, 0.0),
            x - low,
        )

    def period(self, speed: NDArray[np.float64]) -> NDArray[np.float64]:
        """[s] of a cycle at ``speed`` (n,) [m/s]."""
        return np.interp(speed, self.speeds, self.periods)
