"""Types of the Rust side. Lengths of cases are mm, those of the simulator m; field frame: origin at the centre, +x
along the length."""

from collections.abc import Mapping, Sequence
from os import PathLike
from typing import Any, Protocol, SupportsFloat, SupportsIndex, final

import typing_extensions

class _Array(Protocol):
    """An array of NumPy, whose own types say only from Python 3.12 on that it is a buffer."""

    @property
    def __array_interface__(self) -> dict[str, Any]: ...

Buffer = typing_extensions.Buffer | _Array
Whole = SupportsIndex
"""A whole number, Python's or NumPy's."""
Real = SupportsFloat | SupportsIndex

VERSION: str

SYMMETRIES: list[str]
"""Names of the symmetries, by the id of a stored case modulo 4."""

Problem = str | Mapping[str, Any]
"""A situation, as a line of `onetwo cases retrieve` or as the same object: {"ball": [x, y], "defending": "yellow" or
"cyan", "teammates": {robot: [x, y]}, "opponents": [[x, y]]}; whole mm, robots 0 to 15."""

Settings = Mapping[str, Any]
"""Named settings of retrieval (docs/case-format.md §3.2), such as {"thr_c": 1200}."""

@final
class Library:
    """A case library, opened once and asked many times; a directory's stays in memory until the process ends."""

    def __copy__(self) -> Library: ...
    def __deepcopy__(self, _memo: Any, /) -> Library: ...
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
    seed: Whole = 1,
    profile: str = "simulated",
    robots: Whole = 2,
    library: Library | None = None,
    settings: Settings | None = None,
    positioning: str = "dependent",
    retrievers: Whole | None = None,
    loss: Real = 0.0,
    symmetry: bool = True,
    case_opponents: bool = True,
    opponents_play_on: bool = False,
) -> dict[str, Any]:
    """Plays one trial of Ros et al. 2009 and returns its report (docs/case-format.md §5.2).

    The arguments are the flags of `onetwo trial`; `symmetry=False` is --no-symmetry, `case_opponents=False` is
    --no-opponents. Other threads run meanwhile. Raises ValueError for a value that a flag would refuse."""

@final
class Simulator:
    """Episodes of a task in the Small Size simulator, one control period a step.

    Own robots attack the goal at +x. An action is five numbers a robot, clamped to [-1, 1]: forward and left (times the
    robot's greatest speed, 3.5 m/s), turn (times 15 rad/s, counter-clockwise), kick (above 0: kick as soon as the ball
    is in front, times 8 m/s), dribbler (above 0: share of its strength). The values are division B's.

    An observation is numbers within ±1, cut off there: the ball's x, y, height, velocity along x and y; for each own
    robot and then each opponent x, y, sine and cosine of the heading, velocity along x and y, turning rate, ball contact
    (0 or 1). Positions are shares of the way from the centre to the boards, the height is m, velocities of the ball are
    shares of 8 m/s, of robots of 3.5 m/s, turning rates of 15 rad/s. Under the referee four more: 1 while the ball is in
    play, whose restart it is (1 own, -1 the opponents'), goals ahead / 10, share of the time that is left.

    Tasks, their rewards and ends: the package's README."""

    def __copy__(self) -> Simulator: ...
    def __deepcopy__(self, _memo: Any, /) -> Simulator: ...
    def __new__(
        cls,
        own: Whole | None = None,
        opponents: Whole | None = None,
        *,
        task: str = "score",
        agents: Whole | None = None,
        teammates_by: str = "none",
        opponents_by: str | None = None,
        world: str = "nominal",
        observation: str = "truth",
        league: str | None = None,
        period_ms: Whole | None = None,
        time_limit_s: Real | None = None,
        seed: Whole = 0,
    ) -> Simulator:
        """A simulator, with its first episode started. Raises ValueError for a value outside of these.

        task: "score", "shoot-at-keeper", "pass-and-receive", "contested-ball", "keep-away", "3v3", "6v6", or a trial of
        the first paper, "scenario-1" to "scenario-4" or "scenario-random"; what is None is the task's. own: robots of
        the own team, 1 to 11. opponents: 0 to 11. agents: own robots, from 0, that `actions` move. teammates_by, opponents_by: who moves the others: "none", "scripted" (on the true state), "coach"
        (ours: brains, cases and coach, with cameras and radio), "reactive", "marking" or "zone" (the reference teams).
        world: "nominal", a profile of `onetwo play --world`, "random" (another one for each seed) or "random:SEED".
        observation: "truth", or "sensed": what a host estimates from cameras. league: "division-b", "division-a" or
        "ssl-2013"; "four-legged" for trials, whose periods are multiples of 40. period_ms: simulated time of a step, 1 to 100 ms, 25 unless
        given; a multiple of 10 where a coach, a reference team or the referee takes part, 30 unless given."""
    def reset(self, seed: Whole) -> None:
        """Starts another episode, from random start positions that follow from the seed alone."""
    def step(
        self,
        actions: Buffer | Sequence[float],
        opponent_actions: Buffer | Sequence[float] | None = None,
        into: Buffer | None = None,
    ) -> tuple[float, str | None]:
        """Plays one period; returns the reward and how the episode ended: "goal", "own_goal", "out", "received", "won",
        "lost", "close", "time", or None while it goes on. A finished episode stays as it is.

        actions: `action_size` numbers, a buffer of float32 or a flat sequence. opponent_actions: five for each opponent,
        only with opponents_by="none"; they stand still without. into: see `observe`. Raises ValueError for another number
        of values or one that is not finite."""
    def observe(self, into: Buffer, index: Whole = 0, opponent: bool = False) -> None:
        """Writes the observation into a writable buffer of `observation_size` float32: with own robot `index` first of its
        side, or seen by the opponents, who come first then and attack +x, with their robot `index` first."""
    def state(self) -> dict[str, Any]:
        """The true state: time_s; ball with position (x, y, height, m) and velocity (m/s); own and opponents, lists of
        robots with position (m), heading (rad), velocity (m/s), turning (rad/s) and ball_contact; under the referee score
        (own, opponents) and in_play."""
    def pixels(self, width: Whole) -> tuple[bytes, int, int]:
        """The drawn field `width` pixels wide, 64 to 4096: red, green and blue of each pixel row by row from the top, width
        and height, both even. Own robots are blue, those that `actions` move framed in black, opponents grey; a white line
        is a robot's front."""
    def svg(self, width: Whole = 960) -> str:
        """The drawn field as SVG."""
    def _repr_svg_(self) -> str:
        """The picture of a notebook's cell."""
    def place_ball(self, x: Real, y: Real, vx: Real = 0.0, vy: Real = 0.0) -> None:
        """Places the ball on the ground (m), rolling with that velocity (m/s). Raises ValueError in trials, as does
        `place_robot`."""
    def place_robot(self, index: Whole, x: Real, y: Real, heading: Real = 0.0, *, opponent: bool = False) -> None:
        """Places a robot at rest (m, rad): an own one by its index from 0, or an opponent."""
    def save(self) -> bytes:
        """The state of the episode: a simulator that restores it goes on bit for bit, in another process too.

        Where a coach, a reference team or the referee takes part, in trials and with observation="sensed" it holds the
        seed and all orders since, which `restore` plays again; else the whole state, and `restore` takes microseconds."""
    def restore(self, state: bytes) -> None:
        """Goes on from a saved state of a simulator with the same settings. Raises ValueError for foreign or damaged bytes,
        and for those of another version."""
    @property
    def time_s(self) -> float:
        """Simulated time since the episode's start, s."""
    @property
    def end(self) -> str | None:
        """How the episode ended; None while it goes on."""
    @property
    def score(self) -> tuple[int, int]:
        """Goals of the own team and of the opponents under the referee; (0, 0) in other tasks."""
    @property
    def robots(self) -> tuple[int, int, int]:
        """Number of own robots, of those that `actions` move, and of opponents."""
    @property
    def task(self) -> str:
        """Name of the task."""
    @property
    def opponents_by(self) -> str:
        """Who moves the opponents."""
    @property
    def period_ms(self) -> int:
        """Simulated time of a step, ms."""
    @property
    def action_size(self) -> int:
        """Number of values in `actions`: five for each robot that they move."""
    @property
    def observation_size(self) -> int:
        """Number of values in an observation: five for the ball, eight for each robot, four for the referee."""
    @property
    def trace_hash(self) -> str:
        """Hash of every step's state so far: equal for equal episodes."""

@final
class VectorSimulator:
    """Many episodes of the same settings, stepped by one call on several threads."""

    ENDS: tuple[str | None, ...] | list[str | None]
    """Names of the ends by the numbers that `step` writes; None for 0."""

    def __deepcopy__(self, _memo: Any, /) -> VectorSimulator: ...
    def __new__(cls, simulator: Simulator, count: Whole, threads: Whole) -> VectorSimulator:
        """`count` episodes, 1 to 10,000, with the settings of `simulator`, from seeds 0 up; on at most `threads` threads, 1 to 256."""
    def step(
        self,
        actions: Buffer | Sequence[float],
        restarts: Sequence[tuple[Whole, Whole]],
        observations: Buffer,
        rewards: Buffer,
        ends: Buffer,
    ) -> None:
        """Starts the episodes of `restarts`, (index, seed), again and steps all others; writes observations and rewards
        (float32) and numbers of `ENDS` (uint8) of all. Raises ValueError as `Simulator.step` does."""
    def times_s(self) -> list[float]:
        """Simulated time of each episode, s."""
    def pixels(self, index: Whole, width: Whole) -> tuple[bytes, int, int]:
        """The drawn field of an episode, as `Simulator.pixels`."""
    def ended(self) -> list[bool]:
        """Whether each episode has ended."""
    def save(self) -> bytes:
        """The state of all episodes, as `Simulator.save`."""
    def restore(self, state: bytes) -> None:
        """As `Simulator.restore`, for as many episodes."""

# What `onetwo.cases` is made of.
def _rank(
    library: Library,
    columns: tuple[Any, ...],
    k: Whole,
    weights: dict[str, float],
    local: dict[str, Any],
    unknown: str,
    settings: Settings | None,
    threads: Whole,
    into: list[Any],
) -> None: ...
def _retrieve(library: Library, columns: tuple[Any, ...], settings: Settings | None, threads: Whole, into: Any) -> None: ...
def _coverage(
    library: Library, columns: tuple[Any, ...] | None, samples: Whole, seed: Whole, settings: Settings | None, threads: Whole
) -> dict[str, Any]: ...
def _draft(library: Library, problem: Problem) -> dict[str, Any]: ...
def _files(library: Library) -> dict[str, str]: ...
def _learn(
    library: Library,
    budget: Whole,
    seed: Whole,
    kinds: list[str],
    profile: str,
    error_rate: Real,
    dry_run: bool,
    threads: Whole,
) -> tuple[dict[str, Any], dict[str, str]]: ...

# What `pickle` calls.
def _library(league: str, directory: str | PathLike[str] | None) -> Library: ...
def _simulator(state: bytes) -> Simulator: ...
def _vector(state: bytes, threads: Whole) -> VectorSimulator: ...
