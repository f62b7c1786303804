"""Types of the Rust side. Lengths of cases are mm, those of the simulator m; field frame: origin at the centre, +x
along the length."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, final

from typing_extensions import Buffer

VERSION: str

Problem = str | Mapping[str, Any]
"""A situation, as a line of `onetwo cases retrieve` or as the same object: {"ball": [x, y], "defending": "yellow" or
"cyan", "teammates": {robot: [x, y]}, "opponents": [[x, y]]}; whole mm, robots 0 to 15."""

Settings = Mapping[str, Any]
"""Named settings of retrieval (docs/case-format.md §3.2), such as {"thr_c": 1200}."""

@final
class Library:
    """A case library, opened once and asked many times; a directory's stays in memory until the process ends."""

    def __new__(cls, league: str = "four-legged", *, directory: str | PathLike[str] | None = None) -> Library:
        """Opens a built-in league's library, or one league's directory of case files.

        Raises ValueError for an unknown league, a missing directory or faulty case files."""
    @property
    def league(self) -> str:
        """The league's name."""
    @property
    def names(self) -> list[str]:
        """`region/name` of every authored case, in order."""
    def __len__(self) -> int:
        """The number of stored cases: four for each authored one."""
    def retrieve(self, problem: Problem, *, settings: Settings | None = None) -> dict[str, Any]:
        """The case that fits a problem (docs/case-format.md §5.1); its "case" is None where none fits.

        Raises ValueError for a malformed problem or an unknown setting."""
    def explain(self, problem: Problem, *, settings: Settings | None = None) -> dict[str, Any]:
        """Every case's verdict on a problem (docs/case-format.md §5.2).

        Raises ValueError for a malformed problem or an unknown setting."""

def retrieve(problem: Problem, *, library: Library | None = None, settings: Settings | None = None) -> dict[str, Any]:
    """`Library.retrieve` of a library, by default the built-in four-legged league's."""

def explain(problem: Problem, *, library: Library | None = None, settings: Settings | None = None) -> dict[str, Any]:
    """`Library.explain` of a library, by default the built-in four-legged league's."""

def trial(
    *,
    scenario: str = "3",
    opponents: str = "dg",
    approach: str = "cbr",
    seed: int = 1,
    profile: str = "simulated",
    robots: int = 2,
    library: Library | None = None,
    settings: Settings | None = None,
    positioning: str = "dependent",
    retrievers: int | None = None,
    loss: float = 0.0,
    symmetry: bool = True,
    case_opponents: bool = True,
    opponents_play_on: bool = False,
) -> dict[str, Any]:
    """Plays one trial of Ros et al. 2009 and returns its report (docs/case-format.md §5.2).

    The arguments are the flags of `onetwo trial`; `symmetry=False` is --no-symmetry, `case_opponents=False` is
    --no-opponents. Other threads run meanwhile. Raises ValueError for a value that a flag would refuse."""

@final
class Simulator:
    """Episodes of the Small Size simulator, one control period a step.

    Own robots attack the goal at +x. An action is five numbers a robot, clamped to [-1, 1]: forward and left (times the
    robot's greatest speed, 3.5 m/s), turn (times 15 rad/s, counter-clockwise), kick (above 0: kick as soon as the ball
    is in front, times 8 m/s), dribbler (above 0: share of its strength). The values are division B's.

    An observation is numbers within ±1, cut off there: the ball's x, y, height, velocity along x and y; for each own
    robot and then each opponent x, y, sine and cosine of the heading, velocity along x and y, turning rate, ball contact
    (0 or 1). Positions are shares of the way from the centre to the boards, the height is m, velocities of the ball are
    shares of 8 m/s, of robots of 3.5 m/s, turning rates of 15 rad/s."""

    def __new__(
        cls,
        own: int = 1,
        opponents: int = 0,
        *,
        league: str = "division-b",
        period_ms: int = 25,
        time_limit_s: float = 30.0,
        seed: int = 0,
    ) -> Simulator:
        """A simulator, with its first episode begun.

        own: robots of the own team, 1 to 11. opponents: 0 to 11. league: "division-b", "division-a" or "ssl-2013".
        period_ms: simulated time of a step, 1 to 100 ms; the physics takes a step each ms. Raises ValueError else."""
    def reset(self, seed: int) -> None:
        """Begins another episode, from random start positions that follow from the seed alone."""
    def step(
        self,
        actions: Buffer | Sequence[float],
        opponent_actions: Buffer | Sequence[float] | None = None,
        into: Buffer | None = None,
    ) -> tuple[float, str | None]:
        """Plays one period; returns the reward and how the episode ended: "goal", "own_goal", "out" (the ball left the
        field), "time", or None while it goes on. A finished episode stays as it is.

        actions: `action_size` numbers, a buffer of float32 or a flat sequence. opponent_actions: the same for the
        opponents, who stand still without. into: see `observe`. Raises ValueError for another number of values or one
        that is not finite.

        The reward is the growth of -(distance ball to the opponents' goal + 0.5 x distance ball to the nearest own
        robot), m, plus 10 for a goal and minus 10 for an own goal."""
    def observe(self, into: Buffer) -> None:
        """Writes the observation into a writable buffer of `observation_size` float32."""
    def state(self) -> dict[str, Any]:
        """The true state: time_s; ball with position (x, y, height, m) and velocity (m/s); own and opponents, lists of
        robots with position (m), heading (rad), velocity (m/s), turning (rad/s) and ball_contact."""
    def place_ball(self, x: float, y: float, vx: float = 0.0, vy: float = 0.0) -> None:
        """Places the ball on the ground (m), rolling with that velocity (m/s)."""
    def place_robot(self, index: int, x: float, y: float, heading: float = 0.0, *, opponent: bool = False) -> None:
        """Places a robot at rest (m, rad): an own one by its index from 0, or an opponent."""
    @property
    def time_s(self) -> float:
        """Simulated time since the episode's start, s."""
    @property
    def action_size(self) -> int:
        """Number of values in `actions`: five for each own robot."""
    @property
    def observation_size(self) -> int:
        """Number of values in an observation: five for the ball and eight for each robot."""
    @property
    def trace_hash(self) -> str:
        """Hash of every step's state so far: equal for equal episodes."""
