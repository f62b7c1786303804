"""A Gymnasium environment over the Small Size simulator, `onetwo/Score-v0`.

Needs `gymnasium` and `numpy` (`pip install "onetwo[gym]"`, or from a clone `pip install "./host/python[gym]"`).
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from ._native import Simulator

SCORE = "onetwo/Score-v0"


class ScoreEnv(gymnasium.Env):
    """Get the ball and score: own robots against opponents that stand still.

    An episode starts with the ball in the middle of the field, the own robots in their half and the opponents in
    theirs, at random. It terminates with a goal for either side or a ball off the field, and is truncated after
    `time_limit_s`. Actions, observations and the reward are those of `onetwo.Simulator`: boxes of float32 within ±1, of
    5 numbers for each own robot, and of 5 for the ball and 8 for each robot. `info["end"]` says how it ended, and
    `info["time_s"]` when.
    """

    metadata = {"render_modes": ["ansi"], "render_fps": 40}

    def __init__(
        self,
        own: int = 1,
        opponents: int = 0,
        *,
        league: str = "division-b",
        period_ms: int = 25,
        time_limit_s: float = 30.0,
        render_mode: str | None = None,
    ) -> None:
        if render_mode not in (None, "ansi"):
            raise ValueError(f"render_mode {render_mode!r}: take 'ansi', a line of text, or none")
        self.render_mode = render_mode
        self.simulator = Simulator(
            own, opponents, league=league, period_ms=period_ms, time_limit_s=time_limit_s
        )
        self.action_space = spaces.Box(-1.0, 1.0, (self.simulator.action_size,), np.float32)
        self.observation_space = spaces.Box(-1.0, 1.0, (self.simulator.observation_size,), np.float32)
        self._size = self.simulator.observation_size

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Starts an episode; with a seed it and all that follow are the same every time."""
        super().reset(seed=seed)
        self.simulator.reset(int(self.np_random.integers(2**63)))
        observation = np.empty(self._size, np.float32)
        self.simulator.observe(observation)
        return observation, {"end": None, "time_s": 0.0}

    def render(self) -> str:
        """With `render_mode="ansi"` the state as a line of text: time, ball and robots, m."""
        if self.render_mode is None:
            raise ValueError("render: make the environment with render_mode='ansi', the only one that it has")
        state = self.simulator.state()
        parts = [f"{state['time_s']:.2f} s", "ball ({:+.2f}, {:+.2f})".format(*state["ball"]["position"])]
        for side in ("own", "opponents"):
            parts += [f"{side} {n} ({r['position'][0]:+.2f}, {r['position'][1]:+.2f})" for n, r in enumerate(state[side])]
        return "; ".join(parts)

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Plays one control period."""
        observation = np.empty(self._size, np.float32)
        simulator = self.simulator
        reward, end = simulator.step(action, None, observation)
        truncated = end == "time"
        info = {"end": end, "time_s": simulator.time_s}
        return observation, reward, end is not None and not truncated, truncated, info


if SCORE not in gymnasium.registry:
    gymnasium.register(SCORE, entry_point="onetwo.env:ScoreEnv")
