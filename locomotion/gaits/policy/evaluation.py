"""Evaluation of a network, compiled; `locomotion.training.policies.network.forward` is its plain form."""

import math

import numpy as np

from locomotion.gaits.policy.layout import MOST_INPUT
from surefoot.kernels import allocating_kernel, kernel

__all__ = ["evaluate"]


@kernel
def _layer(weights, biases, x, out, last):
    """One layer of the network, with tanh but for the ``last``."""
    for j in range(out.shape[0]):
        out[j] = biases[j]
    for i in range(x.shape[0]):
        v = x[i]
        for j in range(out.shape[0]):
            out[j] += v * weights[i, j]
    if not last:
        for j in range(out.shape[0]):
            out[j] = math.tanh(out[j])


@allocating_kernel
def evaluate(network, observed, decided):
    """What the ``network`` decides, into ``decided`` (outputs,) float32, from what was ``observed`` (inputs,)
    float64.

    network: mean and deviation (inputs,) of the inputs, and weights and biases of three layers, float32.
    """
    mean, deviation, w0, b0, w1, b1, w2, b2 = network
    inputs = np.empty(observed.shape[0], np.float32)
    for k in range(observed.shape[0]):
        value = (observed[k] - mean[k]) / deviation[k]
        inputs[k] = min(max(value, -MOST_INPUT), MOST_INPUT)
    first, second = np.empty(b0.shape[0], np.float32), np.empty(b1.shape[0], np.float32)
    _layer(w0, b0, inputs, first, False)
    _layer(w1, b1, first, second, False)
    _layer(w2, b2, second, decided, True)
