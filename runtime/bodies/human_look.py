"""How a simulated person is seen."""

from dataclasses import dataclass

import numpy as np

from locomotion.body.person import CONTROL_DT
from locomotion.human.sized_human import Glimpse, SizedHuman
from locomotion.recorded_people.fading import fade_from, faded, rates
from locomotion.saved_arrays import check_array, check_number

__all__ = ["Fading", "HumanLook"]


@dataclass(frozen=True)
class Fading:
    """How a person is drawn beside its simulated pose ``since`` [s] it was made: see
    `locomotion.recorded_people.fading`."""

    offsets: np.ndarray
    rates: np.ndarray
    seconds: float
    since: float

    def check(self) -> None:
        """Raises `LocomotionError` for what nobody's pose does."""
        check_array("what fades of a person's pose", self.offsets, 45)
        check_array("how fast a person's pose fades", self.rates, 45)
        check_number("how long a person's pose fades", self.seconds, 1e-3, 10.0)


class HumanLook:
    """The look of ``body``. ``before``: when `remember` was called, or None; ``fading``: beside its pose."""

    def __init__(self, body: SizedHuman) -> None:
        self._body = body
        self.before: Glimpse | None = None
        self.fading: Fading | None = None

    def remember(self) -> None:
        """Keep what it looks like now."""
        self.before = self._body.glimpse()

    def drawn(self) -> tuple[np.ndarray, np.ndarray]:
        """The pose (46,) in which it is drawn, and how fast that changes (45,), as `fading.rates`."""
        pose, now = self._body.pose(), self._body.rates()
        if self.fading is None:
            return pose, now
        before, after = self._faded(pose, -0.5 * CONTROL_DT), self._faded(pose, 0.5 * CONTROL_DT)
        return self._faded(pose, 0.0), now + rates(before, after, CONTROL_DT)

    def fade(self, pose: np.ndarray, pose_rates: np.ndarray) -> None:
        """Let it look as if it came from ``pose`` (46,), which changed by ``pose_rates`` (45,)."""
        self.fading = None
        offsets, offset_rates, seconds = fade_from(pose, pose_rates, *self.drawn())
        self.fading = Fading(offsets, offset_rates, seconds, self._body.time)

    def _faded(self, pose: np.ndarray, ahead: float) -> np.ndarray:
        fading = self.fading
        if fading is None:
            return pose
        elapsed = self._body.time - fading.since + ahead
        if elapsed >= fading.seconds:
            return pose
        return faded(pose, fading.offsets, fading.rates, fading.seconds, max(elapsed, 0.0))

    def pose(self) -> np.ndarray:
        """(46,) in which it is drawn."""
        return self._faded(self._body.pose(), 0.0)

    def pose_between(self, share: float) -> np.ndarray:
        """(46,) a ``share`` (0 to 1) of the way from when `remember` was called."""
        if self.before is None:
            return self.pose()
        pose = self._body.mixed(self._body.pose(self.before), self._body.pose(), share)
        return self._faded(pose, (share - 1.0) * CONTROL_DT)
