"""Slopes of networks against finite differences."""

import numpy as np

from locomotion.training.policies.network import Adam, backward, forward, new_layers


def test_slopes_are_those_of_finite_differences():
    rng = np.random.default_rng(0)
    layers = [each.astype(np.float64) for each in new_layers((5, 7, 6, 3), rng, 0.5)]
    x, wanted = rng.normal(size=(11, 5)), rng.normal(size=(11, 3))

    def cost() -> float:
        return float(0.5 * ((forward(layers, x)[-1] - wanted) ** 2).sum())

    values = forward(layers, x)
    slopes = backward(layers, values, values[-1] - wanted)
    for layer, slope in zip(layers, slopes, strict=True):
        for at in list(np.ndindex(layer.shape))[::3]:
            kept = layer[at]
            layer[at] = kept + 1e-5
            above = cost()
            layer[at] = kept - 1e-5
            below = cost()
            layer[at] = kept
            assert abs((above - below) / 2e-5 - slope[at]) < 1e-6


def test_adam_goes_down_at_its_rate():
    """The first step of Adam is the rate, against the slope's sign, whatever the slope's size."""
    layers = [np.array([1.0, -2.0], np.float32)]
    Adam(layers, 1e9).step(layers, [np.array([0.5, -50.0], np.float32)], 0.01)
    np.testing.assert_allclose(layers[0], [0.99, -1.99], atol=1e-6)
