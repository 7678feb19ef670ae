"""Networks of a few layers, their gradients, and how they are improved."""

from collections.abc import Sequence
from itertools import pairwise
from typing import cast

import numpy as np
from numpy.typing import NDArray

__all__ = ["Adam", "Layers", "backward", "forward", "new_layers"]

Values = NDArray[np.float32]
Layers = list[Values]
"""Weights (inputs, outputs) and biases (outputs,) of each layer in turn, float32. Between layers: tanh."""
_GAIN = 1.2


def new_layers(sizes: Sequence[int], rng: np.random.Generator, last: float) -> Layers:
    """Random orthogonal layers; ``last``: scale of the weights of the last one."""
    layers: Layers = []
    for k, (inputs, outputs) in enumerate(pairwise(sizes)):
        u, _, vt = np.linalg.svd(rng.standard_normal((inputs, outputs)), full_matrices=False)
        scale = last if k == len(sizes) - 2 else _GAIN
        layers += [(scale * (u @ vt)).astype(np.float32), np.zeros(outputs, np.float32)]
    return layers


def forward(layers: Layers, x: Values) -> list[Values]:
    """Values of ``x`` (n, inputs) and after each layer."""
    values = [x]
    for k in range(0, len(layers), 2):
        z = values[-1] @ layers[k] + layers[k + 1]
        values.append(z if k == len(layers) - 2 else np.tanh(z, out=z))
    return values


def backward(layers: Layers, values: list[Values], slope: Values) -> Layers:
    """Slopes of a cost by all weights and biases, from its ``slope`` (n, outputs) by the last of
    `forward`'s values."""
    slopes: Layers = []
    for k in range(len(layers) - 2, -1, -2):
        below = values[k // 2]
        slopes = [below.T @ slope, slope.sum(axis=0), *slopes]
        if k:
            slope = cast(Values, (slope @ layers[k].T) * (np.float32(1.0) - below * below))
    return slopes


class Adam:
    """Adam (Kingma and Ba 2015) with the slopes' length limited to ``most``."""

    def __init__(self, layers: Layers, most: float) -> None:
        self.first, self.second = [np.zeros_like(p) for p in layers], [np.zeros_like(p) for p in layers]
        self.steps, self._most = 0, most

    def step(self, layers: Layers, slopes: Layers, rate: float) -> None:
        """Change ``layers`` against the ``slopes``."""
        length = float(np.sqrt(sum(float((g * g).sum()) for g in slopes)))
        share, self.steps = np.float32(min(1.0, self._most / (length + 1e-8))), self.steps + 1
        size = np.float32(rate * np.sqrt(1.0 - 0.999**self.steps) / (1.0 - 0.9**self.steps))
        for p, g, m, v in zip(layers, slopes, self.first, self.second, strict=True):
            g = g * share
            m += np.float32(0.1) * (g - m)
            v += np.float32(0.001) * (g * g - v)
            p -= size * m / (np.sqrt(v) + np.float32(1e-8))
