"""Steps per second of the simulator and of rSim (`pip install rc-robosim`), side by side in one run.

`python host/python/examples/against_rsim.py [ROBOTS] [--json]`: ROBOTS a side (3) on a field of 9 x 6 m, 25 ms of
simulated time a step, every robot ordered the same random velocities, kicks and dribblers. A step includes its
observation. The sides take turns in short rounds, so that whatever else the machine does hits both; CPU time is counted.
A step of `onetwo` is 25 steps of physics of 1 ms; rSim splits its step as it does. In the environment opponents stand.
"""

import json
import random
import statistics
import sys
import time
from array import array

import numpy as np
import robosim

import onetwo
import onetwo.env

Actions = list[list[float]]
ROUNDS = 20
STEPS = 400
PERIOD_MS = 25
SPEED = 3.5  # m/s at an action of 1, and rad/s of rSim's robots
SMALL_FIELD = 1  # rSim's number for 9 x 6 m
HALF_LENGTH, HALF_WIDTH = 4.5, 3.0  # m


def drawn(robots: int, count: int) -> Actions:
    """Actions of one team: forward, left, turn, kick, dribbler for each robot."""
    draw = random.Random(1)
    return [[draw.uniform(-1, 1) for _ in range(5 * robots)] for _ in range(count)]


def ours(robots: int, actions: Actions) -> None:
    """`Simulator.step` with orders for both teams, and the observation."""
    simulator = onetwo.Simulator(robots, robots, period_ms=PERIOD_MS, time_limit_s=1e9)
    prepared = [array("f", action) for action in actions]
    into = array("f", bytes(4 * simulator.observation_size))
    seed = 0
    for action in prepared:
        _, end = simulator.step(action, action, into)
        if end is not None:
            seed += 1
            simulator.reset(seed)


def environment(robots: int, actions: Actions) -> None:
    """`ScoreEnv.step`: opponents stand."""
    env = onetwo.env.ScoreEnv(robots, robots, period_ms=PERIOD_MS, time_limit_s=1e9)
    env.reset(seed=1)
    prepared = [np.array(action, np.float32) for action in actions]
    for action in prepared:
        _, _, terminated, truncated, _ = env.step(action)
        if terminated or truncated:
            env.reset()


def placed(robots: int, side: int) -> Actions:
    return [[side * (0.5 + 0.5 * robot), 0.6 * robot - 1.5, 0.0 if side < 0 else 180.0] for robot in range(robots)]


def rsim(robots: int, actions: Actions) -> None:
    """rSim's `step` with orders for both teams, and `get_state`."""
    start = ([0.0, 0.0, 0.0, 0.0], placed(robots, -1), placed(robots, 1))
    simulator = robosim.SSL(SMALL_FIELD, robots, robots, PERIOD_MS, *start)
    prepared = []
    for action in actions:
        team = []
        for robot in range(robots):
            forward, left, turn, kick, dribbler = action[5 * robot : 5 * robot + 5]
            # No wheel speeds, vx, vy, vw, kick x and z, dribbler.
            team.append([0.0, forward * SPEED, left * SPEED, turn * SPEED, max(kick, 0.0) * 8.0, 0.0, float(dribbler > 0)])
        prepared.append(team + team)
    for orders in prepared:
        simulator.step(orders)
        x, y, *_ = simulator.get_state()
        if abs(x) > HALF_LENGTH or abs(y) > HALF_WIDTH:
            simulator.reset(*start)


def main() -> None:
    numbers = [argument for argument in sys.argv[1:] if argument.isdigit()]
    robots = int(numbers[0]) if numbers else 3
    actions = drawn(robots, STEPS)
    sides = {"simulator": ours, "environment": environment, "rsim": rsim}
    speeds: dict[str, list[float]] = {name: [] for name in sides}
    for side in sides.values():
        side(robots, actions)
    for _ in range(ROUNDS):
        for name, side in sides.items():
            start = time.process_time()
            side(robots, actions)
            speeds[name].append(STEPS / (time.process_time() - start))
    rates = {name: statistics.median(found) for name, found in speeds.items()}
    ratios = {name: round(rates[name] / rates["rsim"], 1) for name in ("simulator", "environment")}
    if "--json" in sys.argv:
        print(json.dumps({"robots": robots, "ratios": ratios}))
        return
    print(f"{robots} against {robots}, {PERIOD_MS} ms a step, medians of {ROUNDS} rounds of {STEPS} steps")
    for name, rate in rates.items():
        print(f"{name:12} {rate:9.0f} steps/s, {rate / rates['rsim']:5.1f} x rSim")


if __name__ == "__main__":
    main()
