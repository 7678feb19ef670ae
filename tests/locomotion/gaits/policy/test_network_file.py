"""Networks in archives, and their compiled evaluation against the plain one."""

import numpy as np
import pytest

from locomotion.gaits.policy.evaluation import evaluate
from locomotion.gaits.policy.network_file import network_arrays, network_schema, read_network
from locomotion.training.policies.network import forward, new_layers

INPUTS, ACTIONS = 7, 3


@pytest.fixture
def network():
    rng = np.random.default_rng(5)
    mean, deviation = rng.standard_normal(INPUTS), rng.uniform(0.5, 2.0, INPUTS)
    layers = new_layers((INPUTS, 16, 8, ACTIONS), rng, 0.5)
    return mean.astype(np.float32), deviation.astype(np.float32), *layers


def test_it_is_read_as_it_was_written(network):
    arrays = network_arrays("some", network)
    assert set(arrays) == set(network_schema("some", INPUTS, ACTIONS))
    assert all(np.array_equal(a, b) for a, b in zip(network, read_network("some", arrays), strict=True))


def test_compiled_it_decides_as_in_the_plain_form(network):
    mean, deviation, *layers = network
    for seen in 20.0 * np.random.default_rng(6).standard_normal((5, INPUTS)):
        decided = np.empty(ACTIONS, np.float32)
        evaluate(network, seen, decided)
        scaled = np.clip((seen - mean) / deviation, -8.0, 8.0).astype(np.float32)
        assert decided == pytest.approx(forward(layers, scaled[None])[-1][0], abs=1e-5)
