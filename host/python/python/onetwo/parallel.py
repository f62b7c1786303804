"""PettingZoo's parallel API over the Small Size simulator: an agent for each robot.

Needs `pettingzoo`, `gymnasium` and `numpy` (`pip install "onetwo[pettingzoo]"`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from numpy.typing import NDArray
from pettingzoo import ParallelEnv  # type: ignore[import-untyped,unused-ignore]

from ._native import Simulator
from ._render import RENDER_MODES, WIDTH, Renderer, frames_per_second
from ._saved import pack, unpack
from .env import box, check_orders


class TaskParallelEnv(ParallelEnv):  # type: ignore[misc,unused-ignore]
    """A task of `onetwo.Simulator` with an agent for each own robot that the caller moves, `own_0` and on; with
    `opponents_by="agents"` also for each opponent, `opponent_0` and on.

    An agent's action is five numbers; its observation the simulator's from its side, its own robot first. Own agents
    share the task's reward, opponents get minus that. The episode ends for all at once.
    """

    metadata = {"name": "onetwo_v0", "render_modes": RENDER_MODES, "is_parallelizable": True}

    def __init__(
        self,
        own: int | None = None,
        opponents: int | None = None,
        *,
        opponents_by: str | None = None,
        render_mode: str | None = None,
        width: int = WIDTH,
        **settings: Any,
    ) -> None:
        agents = opponents_by == "agents"
        self.simulator = Simulator(own, opponents, opponents_by="none" if agents else opponents_by, **settings)
        if agents:
            check_orders(self.simulator, "agents")
        self.render_mode = render_mode
        self._renderer = Renderer(render_mode, width, self.simulator)
        self.metadata = {**self.metadata, "render_fps": frames_per_second(self.simulator)}
        _, own, opponents = self.simulator.robots
        self._robots = {f"own_{n}": (n, False) for n in range(own)}
        self._robots |= {f"opponent_{n}": (n, True) for n in range(opponents if agents else 0)}
        self._own, self._against = own, opponents if agents else 0
        self.possible_agents = list(self._robots)
        self.agents: list[str] = []
        self.observation_spaces = {name: box(self.simulator.observation_size) for name in self._robots}
        self.action_spaces = {name: box(5) for name in self._robots}
        self._random = seeding.np_random()[0]

    def observation_space(self, agent: str) -> spaces.Box:
        """Float32 within ±1."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Box:
        """Five values of float32 within ±1."""
        return self.action_spaces[agent]

    def _observations(self) -> dict[str, NDArray[np.float32]]:
        found = {name: np.empty(self.simulator.observation_size, np.float32) for name in self.agents}
        for name, observation in found.items():
            self.simulator.observe(observation, *self._robots[name])
        return found

    def reset(
        self, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, NDArray[np.float32]], dict[str, dict[str, Any]]]:
        """Starts an episode; with a seed it and all that follow are the same every time."""
        if seed is not None:
            self._random = seeding.np_random(seed)[0]
        self.simulator.reset(int(self._random.integers(2**63)))
        self.agents = list(self.possible_agents)
        self._renderer.show(self.simulator)
        return self._observations(), {name: {} for name in self.agents}

    def step(self, actions: dict[str, NDArray[np.float32]]) -> tuple[
        dict[str, NDArray[np.float32]], dict[str, float], dict[str, bool], dict[str, bool], dict[str, dict[str, Any]]
    ]:
        """Plays one control period; an agent without an action stands."""
        orders = {opponent: np.zeros((count, 5), np.float32) for opponent, count in ((False, self._own), (True, self._against))}
        for name, action in actions.items():
            if name not in self._robots:
                raise ValueError(f"actions: no agent {name!r}; there are {', '.join(self._robots)}")
            index, opponent = self._robots[name]
            orders[opponent][index] = action
        against = orders[True].ravel() if self._against else None
        reward, end = self.simulator.step(orders[False].ravel(), against)
        self._renderer.show(self.simulator)
        truncated = end == "time"
        terminated = end is not None and not truncated
        info = {"end": end, "time_s": self.simulator.time_s, "score": self.simulator.score}
        observations, names = self._observations(), self.agents
        if end is not None:
            self.agents = []
        return (
            observations,
            {name: -reward if self._robots[name][1] else reward for name in names},
            dict.fromkeys(names, terminated),
            dict.fromkeys(names, truncated),
            {name: dict(info) for name in names},
        )

    def render(self) -> str | NDArray[np.uint8] | None:
        """As `TaskEnv.render`."""
        return self._renderer.render(self.simulator)

    def close(self) -> None:
        """Closes the window of render_mode "human"."""
        self._renderer.close()

    def save(self) -> bytes:
        """The state of episode and random generator."""
        return pack([self._random], self.simulator.save())

    def restore(self, state: bytes) -> None:
        """Goes on from a saved state of an environment with the same settings; ValueError for other bytes."""
        [generator], simulator = unpack(state, 1)
        self.simulator.restore(simulator)
        self._random = generator
        self.agents = [] if self.simulator.end else list(self.possible_agents)
