"""How well people run: survival under pushes, speeds, turns, slopes, step length, ground reaction, time.

    python -m benchmarks.running [--seeds 100] [--json running.json]

Needs no data outside the package. Each figure is printed with how it was measured; 100 seeds of 60 s take
some minutes.
"""

import argparse
import json
import time
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from locomotion.body.person import CONTROL_DT, STEPS_PER_TICK
from locomotion.gaits.run import controller as c
from locomotion.gaits.run.skill import RunSkill, load_run_skill
from locomotion.training.gaits.rollout import Scenario, Simulator, stays_up
from locomotion.training.gaits.walk_starts import WALK_STARTS

SPEEDS = (1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
PUSHED_SPEED = 3.3
"""Speed [m/s] of the pushed runs."""


def constant(speed: float, duration: float, **options: Any) -> Scenario:
    """A trial at one desired speed [m/s]."""
    return Scenario(duration, np.array([[0.0, speed]]), **options)


def push_test(
    simulator: Simulator, skill: RunSkill, seeds: int, duration: float, force: float
) -> dict[str, float]:
    """Runs of ``duration`` [s] from a walk, pushed for 0.1 s with ``force`` [N] from anywhere every 5 s
    from 6 s on."""
    alive = []
    for seed in range(seeds):
        rng = np.random.default_rng(seed)
        times = np.arange(6.0, duration - 1.0, 5.0) + rng.uniform(0.0, 2.0)
        angle = rng.uniform(0.0, 2.0 * np.pi, len(times))
        pushes = np.stack(
            [times, force * np.cos(angle), force * np.sin(angle), np.full(len(times), 0.1)], axis=1
        )
        scenario = constant(PUSHED_SPEED, duration, pushes=pushes, walking=seed % WALK_STARTS)
        alive.append(stays_up(simulator.run(skill, scenario), scenario.duration))
    return {
        "seeds": seeds,
        "duration": duration,
        "force": force,
        "speed": PUSHED_SPEED,
        "survived": float(np.mean(alive)),
    }


def speed_test(simulator: Simulator, skill: RunSkill) -> list[dict[str, float]]:
    """20 s at each speed; the first 5 s do not count. The ground reaction is read at every physics step."""
    rows = []
    for speed in SPEEDS:
        seen: list[tuple[float, ...]] = []

        def note(sim: Simulator, seen: list = seen) -> None:
            state = sim.state
            if state[c.TICKS] > 500:
                switched = state[c.STEP_TIME] == 0.0
                length, pace = state[c.STEP_LENGTH], state[c.STEP_SPEED]
                seen.append(
                    (float(state[c.CONTACT].sum()), *((length, pace) if switched else (np.nan, np.nan)))
                )

        trial = simulator.run(skill, constant(speed, 20.0), note)
        table = np.array(seen) if seen else np.full((1, 3), np.nan)
        weight = float(simulator.model.body_mass.sum()) * 9.81
        rows.append(
            {
                "wanted": speed,
                "survived": trial.figures["time"],
                "speed": float(np.nanmean(table[:, 2])),
                "step_length": float(np.nanmean(table[:, 1])),
                "steps_per_s": float(np.nanmean(table[:, 2]) / np.nanmean(table[:, 1])),
                "peak_reaction": float(np.nanmax(table[:, 0]) / weight),
                "99th_percentile_reaction": float(np.nanpercentile(table[:, 0], 99) / weight),
                "flight": float(np.mean(table[:, 0] == 0.0)),
            }
        )
    return rows


def turn_test(simulator: Simulator, skill: RunSkill, runs: int) -> list[dict[str, float]]:
    """Share of runs of 8 s that hold a steady turn for 6 s; degrees per step as they were really made."""
    rows = []
    for speed in SPEEDS:
        for lateral in (0.7, 1.0, 1.4, 1.6):
            alive, made = [], []
            for run in range(runs):
                rng = np.random.default_rng(run)
                rate = (1 if run % 2 else -1) * lateral / speed
                turning = np.array([[0.0, 0.0], [1.0 + rng.uniform(0, 0.5), rate]])
                trial = simulator.run(skill, constant(speed, 8.0, headings=turning))
                alive.append(trial.figures["time"] > 7.98)
                made.append(np.degrees(abs(rate)) / max(trial.figures["step_rate"], 0.1))
            radius = speed * speed / lateral
            rows.append(
                {
                    "speed": speed,
                    "radius": radius,
                    "deg_per_step": float(np.mean(made)),
                    "survived": float(np.mean(alive)),
                }
            )
    return rows


def slope_test(simulator: Simulator, skill: RunSkill) -> list[dict[str, float]]:
    """Share of 8 directions in which 10 s at 3 m/s on a tilted plane are survived."""
    rows = []
    for degrees in (3, 6, 9, 12, 15):
        alive = []
        for direction in np.arange(8) * np.pi / 4:
            rise = np.tan(np.radians(degrees))
            tilt = (float(rise * np.cos(direction)), float(rise * np.sin(direction)))
            scenario = constant(3.0, 10.0, tilt=tilt)
            alive.append(stays_up(simulator.run(skill, scenario), scenario.duration))
        rows.append({"degrees": degrees, "survived": float(np.mean(alive))})
    return rows


def time_test(simulator: Simulator, skill: RunSkill, rounds: int = 5, ticks: int = 1000) -> dict[str, float]:
    """CPU time of control and observation on top of bare ``mj_step``, interleaved; median over ``rounds``."""
    simulator.run(skill, constant(3.5, 1.0))
    shares, rates = [], []
    model, data, state = simulator.model, simulator.data, simulator.state
    command = np.array([0.0, 3.5, 0.0])
    for _ in range(rounds):
        simulator.start(skill, constant(3.5, 1.0))
        physics = control = 0.0
        for _ in range(ticks):
            a = time.perf_counter()
            c.run_tick(*skill.tables, state, command, data.qpos, data.qvel, data.ctrl)
            b = time.perf_counter()
            mujoco.mj_step(model, data, STEPS_PER_TICK)
            d = time.perf_counter()
            c.observe(simulator.index, model, data, state)
            control += time.perf_counter() - d + b - a
            physics += d - b
        shares.append(control / physics)
        rates.append(ticks * CONTROL_DT / (control + physics))
    return {"control_over_physics": float(np.median(shares)), "simulated_s_per_s": float(np.median(rates))}


def print_table(title: str, rows: list[dict[str, float]]) -> None:
    """Rows with the same keys, as a table."""
    print(f"\n{title}")
    print("  ".join(f"{key:>12.24s}" for key in rows[0]))
    for row in rows:
        print("  ".join(f"{value:{max(12, min(len(key), 24))}.2f}" for key, value in row.items()))


def main() -> None:
    """Measure everything, print tables, write JSON."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--duration", type=float, default=60.0, help="of each pushed run [s]")
    parser.add_argument("--force", type=float, default=200.0, help="of the pushes [N]")
    parser.add_argument("--json", type=Path, help="file to write")
    options = parser.parse_args()
    skill, simulator = load_run_skill(), Simulator()
    result: dict[str, Any] = {}
    result["speeds"] = speed_test(simulator, skill)
    print_table("speed, 20 s each", result["speeds"])
    measured = np.array([[r["speed"], r["step_length"]] for r in result["speeds"]])
    measured = measured[np.isfinite(measured).all(axis=1)]
    a, b = np.polyfit(measured[:, 0], measured[:, 1], 1)
    result["step_length"] = {"a": float(a), "b": float(b)}
    print(f"step length = {a:.3f} v + {b:.3f}")
    result["turns"] = turn_test(simulator, skill, 10)
    print_table("steady turns of 7 s", result["turns"])
    result["slopes"] = slope_test(simulator, skill)
    print_table("tilted plane, 8 directions", result["slopes"])
    result["time"] = time_test(simulator, skill)
    print(
        f"\ncontrol: {100 * result['time']['control_over_physics']:.1f} % of mj_step; "
        f"{result['time']['simulated_s_per_s']:.0f} simulated seconds per second"
    )
    result["pushes"] = push_test(simulator, skill, options.seeds, options.duration, options.force)
    p = result["pushes"]
    print(
        f"\n{p['seeds']} seeds of {p['duration']:.0f} s from standing at {p['speed']} m/s, pushed with "
        f"{p['force']:.0f} N x 0.1 s every 5 s from 6 s on: {100 * p['survived']:.0f} % survive"
    )
    if options.json:
        options.json.write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
