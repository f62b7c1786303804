"""Pictures of environments: a line of text, an array of pixels, or a window."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium.error import DependencyNotInstalled
from numpy.typing import NDArray

from ._native import Simulator

RENDER_MODES = ["ansi", "rgb_array", "human"]
WIDTH = 960
"""Width of a picture unless another is given, pixels."""


def described(simulator: Simulator) -> str:
    """The state as a line of text: time, ball and robots, m."""
    state = simulator.state()
    parts = [f"{state['time_s']:.2f} s", "ball ({:+.2f}, {:+.2f})".format(*state["ball"]["position"])]
    for side in ("own", "opponents"):
        parts += [f"{side} {n} ({r['position'][0]:+.2f}, {r['position'][1]:+.2f})" for n, r in enumerate(state[side])]
    return "; ".join(parts)


def array(picture: tuple[bytes, int, int]) -> NDArray[np.uint8]:
    """Pixels of the simulator as an array: height, width, and red, green and blue as uint8."""
    rgb, width, height = picture
    return np.frombuffer(rgb, np.uint8).reshape(height, width, 3).copy()


def frames_per_second(simulator: Simulator) -> int:
    """One frame a step in real time."""
    return round(1000 / simulator.period_ms)


class Renderer:
    """Renders a simulator in one mode; a copy has a window of its own."""

    def __init__(self, mode: str | None, width: int, simulator: Simulator) -> None:
        if mode not in (None, *RENDER_MODES):
            raise ValueError(f"render_mode {mode!r}: take {', '.join(map(repr, RENDER_MODES))}, or none")
        if mode in ("rgb_array", "human"):
            simulator.pixels(width)
        self.mode, self.width = mode, width
        self._screen: Any = None
        self._clock: Any = None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_screen": None, "_clock": None}

    def render(self, simulator: Simulator) -> str | NDArray[np.uint8] | None:
        """The text, the array, or nothing where the window shows it."""
        if self.mode is None:
            raise ValueError(f"render: make the environment with render_mode={' or '.join(map(repr, RENDER_MODES))}")
        if self.mode == "ansi":
            return described(simulator)
        if self.mode == "rgb_array":
            return array(simulator.pixels(self.width))
        self.show(simulator)
        return None

    def show(self, simulator: Simulator) -> None:
        """In mode "human": draws into the window, no faster than real time."""
        if self.mode != "human":
            return
        try:
            import pygame
        except ImportError as error:
            raise DependencyNotInstalled("render_mode 'human' needs pygame: pip install 'onetwo[human]'") from error
        rgb, *size = simulator.pixels(self.width)
        if self._screen is None:
            pygame.display.init()
            pygame.display.set_caption(f"onetwo {simulator.task}")
            self._screen, self._clock = pygame.display.set_mode(size), pygame.time.Clock()
        pygame.event.pump()
        self._screen.blit(pygame.image.frombuffer(rgb, size, "RGB"), (0, 0))
        pygame.display.flip()
        self._clock.tick(frames_per_second(simulator))

    def close(self) -> None:
        """Closes the window, if there is one."""
        if self._screen is not None:
            import pygame

            pygame.display.quit()
            self._screen = self._clock = None
