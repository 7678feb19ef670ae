"""A nonlinear support vector machine with calibrated odds, as plain arrays.

The decision is f(x) = Σ c_i exp(-γ |z - z_i|²) + b, where z is x, kept within what was sampled, less its mean
and over its deviation. The odds are 1 / (1 + exp(-(a f + o))) (Platt, 1999). Learned in
`locomotion.training.preconditions.fitting`; asking takes no scikit-learn.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from surefoot.kernels import allocating_kernel

__all__ = ["Machine", "decide_exactly", "odds_exactly", "odds_into"]


class Machine(NamedTuple):
    """A precondition.

    columns: (n,) int32, which features count. low, high: (n,) range of each in the samples; beyond it an end
    of the range counts. mean, scale: (n,). centres: (n, m) support vectors, scaled. weights: (m,) their c_i.
    numbers: (4,) γ, b, a, o.
    """

    columns: NDArray[np.int32]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    mean: NDArray[np.float64]
    scale: NDArray[np.float64]
    centres: NDArray[np.float64]
    weights: NDArray[np.float64]
    numbers: NDArray[np.float64]


def decide_exactly(machine: Machine, features: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) decisions for ``features`` (k, all), in plain NumPy."""
    counting = np.clip(features[:, machine.columns], machine.low, machine.high)
    scaled = (counting - machine.mean) / machine.scale
    apart = ((scaled[:, :, None] - machine.centres) ** 2).sum(axis=1)
    return np.exp(-machine.numbers[0] * apart) @ machine.weights + machine.numbers[1]


def odds_exactly(machine: Machine, features: NDArray[np.float64]) -> NDArray[np.float64]:
    """(k,) odds, 0 to 1, for ``features`` (k, all), in plain NumPy: what tests compare `odds_into` with."""
    slope, offset = machine.numbers[2:]
    return 1.0 / (1.0 + np.exp(-(slope * decide_exactly(machine, features) + offset)))


@allocating_kernel
def odds_into(columns, low, high, mean, scale, centres, weights, numbers, features, out):
    """Odds, 0 to 1, of ``features`` (k, all) into ``out`` (k,); the other arguments are a `Machine`'s."""
    wide, many = centres.shape
    apart = np.empty(many)
    for k in range(features.shape[0]):
        apart[:] = 0.0
        for j in range(wide):
            value = min(max(features[k, columns[j]], low[j]), high[j])
            value = (value - mean[j]) / scale[j]
            for i in range(many):
                off = value - centres[j, i]
                apart[i] += off * off
        decision = numbers[1]
        for i in range(many):
            decision += weights[i] * math.exp(-numbers[0] * apart[i])
        out[k] = 1.0 / (1.0 + math.exp(-(numbers[2] * decision + numbers[3])))
