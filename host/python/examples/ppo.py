"""PPO on shoot-at-keeper, from scratch and after copying what the case-based players do: goals in 100 episodes.

    pip install "./host/python[gym]" stable-baselines3
    python host/python/examples/ppo.py --steps 100000 --seeds 5

Copied is our own play, coach, brains and cases: it moves a second robot while the first is parked, and what it orders is read
from how that robot and the ball move in the next period. Only episodes in which it scored are copied. Every policy is
measured without its noise on the same episodes, which no training has seen; intervals are Student's over seeds, 95 %.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.vec_env import DummyVecEnv
from torch import nn

import onetwo
from onetwo.env import TaskEnv

Measured = tuple[float, float]
"""Goals in 100 episodes, mean return."""
TASK = "shoot-at-keeper"
PERIOD_MS = 30
GAMMA = 0.99
SPEED, TURN, SHOT = 3.5, 15.0, 8.0
"""What an action of 1 stands for: m/s, rad/s, m/s (division B)."""
KICKED = 0.5
"""A ball that is faster by this after a period, m/s, was kicked."""
STUDENT = {2: 12.71, 3: 4.30, 4: 3.18, 5: 2.78, 6: 2.57, 8: 2.36, 10: 2.26}
"""Student's quantile for 95 % by the number of seeds."""
HELD_OUT = 10_000_000
"""First seed of the episodes that policies are measured on."""


def order_of(before: dict[str, Any], after: dict[str, Any]) -> Any:
    """The order that would have moved a robot and the ball like that in one period."""
    me, ball = after["own"][1], after["ball"]
    cos, sin = np.cos(me["heading"]), np.sin(me["heading"])
    vx, vy = me["velocity"]
    faster = np.hypot(*ball["velocity"][:2]) - np.hypot(*before["ball"]["velocity"][:2])
    kick = np.hypot(*ball["velocity"][:2]) / SHOT if faster > KICKED else -0.2
    order = [(vx * cos + vy * sin) / SPEED, (vy * cos - vx * sin) / SPEED, me["turning"] / TURN, kick, me["ball_contact"]]
    return np.clip(order, -1, 1)


def case_play(episodes: int) -> tuple[list[torch.Tensor], Measured]:
    """Observations, orders and discounted returns of the episodes in which our own play scored; how often it did."""
    simulator = onetwo.Simulator(2, 1, task=TASK, agents=1, teammates_by="coach", period_ms=PERIOD_MS)
    observation = np.empty(simulator.observation_size, np.float32)
    rows, goals, total = [], 0, 0.0
    for seed in range(episodes):
        simulator.reset(seed)
        # The robot behind the ball is the coach's, the caller's waits in its own corner.
        x, y = simulator.state()["own"][0]["position"]
        simulator.place_robot(0, -4.3, -2.8)
        simulator.place_robot(1, x, y)
        seen: list[Any] = []
        orders: list[Any] = []
        rewards: list[float] = []
        end = None
        while end is None:
            simulator.observe(observation, 1)
            before = simulator.state()
            reward, end = simulator.step([0.0] * 5)
            seen.append(np.delete(observation, range(13, 21)))
            orders.append(order_of(before, simulator.state()))
            rewards.append(reward)
        total += sum(rewards)
        goals += end == "goal"
        if end == "goal":
            returns = [0.0]
            for reward in reversed(rewards):
                returns.append(reward + GAMMA * returns[-1])
            rows.append((seen, orders, returns[:0:-1]))
    parts = (np.concatenate([np.asarray(row[n], np.float32) for row in rows]) for n in range(3))
    return [torch.from_numpy(part) for part in parts], (100 * goals / episodes, total / episodes)


def copy_play(
    model: PPO, seen: torch.Tensor, orders: torch.Tensor, returns: torch.Tensor, epochs: int = 40
) -> None:
    """Fits the policy's mean to the orders, and its value to the returns."""
    optimizer = torch.optim.Adam(model.policy.parameters(), 1e-3)
    for _ in range(epochs):
        for batch in torch.randperm(len(seen)).split(256):
            mean = model.policy.get_distribution(seen[batch]).mode()
            value = model.policy.predict_values(seen[batch])[:, 0]
            loss = nn.functional.mse_loss(mean, orders[batch]) + 0.01 * nn.functional.mse_loss(value, returns[batch])
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()


def measured(act: Callable[[Any], Any], episodes: int) -> Measured:
    """Goals of a policy in 100 held-out episodes, and their mean return."""
    env, goals, total = TaskEnv(task=TASK, period_ms=PERIOD_MS), 0, 0.0
    for seed in range(episodes):
        env.simulator.reset(HELD_OUT + seed)
        observation, end = np.empty(env.simulator.observation_size, np.float32), None
        env.simulator.observe(observation)
        while end is None:
            reward, end = env.simulator.step(np.asarray(act(observation), np.float32), None, observation)
            total += reward
        goals += end == "goal"
    return 100 * goals / episodes, total / episodes


def learner(seed: int) -> PPO:
    """An untrained PPO on sixteen environments."""
    envs = DummyVecEnv([lambda: TaskEnv(task=TASK, period_ms=PERIOD_MS)] * 16)
    settings: dict[str, Any] = {"n_steps": 256, "batch_size": 512, "n_epochs": 5, "gamma": GAMMA, "device": "cpu"}
    return PPO("MlpPolicy", envs, seed=seed, policy_kwargs={"log_std_init": -1.5, "net_arch": [64, 64]}, **settings)


def interval(values: list[float]) -> str:
    """Mean and half of its 95 % interval."""
    if len(values) == 1:
        return f"{values[0]:.1f}"
    half = STUDENT[len(values)] * statistics.stdev(values) / len(values) ** 0.5
    return f"{statistics.mean(values):.1f} ± {half:.1f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--steps", type=int, default=100_000, help="training steps of each run")
    parser.add_argument("--seeds", type=int, default=5, choices=STUDENT)
    parser.add_argument("--episodes", type=int, default=100, help="held-out episodes of each policy")
    parser.add_argument("--watched", type=int, default=1500, help="episodes of our own play, to copy those that it scores in")
    chosen = parser.parse_args()
    torch.set_num_threads(1)
    started = time.monotonic()
    found = {"forward, kicker armed": [measured(lambda _: [0.3, 0, 0, 0.9, 0], chosen.episodes)]}
    demonstrations, share = case_play(chosen.watched)
    found["our own play, in the episodes watched"] = [share]
    for seed in range(chosen.seeds):
        for copies in (False, True):
            model = learner(seed)

            def act(observation: Any, model: PPO = model) -> Any:
                return model.predict(observation, deterministic=True)[0]

            if copies:
                copy_play(model, *demonstrations)
                found.setdefault("copied case play", []).append(measured(act, chosen.episodes))
            model.learn(chosen.steps)
            name = f"PPO {'after copying' if copies else 'from scratch'}, {chosen.steps:,} steps"
            found.setdefault(name, []).append(measured(act, chosen.episodes))
            print(f"seed {seed}, {name}: {found[name][-1]}", flush=True)
    print("| policy | goals in 100 episodes | by seed | return |\n|---|---|---|---|")
    for name, values in found.items():
        goals, returns = ([value[n] for value in values] for n in range(2))
        print(f"| {name} | {interval(goals)} | {', '.join(f'{one:.0f}' for one in goals)} | {interval(returns)} |")
    print(f"{len(demonstrations[0]):,} copied steps, {(time.monotonic() - started) / 3600:.2f} h")


if __name__ == "__main__":
    main()
