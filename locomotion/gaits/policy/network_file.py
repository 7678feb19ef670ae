"""Networks of policies in archives."""

import numpy as np
from numpy.typing import NDArray

from surefoot.files.schema import Numbers

__all__ = ["PARTS", "Network", "network_arrays", "network_schema", "read_network", "weights"]

PARTS = ("mean", "deviation", "w0", "b0", "w1", "b1", "w2", "b2")

Network = tuple[NDArray[np.float32], ...]
"""Mean and deviation (inputs,) of the observations, then weights (inputs, outputs) and biases of three
layers."""


def weights(*shape: int | str) -> Numbers:
    """Learned numbers of a policy in an archive."""
    return Numbers(*shape, low=-1e6, high=1e6, dtype="float32")


def network_schema(name: str, inputs: int, actions: int) -> dict[str, Numbers]:
    """The arrays of a network under ``name``."""
    return {
        f"{name}_mean": weights(inputs),
        f"{name}_deviation": Numbers(inputs, low=1e-6, high=1e6, dtype="float32"),
        f"{name}_w0": weights(inputs, f"{name} first"),
        f"{name}_b0": weights(f"{name} first"),
        f"{name}_w1": weights(f"{name} first", f"{name} second"),
        f"{name}_b1": weights(f"{name} second"),
        f"{name}_w2": weights(f"{name} second", actions),
        f"{name}_b2": weights(actions),
    }


def network_arrays(name: str, network: Network) -> dict[str, NDArray[np.float32]]:
    """A network as arrays of an archive."""
    return {f"{name}_{part}": array for part, array in zip(PARTS, network, strict=True)}


def read_network(name: str, arrays: dict[str, NDArray]) -> Network:
    """The network of the arrays of an archive."""
    return tuple(np.ascontiguousarray(arrays[f"{name}_{part}"]) for part in PARTS)
