"""A million drawn actions of a task: observations within the space, rewards finite.

`python host/python/examples/random_steps.py TASK [STEPS] [SETTING=VALUE ...]`: on one thread, so that shards with other seeds
run side by side (`seed=2`); prints the steps of processor time a second, the ends, and the least and greatest reward.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from typing import Any

import numpy as np

from onetwo.env import TaskVectorEnv

COPIES = 50
STEPS = 1_000_000


def main() -> None:
    task, *others = sys.argv[1:]
    settings: dict[str, Any] = dict(one.split("=", 1) for one in others if "=" in one)
    steps = next((int(one) for one in others if one.isdigit()), STEPS)
    seed = int(settings.pop("seed", 1))
    envs = TaskVectorEnv(COPIES, threads=1, task=task, **settings)
    draw = np.random.default_rng(seed)
    envs.reset(seed=seed)
    ends: Counter[str] = Counter()
    least = most = 0.0
    began = time.process_time()
    for _ in range(-(-steps // COPIES)):
        actions = draw.uniform(-1, 1, envs.action_space.shape).astype(np.float32)
        observations, rewards, _, _, info = envs.step(actions)
        if not (np.isfinite(observations).all() and np.abs(observations).max() <= 1 and np.isfinite(rewards).all()):
            sys.exit(f"{task}: an observation beyond its space, or a reward that is not finite: {observations} {rewards}")
        least, most = min(least, rewards.min()), max(most, rewards.max())
        ends.update(info["end"][info["_end"]] if info else ())
    rate = steps / (time.process_time() - began)
    print(f"{task} {settings}: {steps} steps, {rate:.0f} a second; {dict(ends)}; rewards {least:.2f} to {most:.2f}")


if __name__ == "__main__":
    main()
