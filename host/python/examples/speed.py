"""Steps per second, one episode at a time and as a vector on one and two threads, and the cost of saved states.

`python host/python/examples/speed.py [TASK]`: medians of rounds that take turns, wall time.
"""

from __future__ import annotations

import copy
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import onetwo
from onetwo.env import TaskEnv, TaskVectorEnv

ROUNDS = 7
STEPS = 100
COPIES = 256


def single(task: str) -> Callable[[], int]:
    """`TaskEnv.step` with drawn actions."""
    env = TaskEnv(task=task)
    actions = np.random.default_rng(1).uniform(-1, 1, (STEPS * 20, *env.action_space.shape)).astype(np.float32)

    def run() -> int:
        env.reset(seed=1)
        for action in actions:
            _, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                env.reset()
        return len(actions)

    return run


def vector(task: str, threads: int) -> Callable[[], int]:
    """`TaskVectorEnv.step` of many copies."""
    envs = TaskVectorEnv(COPIES, threads=threads, task=task)
    actions = np.random.default_rng(1).uniform(-1, 1, (STEPS, COPIES, *envs.single_action_space.shape)).astype(np.float32)

    def run() -> int:
        envs.reset(seed=1)
        for action in actions:
            envs.step(action)
        return STEPS * COPIES

    return run


def microseconds(call: Callable[[], Any], times: int = 200) -> float:
    """Median time of a call, µs."""
    found = []
    for _ in range(times):
        began = time.perf_counter()
        call()
        found.append(1e6 * (time.perf_counter() - began))
    return statistics.median(found)


def main() -> None:
    task = sys.argv[1] if len(sys.argv) > 1 else "score"
    sides = {"single": single(task), "vector, 1 thread": vector(task, 1), "vector, 2 threads": vector(task, 2)}
    rates: dict[str, list[float]] = {name: [] for name in sides}
    for _ in range(ROUNDS):
        for name, run in sides.items():
            began = time.perf_counter()
            steps = run()
            rates[name].append(steps / (time.perf_counter() - began))
    for name, found in rates.items():
        print(f"{name:18} {statistics.median(found):9.0f} steps/s")
    ratios = [two / one for one, two in zip(rates["vector, 1 thread"], rates["vector, 2 threads"])]
    print(f"two threads / one  {statistics.median(ratios):9.2f}")
    simulator = onetwo.Simulator(task=task, seed=1)
    for _ in range(20):
        simulator.step([0.1] * simulator.action_size)
    state = simulator.save()
    print(f"save {microseconds(simulator.save):.0f} µs, {len(state)} bytes; restore ", end="")
    print(f"{microseconds(lambda: simulator.restore(state)):.0f} µs; ", end="")
    print(f"copy.deepcopy {microseconds(lambda: copy.deepcopy(simulator)):.0f} µs")


if __name__ == "__main__":
    main()
