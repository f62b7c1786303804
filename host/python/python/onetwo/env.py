"""Gymnasium environments over the Small Size simulator: a task each, `onetwo/Score-v0` and others, single and vector.

Needs `gymnasium` and `numpy` (`pip install "onetwo[gym]"`, or from a clone `pip install "./host/python[gym]"`).
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from ._native import Simulator, VectorSimulator
from ._render import RENDER_MODES, WIDTH, Renderer, array, frames_per_second
from ._saved import pack, unpack

TASKS = {
    "onetwo/Score-v0": "score",
    "onetwo/ShootAtKeeper-v0": "shoot-at-keeper",
    "onetwo/PassAndReceive-v0": "pass-and-receive",
    "onetwo/ContestedBall-v0": "contested-ball",
    "onetwo/KeepAway-v0": "keep-away",
    "onetwo/ThreeASide-v0": "3v3",
    "onetwo/SixASide-v0": "6v6",
    "onetwo/Scenario1-v0": "scenario-1",
    "onetwo/Scenario2-v0": "scenario-2",
    "onetwo/Scenario3-v0": "scenario-3",
    "onetwo/Scenario4-v0": "scenario-4",
    "onetwo/ScenarioRandom-v0": "scenario-random",
}
SCORE = "onetwo/Score-v0"
END_NAMES = np.array(VectorSimulator.ENDS, object)

Floats = NDArray[np.float32]
Policy = Callable[[Floats], Floats]
"""Orders of a side's robots that the agent does not move, five numbers each, by that side's observation: it attacks +x
there, and the first of these robots comes first."""


def box(size: int) -> spaces.Box[np.float32]:
    """`size` values of float32 within ±1."""
    return spaces.Box(-1.0, 1.0, (size,), np.float32)


def check_orders(simulator: Simulator, by: str) -> None:
    """ValueError where the simulator's opponents take no orders."""
    if simulator.task.startswith("scenario"):
        raise ValueError(f"opponents_by: opponents of the task {simulator.task!r} take no orders of {by}")


class TaskEnv(gymnasium.Env[Floats, Floats]):
    """A task of `onetwo.Simulator`, which has its actions, observations, rewards and ends.

    The agent moves the first `agents` own robots, by default all; `teammates_by` and `opponents_by` move the others: a
    name as the simulator has it, or a `Policy`. It terminates as the task ends, and is truncated after `time_limit_s`.
    `info["end"]` is how it ended, `info["time_s"]` when, `info["score"]` the goals under the referee.
    """

    metadata = {"render_modes": RENDER_MODES, "render_fps": 40}
    action_space: spaces.Box[np.float32]
    observation_space: spaces.Box[np.float32]

    def __init__(
        self,
        own: int | None = None,
        opponents: int | None = None,
        *,
        task: str = "score",
        agents: int | None = None,
        teammates_by: str | Policy = "none",
        opponents_by: str | Policy | None = None,
        render_mode: str | None = None,
        width: int = WIDTH,
        **settings: Any,
    ) -> None:
        self._teammates = teammates_by if callable(teammates_by) else None
        self._opponents = opponents_by if callable(opponents_by) else None
        self.simulator = Simulator(
            own,
            opponents,
            task=task,
            agents=agents,
            teammates_by=teammates_by if isinstance(teammates_by, str) else "none",
            opponents_by="none" if callable(opponents_by) else opponents_by,
            **settings,
        )
        if self._opponents:
            check_orders(self.simulator, "a policy")
        self._agents = self.simulator.robots[1]
        if self._teammates:
            # The policy's orders go the way of the agent's.
            self.simulator = Simulator(
                own, opponents, task=task, opponents_by=self.simulator.opponents_by, **settings
            )
        self.render_mode = render_mode
        self._renderer = Renderer(render_mode, width, self.simulator)
        self.metadata = {**self.metadata, "render_fps": frames_per_second(self.simulator)}
        self.action_space = box(5 * self._agents)
        self.observation_space = box(self.simulator.observation_size)

    def _observation(self, index: int = 0, opponent: bool = False) -> Floats:
        observation = np.empty(self.simulator.observation_size, np.float32)
        self.simulator.observe(observation, index, opponent)
        return observation

    def _info(self, end: str | None) -> dict[str, Any]:
        return {"end": end, "time_s": self.simulator.time_s, "score": self.simulator.score}

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Starts an episode; with a seed it and all that follow are the same every time."""
        super().reset(seed=seed)
        self.simulator.reset(int(self.np_random.integers(2**63)))
        self._renderer.show(self.simulator)
        return self._observation(), self._info(None)

    def step(self, action: Floats) -> tuple[Floats, float, bool, bool, dict[str, Any]]:
        """Plays one control period."""
        if self._teammates:
            action = np.concatenate([action, self._teammates(self._observation(self._agents))])
        against = self._opponents(self._observation(0, True)) if self._opponents else None
        observation = np.empty(self.simulator.observation_size, np.float32)
        reward, end = self.simulator.step(action, against, observation)
        self._renderer.show(self.simulator)
        truncated = end == "time"
        return observation, reward, end is not None and not truncated, truncated, self._info(end)

    def render(self) -> str | NDArray[np.uint8] | None:
        """By `render_mode`: "ansi", the state as a line of text; "rgb_array", the drawn field `width` pixels wide;
        "human", the same in a window, which `step` and `reset` update by themselves."""
        return self._renderer.render(self.simulator)

    def close(self) -> None:
        """Closes the window of render_mode "human"."""
        self._renderer.close()

    def save(self) -> bytes:
        """The state of episode and random generator; that of a policy is not in it."""
        return pack([self.np_random], self.simulator.save())

    def restore(self, state: bytes) -> None:
        """Goes on from a saved state of an environment with the same settings; ValueError for other bytes."""
        [generator], simulator = unpack(state, 1)
        self.simulator.restore(simulator)
        self.np_random = generator


class ScoreEnv(TaskEnv):
    """`TaskEnv` with the task score: get the ball and score."""


class TaskVectorEnv(VectorEnv[Floats, Floats, NDArray[Any]]):
    """`num_envs` episodes of a task, stepped by one call on `threads` threads, by default as many as processors.

    Episode i is the one that the i-th environment of a `SyncVectorEnv` of `TaskEnv`s would play, bit for bit. A finished
    episode starts again at the next step, whose action it ignores (`AutoresetMode.NEXT_STEP`). Only where episodes have
    ended, `info` has "end" and "time_s" with their masks. Takes the settings of `onetwo.Simulator`, no policies.
    """

    metadata = {"render_modes": ["rgb_array"], "autoreset_mode": AutoresetMode.NEXT_STEP}
    single_action_space: spaces.Box[np.float32]
    single_observation_space: spaces.Box[np.float32]

    def __init__(
        self,
        num_envs: int = 1,
        *,
        threads: int | None = None,
        render_mode: str | None = None,
        width: int = WIDTH,
        **settings: Any,
    ) -> None:
        if callable(settings.get("opponents_by")) or callable(settings.get("teammates_by")):
            raise ValueError("opponents_by, teammates_by: a vector environment takes names, no policies")
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode {render_mode!r}: a vector environment takes 'rgb_array', or none")
        template = Simulator(**settings)
        template.pixels(width)
        self.render_mode, self._width = render_mode, width
        self.metadata = {**self.metadata, "render_fps": frames_per_second(template)}
        self.num_envs = num_envs
        self.simulators = VectorSimulator(template, num_envs, os.cpu_count() or 1 if threads is None else threads)
        self._size = template.observation_size
        self.single_action_space = box(template.action_size)
        self.single_observation_space = box(template.observation_size)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self._generators = [seeding.np_random()[0] for _ in range(num_envs)]
        self._done = np.ones(num_envs, np.bool_)
        self._none = np.zeros((num_envs, template.action_size), np.float32)

    def _step(
        self, actions: Floats, restarts: NDArray[np.bool_]
    ) -> tuple[Floats, Floats, NDArray[np.uint8]]:
        observations = np.empty((self.num_envs, self._size), np.float32)
        rewards = np.empty(self.num_envs, np.float32)
        ends = np.empty(self.num_envs, np.uint8)
        seeds = [(int(i), int(self._generators[i].integers(2**63))) for i in np.flatnonzero(restarts)]
        self.simulators.step(actions, seeds, observations, rewards, ends)
        self._done = ends != 0
        return observations, rewards, ends

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Floats, dict[str, Any]]:
        """Starts all episodes; `seed` is one number, from which episodes count up, or a list."""
        seeds = [seed + i for i in range(self.num_envs)] if isinstance(seed, int) else seed or [None] * self.num_envs
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed: {len(seeds)} seeds for {self.num_envs} environments")
        for i, one in enumerate(seeds):
            if one is not None:
                self._generators[i] = seeding.np_random(one)[0]
        observations, _, _ = self._step(self._none, np.ones(self.num_envs, np.bool_))
        return observations, {}

    def step(
        self, actions: Floats
    ) -> tuple[Floats, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Plays one control period of each episode, or starts those again that had ended."""
        actions = np.ascontiguousarray(actions, np.float32)
        observations, rewards, ends = self._step(actions, self._done)
        truncations = ends == VectorSimulator.ENDS.index("time")
        info: dict[str, Any] = {}
        if self._done.any():
            names = END_NAMES[ends]
            info = {"end": names, "_end": self._done, "time_s": np.array(self.simulators.times_s()), "_time_s": self._done}
        return observations, rewards.astype(np.float64), self._done & ~truncations, truncations, info

    def render(self) -> tuple[NDArray[np.uint8], ...]:
        """With render_mode "rgb_array" the drawn field of each episode."""
        if self.render_mode is None:
            raise ValueError("render: make the environment with render_mode='rgb_array'")
        return tuple(array(self.simulators.pixels(i, self._width)) for i in range(self.num_envs))

    def save(self) -> bytes:
        """The state of all episodes and random generators."""
        return pack(self._generators, self.simulators.save())

    def restore(self, state: bytes) -> None:
        """Goes on from a saved state of an environment with the same settings; ValueError for other bytes."""
        generators, simulators = unpack(state, self.num_envs)
        self.simulators.restore(simulators)
        self._generators = generators
        self._done = np.array(self.simulators.ended())


for _name, _task in TASKS.items():
    if _name not in gymnasium.registry:
        _entry = "onetwo.env:ScoreEnv" if _task == "score" else "onetwo.env:TaskEnv"
        gymnasium.register(
            _name, entry_point=_entry, vector_entry_point="onetwo.env:TaskVectorEnv", kwargs={"task": _task}
        )
