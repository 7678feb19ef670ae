"""Policy gradient: its slopes, its advantages, and that it improves a policy."""

import numpy as np
import pytest

from locomotion.training.policies import agent as a
from locomotion.training.policies.agent import Agent, Batch, advantages
from locomotion.training.policies.network import forward


def test_advantages_by_hand():
    reward, value = np.array([[1.0], [2.0], [3.0]]), np.array([[0.5], [0.25], [1.0], [4.0]], np.float32)
    done = np.array([[False], [True], [False]])
    found = advantages(reward, value, done, discount=0.9)
    last = 3.0 + 0.9 * 4.0 - 1.0
    middle = 2.0 - 0.25
    first = 1.0 + 0.9 * 0.25 - 0.5 + 0.9 * a.TRACE * middle
    np.testing.assert_allclose(found[:, 0], [first, middle, last])


def batch_of(agent, rng, count, gain):
    inputs = rng.normal(size=(count, 4)).astype(np.float32)
    means = agent.decide(inputs)
    decided, likelihood = agent.explore(means)
    return Batch(
        inputs,
        means,
        decided,
        likelihood,
        gain(inputs, decided).astype(np.float32),
        np.zeros(count, np.float32),
    )


def test_the_policys_slopes_are_those_of_finite_differences():
    rng = np.random.default_rng(0)
    agent = Agent(4, 3, rng, 0.3)
    batch = batch_of(agent, rng, 64, lambda x, d: rng.normal(size=len(x)))
    agent.actor = [each.astype(np.float64) for each in agent.actor]
    agent.spread = agent.spread.astype(np.float64) + 0.01

    def cost() -> float:
        e = (batch.decided - forward(agent.actor, batch.inputs)[-1]) / np.exp(agent.spread)
        ratio = np.exp(-0.5 * (e * e).sum(1) - agent.spread.sum() - batch.likelihood)
        clipped = np.clip(ratio, 0.8, 1.2)
        return float(-np.minimum(ratio * batch.advantage, clipped * batch.advantage).mean())

    slopes = agent.slopes(batch, np.arange(64))
    for values, slope, every in (
        (agent.actor[4], slopes[4], 40),
        (agent.actor[5], slopes[5], 1),
        (agent.spread, slopes[6], 1),
    ):
        for at in list(np.ndindex(values.shape))[::every]:
            kept = values[at]
            values[at] = kept + 1e-5
            above = cost()
            values[at] = kept - 1e-5
            below = cost()
            values[at] = kept
            assert abs((above - below) / 2e-5 - slope[at]) < 1e-4


def test_it_learns_what_pays():
    """Decisions that pay best are twice the first input."""
    rng = np.random.default_rng(1)
    agent = Agent(4, 1, rng, 0.3)
    agent.limit_noise(0.05, 0.3)

    def gain(inputs, decided):
        pays = -((decided[:, 0] - 2.0 * inputs[:, 0]) ** 2)
        return (pays - pays.mean()) / pays.std()

    def off() -> float:
        x = np.random.default_rng(2).normal(size=(200, 4)).astype(np.float32)
        return float(np.abs(agent.decide(x)[:, 0] - 2.0 * x[:, 0]).mean())

    before = off()
    for _ in range(60):
        agent.learn(batch_of(agent, rng, 2048, gain))
    assert off() < 0.3 * before


def test_a_policy_that_is_judged_only_stays_as_it_is_while_its_critic_learns():
    rng = np.random.default_rng(4)
    agent = Agent(4, 3, rng, 0.3)
    actor, critic, rate = [each.copy() for each in agent.actor], agent.critic[0].copy(), agent.rate
    batch = batch_of(agent, rng, 2048, lambda x, d: rng.normal(size=len(x)))
    assert agent.learn(batch, decides=False) == 0.0
    assert all((one == other).all() for one, other in zip(agent.actor, actor, strict=True))
    assert (agent.critic[0] != critic).any() and agent.rate == rate
    agent.learn(batch)
    assert (agent.actor[0] != actor[0]).any()


def test_noise_keeps_within_its_limits():
    rng = np.random.default_rng(5)
    agent = Agent(4, 1, rng, 0.3)
    agent.limit_noise(0.15, 0.2)
    assert np.exp(agent.spread) == pytest.approx(0.2)

    def gain(inputs, decided):  # doing nothing pays best
        pays = -np.abs(decided[:, 0])
        return (pays - pays.mean()) / pays.std()

    for _ in range(60):
        agent.learn(batch_of(agent, rng, 2048, gain))
    assert np.exp(agent.spread) == pytest.approx(0.15)


def test_statistics_of_inputs_are_those_of_all_seen():
    rng = np.random.default_rng(3)
    agent = Agent(2, 1, rng, 0.3)
    seen = rng.normal([3.0, -1.0], [2.0, 0.5], size=(5000, 2))
    for part in np.split(seen, 5):
        agent.count_in(part)
    np.testing.assert_allclose(agent.mean, seen.mean(axis=0), rtol=1e-3)
    np.testing.assert_allclose(agent.variance, seen.var(axis=0), rtol=1e-3)
