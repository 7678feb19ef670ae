"""Corrections without a jump: what a figure was drawn off by dies away.

When a packet says that a figure is elsewhere than it is drawn, the difference becomes an offset, with the
difference of the velocities, and goes to 0 like a critically damped spring. So neither the place nor the
velocity that is drawn ever jumps.
"""

import numpy as np

__all__ = ["advanced", "rate_for"]

_QUICKEST = 5.0
"""[1/s] rate at which small offsets die away: to a tenth within 0.8 s."""


def rate_for(offset: np.ndarray, fastest: float) -> np.ndarray:
    """(n,) [1/s] rates at which offsets (n, d) die away with at most ``fastest`` [1/s of their unit] in
    between: the greatest speed of such a spring let go at rest is offset · rate / e."""
    size = np.linalg.norm(offset, axis=-1)
    return np.minimum(_QUICKEST, fastest * np.e / np.maximum(size, 1e-9))


def advanced(
    offset: np.ndarray, speed: np.ndarray, rate: np.ndarray, seconds: float
) -> tuple[np.ndarray, np.ndarray]:
    """Offsets and their speeds (n, ...) ``seconds`` later, exactly; ``rate`` (n,)."""
    rate = rate.reshape(-1, *(1,) * (offset.ndim - 1))
    grows = speed + rate * offset
    fades = np.exp(-rate * seconds)
    later = (offset + grows * seconds) * fades
    return later, (grows * (1.0 - rate * seconds) - rate * offset) * fades
