"""Case-based reasoning over many problems: similarity, leave-one-out, coverage, drafts and learning, from and to tables.

Lengths are mm, field frame. A table is a mapping of column names to columns, such as a pandas DataFrame or a dict of lists.
Needs `numpy`; long calls let other Python threads run.
"""

from __future__ import annotations

import csv
import json
import os
import re
import sys
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._native import SYMMETRIES, Library

if TYPE_CHECKING:
    from ._native import Problem, Settings

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

TERMS = ("ball", "robots", "scopes", "path")
"""Terms of a similarity. Distances that their local similarities take: of the ball from the case's, in radii of its scope;
of each case robot's player from its adapted position, in shares of `thr_c`; of the nearest opponent from each opponent
scope, in radii; of the nearest opponent across the ball's path, in radii, where near is unlike."""
GOALS = ("yellow", "cyan")
ROBOTS_MAX = 16
"""Robots are 0 to 15."""

Table = Mapping[str, Any]
Columns = dict[str, list[Any]]
Local = Callable[[float], float]
"""A local similarity: 0 to 1 by a distance, 1 where alike. It is asked at every 1/64 up to 4, with straight lines between."""


@dataclass(frozen=True)
class Problems:
    """Situations, one a row. What is None or NaN is unknown; a robot of NaN is absent."""

    ball: NDArray[np.float64]
    """x, y: (problems, 2)."""
    defending: NDArray[np.float64]
    """The defended goal: 0 yellow, at -x; 1 cyan."""
    teammates: NDArray[np.float64] | None = None
    """x, y of robots: (problems, robots, 2); a robot's id is its number, from 0."""
    opponents: NDArray[np.float64] | None = None
    """x, y: (problems, opponents, 2)."""

    def __post_init__(self) -> None:
        count = len(self.defending)
        for name, value, shape in (
            ("ball", self.ball, (count, 2)),
            ("defending", self.defending, (count,)),
            ("teammates", self.teammates, (count, -1, 2)),
            ("opponents", self.opponents, (count, -1, 2)),
        ):
            if value is None:
                continue
            array = np.ascontiguousarray(value, np.float64)
            if array.ndim != len(shape) or any(want not in (-1, got) for want, got in zip(shape, array.shape)):
                raise ValueError(f"{name}: of shape {array.shape}; take {shape} for {count} problems, -1 for any number")
            object.__setattr__(self, name, array)
        if self.teammates is not None and self.teammates.shape[1] > ROBOTS_MAX:
            raise ValueError(f"teammates: {self.teammates.shape[1]} robots; a robot's id is its number, 0 to 15")
        if not np.isin(self.defending[~np.isnan(self.defending)], (0, 1)).all():
            raise ValueError("defending: take 0 for yellow, 1 for cyan, or NaN")

    def __len__(self) -> int:
        return len(self.defending)

    @classmethod
    def of(cls, problems: Problems | Table | Problem | Iterable[Table]) -> Problems:
        """From problems as `onetwo.retrieve` takes them, one or many, with keys left out where unknown; or from a table."""
        if isinstance(problems, Problems):
            return problems
        if isinstance(problems, str) or (isinstance(problems, Mapping) and "ball_x" not in problems and "ball" in problems):
            problems = [problems]  # type: ignore[list-item]
        if isinstance(problems, Mapping) or hasattr(problems, "columns"):
            return cls.from_table(problems)  # type: ignore[arg-type]
        return cls._from_dicts([json.loads(one) if isinstance(one, str) else one for one in problems])

    @classmethod
    def _from_dicts(cls, problems: Sequence[Table]) -> Problems:
        columns: Columns = {"ball_x": [], "ball_y": [], "defending": []}
        for number, problem in enumerate(problems):
            stray = set(problem) - {"ball", "defending", "teammates", "opponents", "unavailable"}
            if stray:
                raise ValueError(f"problems[{number}]: unknown key {min(stray)!r}")
            x, y = problem.get("ball") or (None, None)
            row: dict[str, Any] = {"ball_x": x, "ball_y": y, "defending": problem.get("defending")}
            for name, robots in (("teammate", problem.get("teammates")), ("opponent", problem.get("opponents"))):
                places = robots.items() if isinstance(robots, Mapping) else enumerate(() if robots is None else robots)
                for robot, (x, y) in places:
                    row |= {f"{name}_{robot}_x": x, f"{name}_{robot}_y": y}
            for name in row.keys() - columns.keys():
                columns[name] = [None] * number
            for name, column in columns.items():
                column.append(row.get(name))
        found = cls.from_table(columns)
        empty = np.empty((len(problems), 0, 2))
        given = {name: [one.get(name) is not None for one in problems] for name in ("teammates", "opponents")}
        for name, known in given.items():
            if len(set(known)) > 1:
                raise ValueError(f"{name}: unknown in some problems; ask for these apart")
            if any(known) and getattr(found, name) is None:
                object.__setattr__(found, name, empty)
        return found

    @classmethod
    def from_table(cls, table: Table) -> Problems:
        """From columns ball_x, ball_y, defending ("yellow" or "cyan"), teammate_ID_x and _y, opponent_N_x and _y; a side
        without columns is unknown."""
        names = [str(name) for name in table]
        pattern = re.compile(r"ball_[xy]|defending|(teammate|opponent)_\d+_[xy]")
        for name in names:
            if not pattern.fullmatch(name):
                raise ValueError(f"table: column {name!r}; take ball_x, defending, teammate_ID_x, opponent_N_y and their like")
        count = len(table[names[0]]) if names else 0
        unknown = [None] * count
        given = table["defending"] if "defending" in names else unknown
        goals: list[float] = []
        for row, goal in enumerate(given):
            known = isinstance(goal, str) and goal != ""
            if known and goal not in GOALS:
                raise ValueError(f"defending: row {row} is {goal!r}; take yellow or cyan")
            goals.append(GOALS.index(goal) if known else np.nan)

        def places(side: str) -> NDArray[np.float64] | None:
            robots = sorted({int(name.split("_")[1]) for name in names if name.startswith(side)})
            if not robots:
                return None
            if side == "teammate" and robots[-1] >= ROBOTS_MAX:
                raise ValueError(f"table: column {side}_{robots[-1]}_x; robots are 0 to 15")
            at = np.full((count, robots[-1] + 1, 2), np.nan)
            for robot in robots:
                for axis, letter in enumerate("xy"):
                    at[:, robot, axis] = _numbers(table, f"{side}_{robot}_{letter}")
            return at

        has_ball = "ball_x" in names or "ball_y" in names
        ball = [_numbers(table, name) if has_ball else np.full(count, np.nan) for name in ("ball_x", "ball_y")]
        return cls(np.stack(ball, 1), np.array(goals), places("teammate"), places("opponent"))

    @classmethod
    def from_csv(cls, file: str | os.PathLike[str]) -> Problems:
        """From a CSV file with the columns of `from_table`; an empty cell is unknown."""
        return cls.from_table(read_csv(file))

    def _columns(self, left_out: NDArray[np.float64] | None = None) -> tuple[Any, ...]:
        flat = [None if one is None else one.ravel() for one in (self.teammates, self.opponents)]
        return (self.ball.ravel(), self.defending, *flat, left_out)


@dataclass(frozen=True)
class Ranking:
    """The k most similar cases of each problem, the most similar first."""

    library: Library
    ids: NDArray[np.int32]
    """Numbers of stored cases, (problems, k): four times the authored case's number, plus the symmetry's. -1: no more."""
    similarity: NDArray[np.float32]
    """Weighted mean of the known terms, (problems, k)."""
    terms: dict[str, NDArray[np.float32]]
    """Local similarities by term, (problems, k); NaN where unknown, or where a case has no opponent scope."""
    players: NDArray[np.int8]
    """Ids of the robots that take the parts of the case's robots, (problems, k, 4); -1: no part."""

    def rows(self, problem: int) -> list[dict[str, Any]]:
        """The cases of one problem as dicts."""
        names = self.library.names
        return [
            {
                "case": names[case // 4],
                "id": int(case),
                "symmetry": SYMMETRIES[case % 4],
                "similarity": float(self.similarity[problem, n]),
                "terms": {term: float(values[problem, n]) for term, values in self.terms.items()},
                "match": {str(part + 1): int(robot) for part, robot in enumerate(self.players[problem, n]) if robot >= 0},
            }
            for n, case in enumerate(self.ids[problem])
            if case >= 0
        ]

    def table(self) -> Columns:
        """A row for each problem and case: problem, rank, case, id, similarity and the terms; a DataFrame takes it."""
        found = np.argwhere(self.ids >= 0)
        names, ids = self.library.names, self.ids[self.ids >= 0]
        return {
            "problem": found[:, 0].tolist(),
            "rank": (found[:, 1] + 1).tolist(),
            "case": [names[case // 4] for case in ids],
            "id": ids.tolist(),
            "similarity": self.similarity[self.ids >= 0].tolist(),
            **{term: values[self.ids >= 0].tolist() for term, values in self.terms.items()},
        }


def rank(
    library: Library,
    problems: Problems | Table | Problem | Iterable[Table],
    k: int = 5,
    *,
    weights: Mapping[str, float] | None = None,
    local: Mapping[str, Local] | None = None,
    unknown: str = "ignore",
    settings: Settings | None = None,
    threads: int | None = None,
    left_out: ArrayLike | None = None,
) -> Ranking:
    """The `k` cases most similar to each problem, of those stored for its goal, whether retrieval takes them or not.

    weights: of the `TERMS`, 1 unless given. local: local similarities; unless given exp(-d²), for robots 1 - d, at least 0.
    unknown: what an unknown attribute's term counts: "ignore", its weight is left out; "worst", 0; "best", 1. An unknown
    ball leaves robots, scopes and path where the case has them; with an unknown goal the cases of both are asked.
    left_out: for each problem the number of an authored case that is not asked, -1 for none. ValueError for other values."""
    asked = Problems.of(problems)
    count = len(asked)
    if not isinstance(k, (int, np.integer)) or not 1 <= k <= len(library):
        raise ValueError(f"k {k!r}: take 1 to {len(library)}, the number of stored cases")
    out = None if left_out is None else np.ascontiguousarray(left_out, np.float64)
    if out is not None and out.shape != (count,):
        raise ValueError(f"left_out: of shape {out.shape}; take one number for each of {count} problems")
    ids, similarity = np.empty((count, k), np.int32), np.empty((count, k), np.float32)
    terms, players = np.empty((count, k, len(TERMS)), np.float32), np.empty((count, k, 4), np.int8)
    into = [ids, similarity, terms, players]
    if count:
        _native._rank(
            library, asked._columns(out), k, dict(weights or {}), dict(local or {}), unknown, settings, _threads(threads), into
        )
    return Ranking(library, ids, similarity, {term: terms[:, :, n] for n, term in enumerate(TERMS)}, players)


def retrieve(
    library: Library,
    problems: Problems | Table | Problem | Iterable[Table],
    *,
    settings: Settings | None = None,
    threads: int | None = None,
) -> NDArray[np.int32]:
    """Ids of the stored cases that `Library.retrieve` answers to the problems, -1 where none fits."""
    asked = Problems.of(problems)
    ids = np.empty(len(asked), np.int32)
    if len(asked):
        _native._retrieve(library, asked._columns(), settings, _threads(threads), ids)
    return ids


@dataclass(frozen=True)
class LeaveOneOut:
    """Each authored case as a problem for the other ones."""

    case: list[str]
    nearest: list[str]
    similarity: NDArray[np.float32]
    same: NDArray[np.bool_]
    """Whether the nearest case has the same solution."""

    @property
    def accuracy(self) -> float:
        """Share of cases whose nearest other one has the same solution."""
        return float(self.same.mean())


def leave_one_out(
    library: Library, *, label: Callable[[Mapping[str, Any]], Hashable] | None = None, **similarity: Any
) -> LeaveOneOut:
    """Retrieves for each authored case's own situation without that case and its mirror images.

    label: what counts as a case's solution, by its row of `table`; unless given, the words of all robots' actions in their
    order. Other arguments are those of `rank`."""
    rows = _rows(table(library))
    labels = [(label or _plan)(row) for row in rows]
    ranking = rank(library, situations(library), 1, left_out=np.arange(len(rows)), **similarity)
    nearest = ranking.ids[:, 0] // 4
    same = np.array([labels[n] == labels[m] for n, m in enumerate(nearest)], np.bool_)
    names = library.names
    return LeaveOneOut(names, [names[m] for m in nearest], ranking.similarity[:, 0], same)


def coverage(
    library: Library,
    problems: Problems | Table | Iterable[Table] | None = None,
    *,
    samples: int = 100_000,
    seed: int = 1,
    settings: Settings | None = None,
    threads: int | None = None,
) -> dict[str, Any]:
    """How the library covers problems, or `samples` drawn ones, those of `onetwo cases stats`: number of problems, of those
    without a case ("none"), of candidates; for each case how often it is a candidate, wins, and is the "sole" candidate, and
    its role in the library's competence (Smyth & McKenna 2001)."""
    columns = None if problems is None else Problems.of(problems)._columns()
    found: dict[str, Any] = _native._coverage(library, columns, samples, seed, settings, _threads(threads))
    return found


def draft(library: Library, problem: Problem) -> dict[str, Any]:
    """A case file for a situation, to be edited: "text", "notes", and whether the case is "retrieved" from it."""
    found: dict[str, Any] = _native._draft(library, problem)
    return found


def learn(
    library: Library,
    *,
    budget: int = 300_000,
    seed: int = 1,
    only: Sequence[str] = ("scopes", "actions", "new", "forget", "order"),
    profile: str = "simulated",
    error_rate: float = 0.1,
    dry_run: bool = False,
    threads: int | None = None,
) -> tuple[dict[str, Any], dict[str, str]]:
    """Learns as `onetwo cases learn` does, whose flags the arguments are, in memory: the report, and the texts of the learned
    library's files, which `write` writes. Some 80 trials a second and core; `budget` counts trials, or scenes of matches."""
    found: tuple[dict[str, Any], dict[str, str]] = _native._learn(
        library, budget, seed, list(only), profile, error_rate, dry_run, _threads(threads)
    )
    return found


def table(library: Library) -> Columns:
    """The authored cases, one a row: case ("region/name"), intent, defending, ball_x and _y, ball_scope_x and _y; for each
    robot from 1 teammate_N_x and _y, and teammate_N_gameplay as JSON; for each opponent opponent_N_x and _y, _scope_x and
    _scope_y, _presence. None where a case has no such robot."""
    rows = []
    for name, text in _native._files(library).items():
        if name == "league":
            continue
        case = tomllib.loads(text)
        row = {"case": name, "intent": case.get("intent"), "defending": case["defending"]}
        row |= _place("ball", case["ball"])
        for n, robot in enumerate(case["teammates"], 1):
            row |= _place(f"teammate_{n}", robot) | {f"teammate_{n}_gameplay": json.dumps(robot["gameplay"])}
        for n, opponent in enumerate(case.get("opponents", []), 1):
            presence = opponent.get("presence", "preferred")
            row |= _place(f"opponent_{n}", opponent) | {f"opponent_{n}_presence": presence}
        rows.append(row)
    names = list(dict.fromkeys(name for row in rows for name in row))
    return {name: [row.get(name) for row in rows] for name in names}


def situations(library: Library) -> Problems:
    """The authored cases as problems: their ball, robots (ids from 1), and opponents but for excluded ones."""
    problems = []
    for row in _rows(table(library)):
        at = {name[:-2]: [row[name], row[f"{name[:-2]}_y"]] for name in row if name.endswith("_x") and "scope" not in name}
        problems.append(
            {
                "ball": at["ball"],
                "defending": row["defending"],
                "teammates": {name.split("_")[1]: place for name, place in at.items() if name.startswith("teammate")},
                "opponents": [
                    place
                    for name, place in at.items()
                    if name.startswith("opponent") and row[f"{name}_presence"] != "excluded"
                ],
            }
        )
    return Problems._from_dicts(problems)


def write(directory: str | os.PathLike[str], library: Library | Mapping[str, str], cases: Table | None = None) -> None:
    """Writes case files of a library, or of texts by name, into a directory that `onetwo.Library(directory=…)` opens; with
    `cases`, a table as `table` gives it, these instead of the library's own. The directory must be new or empty."""
    files = dict(_native._files(library) if isinstance(library, Library) else library)
    if cases is not None:
        files = {"league": files["league"]} | {str(row["case"]): _toml(row) for row in _rows(cases)}
    target = Path(directory)
    if target.is_dir() and any(target.iterdir()):
        raise ValueError(f"directory {str(directory)!r}: not empty; take a new one")
    for name, text in files.items():
        if not re.fullmatch(r"league|[\w-]+/[\w-]+", name):
            raise ValueError(f"case {name!r}: take region/name, of letters, digits and hyphens")
        file = target / f"{name}.toml"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


def read_csv(file: str | os.PathLike[str]) -> Columns:
    """A CSV file as a table: texts, None for empty cells."""
    with open(file, newline="", encoding="utf-8") as lines:
        rows = list(csv.reader(lines))
    names = rows[0] if rows else []
    for line, row in enumerate(rows, 1):
        if len(row) != len(names):
            raise ValueError(f"{os.fspath(file)}: line {line} has {len(row)} cells; the first line names {len(names)}")
    return {name: [row[n] or None for row in rows[1:]] for n, name in enumerate(names)}


def write_csv(file: str | os.PathLike[str], columns: Table) -> None:
    """Writes a table as CSV; None and NaN are empty cells."""
    with open(file, "w", newline="", encoding="utf-8") as lines:
        writer = csv.writer(lines)
        writer.writerow(columns)
        for row in zip(*(columns[name] for name in columns)):
            writer.writerow("" if value is None or value != value else value for value in row)


def _rows(columns: Table) -> list[dict[str, Any]]:
    names = [str(name) for name in columns]
    rows = [dict(zip(names, row)) for row in zip(*(columns[name] for name in names))]
    # What is missing in a DataFrame is NaN, which differs from itself.
    return [{name: value for name, value in row.items() if value is not None and value == value} for row in rows]


def _numbers(columns: Table, name: str) -> NDArray[np.float64]:
    if name not in columns:
        raise ValueError(f"table: no column {name}; x and y come together")
    column = columns[name]
    try:
        return np.array([np.nan if value is None else value for value in column], np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"table: column {name} has a value that is no number") from None


def _place(name: str, of: Mapping[str, Any]) -> dict[str, Any]:
    places = {f"{name}_x": of["at"][0], f"{name}_y": of["at"][1]}
    if "scope" in of:
        places |= {f"{name}_scope_x": of["scope"][0], f"{name}_scope_y": of["scope"][1]}
    return places


def _plan(row: Mapping[str, Any]) -> Hashable:
    plans = [json.loads(value) for name, value in row.items() if name.endswith("_gameplay")]
    return tuple(tuple(one if isinstance(one, str) else next(iter(one)) for one in plan) for plan in plans)


def _toml(row: Mapping[str, Any]) -> str:
    """The file of a case by its row."""

    def pair(name: str) -> str:
        try:
            return _value([round(float(row[f"{name}_{axis}"])) for axis in "xy"])
        except (KeyError, TypeError, ValueError):
            raise ValueError(f"case {row['case']!r}: {name}_x and {name}_y: take numbers, mm") from None

    lines = [f"intent = {_value(row['intent'])}"] if "intent" in row else []
    lines.append(f"defending = {_value(row.get('defending'))}")
    lines.append(f"ball = {{ at = {pair('ball')}, scope = {pair('ball_scope')} }}")
    for side, table_name in (("teammate", "teammates"), ("opponent", "opponents")):
        for n in range(1, 5):
            if f"{side}_{n}_x" not in row:
                continue
            lines += ["", f"[[{table_name}]]", f"at = {pair(f'{side}_{n}')}"]
            if side == "teammate":
                lines.append(f"gameplay = {_value(json.loads(row.get(f'teammate_{n}_gameplay', '[]')))}")
            else:
                lines.append(f"scope = {pair(f'opponent_{n}_scope')}")
                lines.append(f"presence = {_value(row.get(f'opponent_{n}_presence', 'preferred'))}")
    return "\n".join(lines) + "\n"


def _value(value: Any) -> str:
    """A value of TOML, on one line."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{name} = {_value(one)}" for name, one in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def _threads(threads: int | None) -> int:
    return (os.cpu_count() or 1) if threads is None else threads
