"""The policy and its critic while they learn: proximal policy optimisation.

Schulman et al. (2017), "Proximal policy optimization algorithms", with generalised advantage estimation
(Schulman et al. 2016) and a rate of learning that keeps to a wanted change of the policy.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from locomotion.gaits.policy.layout import MOST_INPUT
from locomotion.gaits.policy.network_file import Network
from locomotion.training.policies.network import Adam, Layers, Values, backward, forward, new_layers

__all__ = ["Agent", "Batch", "advantages"]

HIDDEN = (128, 128)
TRACE = 0.95
_CLIP, _EPOCHS, _PART = 0.2, 4, 2048
_CHANGE = 0.018  # wanted divergence of the new policy from the old one
_CRITIC_RATE, _SLOWEST, _FASTEST = 1e-3, 2e-5, 2e-3
_LEAST_VARIANCE = 1e-4  # of an input
_FORGET = 2_000_000.0  # samples after which statistics of the inputs hardly change
_EVERY = 7  # part of the samples on which the divergence is measured


def advantages(
    reward: NDArray[np.float64], value: NDArray[np.float32], done: NDArray[np.bool_], discount: float
) -> NDArray[np.float64]:
    """How much better than expected things went, (t, n), from rewards (t, n), values (t + 1, n) and ends.
    ``discount``: what a reward is worth a decision later."""
    gained, ahead = np.zeros_like(reward), np.zeros(reward.shape[1])
    for t in range(len(reward) - 1, -1, -1):
        goes_on = 1.0 - done[t]
        ahead = reward[t] + discount * value[t + 1] * goes_on - value[t] + discount * TRACE * goes_on * ahead
        gained[t] = ahead
    return gained


@dataclass(frozen=True)
class Batch:
    """What was tried, n samples: scaled inputs, means and decisions, log-likelihoods, advantages, returns."""

    inputs: Values
    means: Values
    decided: Values
    likelihood: Values
    advantage: Values
    returns: Values


class Agent:
    """Policy and critic.

    Attributes:
      actor, critic: their layers. spread: (actions,) logarithm of the noise. mean, variance: of the inputs,
      (inputs,) float32.
    """

    def __init__(self, inputs: int, actions: int, rng: np.random.Generator, noise: float) -> None:
        self.rng = rng
        self.actor, self.critic = (
            new_layers((inputs, *HIDDEN, actions), rng, 0.01),
            new_layers((inputs, *HIDDEN, 1), rng, 1.0),
        )
        self.spread = np.full(actions, np.log(noise), np.float32)
        self.mean, self.variance, self.counted = (
            np.zeros(inputs, np.float32),
            np.ones(inputs, np.float32),
            0.01,
        )
        self._limits = self.spread[0], self.spread[0]
        self.rate = 3e-4
        self._improve, self._improve_critic = Adam([*self.actor, self.spread], 1.0), Adam(self.critic, 5.0)

    @property
    def network(self) -> Network:
        """What is used at run time of what was learned."""
        deviation = np.sqrt(self.variance + _LEAST_VARIANCE).astype(np.float32)
        return self.mean.copy(), deviation, *(layer.copy() for layer in self.actor)

    def begin_as(self, network: Network) -> None:
        """Decide as a ``network`` does, and learn from there."""
        mean, deviation, *layers = network
        self.mean[:], self.counted = mean, _FORGET
        self.variance[:] = deviation**2 - np.float32(_LEAST_VARIANCE)
        for mine, theirs in zip(self.actor, layers, strict=True):
            mine[...] = theirs

    def count_in(self, observed: NDArray[np.float64]) -> None:
        """Learn how large inputs are, from some (n, inputs)."""
        n, mean, variance = len(observed), observed.mean(axis=0), observed.var(axis=0)
        off, counted = mean - self.mean, self.counted + n
        spread = self.variance * self.counted + variance * n + off * off * self.counted * n / counted
        self.variance = (spread / counted).astype(np.float32)
        self.mean = (self.mean + off * n / counted).astype(np.float32)
        self.counted = min(counted, _FORGET)

    def scaled(self, observed: NDArray[np.float64]) -> Values:
        """Inputs of the networks, (n, inputs)."""
        x = (observed - self.mean) / np.sqrt(self.variance + _LEAST_VARIANCE)
        return np.clip(x, -MOST_INPUT, MOST_INPUT).astype(np.float32)

    def decide(self, inputs: Values) -> Values:
        """Mean decisions, (n, actions)."""
        return forward(self.actor, inputs)[-1]

    def expect(self, inputs: Values) -> Values:
        """Expected returns, (n,)."""
        return forward(self.critic, inputs)[-1][:, 0]

    def explore(self, means: Values) -> tuple[Values, Values]:
        """Decisions around ``means``, and the logarithm of their likelihood but for a constant."""
        e = self.rng.standard_normal(means.shape).astype(np.float32)
        return means + np.exp(self.spread) * e, -0.5 * (e * e).sum(axis=1) - self.spread.sum()

    def limit_noise(self, least: float, most: float) -> None:
        """Keep the noise of what is tried between these limits. Below 0.07 it makes hardly anybody fall, and
        the policy forgets how not to."""
        self._limits = np.log(np.float32(least)), np.log(np.float32(most))
        np.clip(self.spread, *self._limits, out=self.spread)

    def learn(self, batch: Batch, decides: bool = True) -> float:
        """Improve the critic on a batch, and the policy if it ``decides`` anew; gives how much it changed."""
        count, before, change = len(batch.inputs), self.spread.copy(), 0.0
        for _ in range(_EPOCHS):
            order = self.rng.permutation(count)
            for k in range(0, count - min(_PART, count) + 1, _PART):
                self._learn_part(batch, order[k : k + _PART], decides)
            change = self._change(batch, before)
            if change > 2.0 * _CHANGE:
                break
        if not decides:
            return change
        if change > 2.0 * _CHANGE:
            self.rate = max(self.rate / 1.4, _SLOWEST)
        elif change < _CHANGE / 1.5:
            self.rate = min(self.rate * 1.2, _FASTEST)
        return change

    def slopes(self, batch: Batch, part: NDArray[np.int64]) -> Layers:
        """Slopes of the cost of the policy, by its layers and the spread, over a ``part`` of the batch."""
        values = forward(self.actor, batch.inputs[part])
        noise = np.exp(self.spread)
        e = (batch.decided[part] - values[-1]) / noise
        likelihood = -0.5 * (e * e).sum(axis=1) - self.spread.sum()
        ratio = np.exp(np.clip(likelihood - batch.likelihood[part], -10.0, 10.0))
        gain = batch.advantage[part]
        clipped = ((ratio > 1.0 + _CLIP) & (gain > 0.0)) | ((ratio < 1.0 - _CLIP) & (gain < 0.0))
        cost = (-(gain * ratio * ~clipped) / len(part)).astype(np.float32)[:, None]
        return [*backward(self.actor, values, cost * (e / noise)), (cost * (e * e - 1.0)).sum(axis=0)]

    def _learn_part(self, batch: Batch, part: NDArray[np.int64], decides: bool) -> None:
        if decides:
            self._improve.step([*self.actor, self.spread], self.slopes(batch, part), self.rate)
            np.clip(self.spread, *self._limits, out=self.spread)
        values = forward(self.critic, batch.inputs[part])
        off = values[-1][:, 0] - batch.returns[part]
        slopes = backward(self.critic, values, (2.0 / len(part) * off).astype(np.float32)[:, None])
        self._improve_critic.step(self.critic, slopes, _CRITIC_RATE)

    def _change(self, batch: Batch, before: Values) -> float:
        """Mean divergence of the new policy from the old one."""
        moved = self.decide(batch.inputs[::_EVERY]) - batch.means[::_EVERY]
        spread = (np.exp(2.0 * before) + moved * moved) / (2.0 * np.exp(2.0 * self.spread))
        return float((self.spread - before + spread - 0.5).sum(axis=1).mean())

    # ---- saved and restored

    def arrays(self) -> dict[str, NDArray[Any]]:
        """All that learning goes on from, besides `rng` and `numbers`."""
        lists = {
            "actor": self.actor, "critic": self.critic, "actor_first": self._improve.first,
            "actor_second": self._improve.second, "critic_first": self._improve_critic.first,
            "critic_second": self._improve_critic.second,
        }  # fmt: skip
        found = {f"{name}_{k}": array for name, arrays in lists.items() for k, array in enumerate(arrays)}
        return {**found, "spread": self.spread, "mean": self.mean, "variance": self.variance}

    def numbers(self) -> dict[str, float]:
        """The same, single numbers."""
        return {"counted": self.counted, "rate": self.rate, "steps": self._improve.steps,
                "critic_steps": self._improve_critic.steps}  # fmt: skip

    def restore(self, arrays: dict[str, NDArray[Any]], numbers: dict[str, float]) -> None:
        """Go on from `arrays` and `numbers`."""
        for name, array in self.arrays().items():
            array[...] = arrays[name]
        self.counted, self.rate = numbers["counted"], numbers["rate"]
        self._improve.steps, self._improve_critic.steps = int(numbers["steps"]), int(numbers["critic_steps"])
