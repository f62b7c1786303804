"""Cases for research: similarity against its definition, tables, leave-one-out, coverage and learning against the program."""

import json
import math
import os
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import numpy as np
import pandas as pd

import onetwo
from onetwo import cases

PROGRAM = os.environ["ONETWO"]
SITUATION = {"ball": [-600, 10], "defending": "yellow", "teammates": {1: [-700, 0], 3: [200, 800]}, "opponents": [[-150, 40]]}
BUILT_IN = {league: onetwo.Library(league) for league in ("four-legged", "division-b")}
LIBRARY = BUILT_IN["four-legged"]


def drawn(count, seed=1):
    """Problems around the field, with two robots and two opponents."""
    draw = np.random.default_rng(seed)
    places = [draw.uniform([-2700, -1800], [2700, 1800], (count, n, 2)).round() for n in (1, 2, 2)]
    return cases.Problems(places[0][:, 0], draw.integers(0, 2, count), places[1], places[2])


def as_dict(problems, n):
    """One of them as `onetwo.retrieve` takes it."""
    robots = enumerate(problems.teammates[n].astype(int).tolist())
    return {
        "ball": problems.ball[n].astype(int).tolist(),
        "defending": cases.GOALS[int(problems.defending[n])],
        "teammates": dict(robots),
        "opponents": problems.opponents[n].astype(int).tolist(),
    }


class Similarity(unittest.TestCase):
    def test_terms_are_those_of_explain_where_it_has_them(self):
        for league, library in BUILT_IN.items():
            problems = cases.situations(library)
            ranking = cases.rank(library, problems, len(library) // 2)
            for n in range(0, len(problems), 5):
                asked = as_dict_of_situation(library, n)
                verdicts = {row["id"]: row for row in library.explain(asked)["cases"]}
                for row in ranking.rows(n):
                    verdict = verdicts[row["id"]]
                    if "similarity" in verdict:
                        self.assertAlmostEqual(row["terms"]["ball"], verdict["similarity"], delta=6e-5, msg=league)
                    if verdict["verdict"] == "candidate":
                        self.assertEqual(row["match"], verdict["match"])
                        parts = len(verdict["match"])
                        self.assertAlmostEqual(row["terms"]["robots"], 1 - verdict["cost"] / 1500 / parts, delta=1e-4)
                    if verdict["verdict"] == "path":
                        self.assertLess(row["terms"]["path"], 1 - 0.367)

    def test_the_similarity_is_the_weighted_mean_of_its_terms(self):
        weights = {"ball": 3.0, "robots": 0.5, "path": 0.0}
        for row in cases.rank(LIBRARY, SITUATION, 20, weights=weights).rows(0):
            known = {term: value for term, value in row["terms"].items() if not math.isnan(value)}
            all_weights = {"scopes": 1.0, **weights}
            sums = sum(all_weights[t] * v for t, v in known.items()), sum(all_weights[t] for t in known)
            self.assertAlmostEqual(row["similarity"], sums[0] / sums[1], places=5)
        best = cases.rank(LIBRARY, SITUATION, 1).rows(0)[0]
        self.assertEqual(best["case"], onetwo.retrieve(SITUATION)["case"])

    def test_a_callers_local_similarity_is_asked(self):
        step = {"ball": lambda distance: float(distance < 1)}
        rows = cases.rank(LIBRARY, SITUATION, 68, weights=dict.fromkeys(cases.TERMS, 0) | {"ball": 1}, local=step).rows(0)
        usual = {row["id"]: row["terms"]["ball"] for row in cases.rank(LIBRARY, SITUATION, 68).rows(0)}
        for row in rows:
            inside = usual[row["id"]] > math.exp(-1) + 0.02
            if abs(usual[row["id"]] - math.exp(-1)) > 0.02:
                self.assertEqual(row["similarity"], float(inside), row)
        same = cases.rank(LIBRARY, drawn(50), 5, local={"ball": lambda d: math.exp(-d * d)})
        np.testing.assert_allclose(same.similarity, cases.rank(LIBRARY, drawn(50), 5).similarity, atol=1e-3)

    def test_unknown_attributes_count_by_the_rule(self):
        blind = {key: value for key, value in SITUATION.items() if key != "opponents"}
        for rule, value in (("worst", 0.0), ("best", 1.0)):
            for row in cases.rank(LIBRARY, blind, 5, unknown=rule).rows(0):
                terms = row["terms"]
                self.assertTrue(math.isnan(terms["path"]) and math.isnan(terms["scopes"]))
                self.assertAlmostEqual(row["similarity"], (terms["ball"] + terms["robots"] + 2 * value) / 4, places=5)
        row = cases.rank(LIBRARY, blind, 1).rows(0)[0]
        self.assertAlmostEqual(row["similarity"], (row["terms"]["ball"] + row["terms"]["robots"]) / 2, places=5)
        nothing = cases.rank(LIBRARY, [{}], 136).rows(0)
        self.assertEqual((len(nothing), {row["similarity"] for row in nothing}), (136, {0.0}))
        self.assertEqual(len(cases.rank(LIBRARY, SITUATION, 136).rows(0)), 68)

    def test_a_hundred_thousand_problems_in_one_call(self):
        problems = drawn(100_000)
        started = time.monotonic()
        ids = cases.retrieve(LIBRARY, problems)
        ranked = cases.rank(LIBRARY, problems, 3)
        self.assertLess(time.monotonic() - started, 120)
        self.assertEqual((ids.shape, ranked.similarity.shape), ((100_000,), (100_000, 3)))
        self.assertTrue((np.diff(ranked.similarity, axis=1) <= 0).all())
        for n in range(0, 100_000, 997):
            answer = LIBRARY.retrieve(as_dict(problems, n))
            self.assertEqual(ids[n], -1 if answer["case"] is None else answer["id"])
        one = cases.rank(LIBRARY, as_dict(problems, 7), 3, threads=1)
        np.testing.assert_array_equal(one.ids[0], ranked.ids[7])

    def test_bad_values_are_refused_by_name(self):
        for words, call in (
            ("k 0", lambda: cases.rank(LIBRARY, SITUATION, 0)),
            ("k 137", lambda: cases.rank(LIBRARY, SITUATION, 137)),
            ("weights: no term 'colour'|weights: no term .colour.", lambda: cases.rank(LIBRARY, SITUATION, weights={"colour": 1})),
            ("weights: ball is -1", lambda: cases.rank(LIBRARY, SITUATION, weights={"ball": -1})),
            ("local: path gives 2", lambda: cases.rank(LIBRARY, SITUATION, local={"path": lambda d: 2})),
            ("local: path is 3", lambda: cases.rank(LIBRARY, SITUATION, local={"path": 3})),
            ("unknown .guess.", lambda: cases.rank(LIBRARY, SITUATION, unknown="guess")),
            ("threads 0", lambda: cases.rank(LIBRARY, SITUATION, threads=0)),
            ("left_out", lambda: cases.rank(LIBRARY, SITUATION, left_out=[1, 2])),
            ("defending: row 0", lambda: cases.rank(LIBRARY, {**SITUATION, "defending": "left"})),
            ("unknown key 'stray'", lambda: cases.rank(LIBRARY, {**SITUATION, "stray": 1})),
            ("ball: number 0 is inf", lambda: cases.rank(LIBRARY, {**SITUATION, "ball": [math.inf, 0]})),
            ("robots are 0 to 15", lambda: cases.rank(LIBRARY, {**SITUATION, "teammates": {16: [0, 0]}})),
            ("teammates: problem 0 has 12", lambda: cases.rank(LIBRARY, {**SITUATION, "teammates": {n: [n, 0] for n in range(12)}})),
            ("opponents: problem 0 has 12", lambda: cases.rank(LIBRARY, {**SITUATION, "opponents": [[n, 0] for n in range(12)]})),
            ("ball: of shape", lambda: cases.Problems(np.zeros((2, 3)), np.zeros(2))),
            ("column 'ball_z'", lambda: cases.Problems.of({"ball_x": [1], "ball_z": [2]})),
            ("no column ball_y", lambda: cases.Problems.of({"ball_x": [1]})),
            ("no number", lambda: cases.Problems.of({"ball_x": ["a"], "ball_y": [2]})),
            ("not known in all parts", lambda: cases.retrieve(LIBRARY, {"ball": [0, 0], "defending": "yellow"})),
            ("thr_x", lambda: cases.rank(LIBRARY, SITUATION, settings={"thr_x": 1})),
            ("only", lambda: cases.learn(LIBRARY, only=["magic"])),
            ("profile", lambda: cases.learn(LIBRARY, profile="mars")),
            ("error_rate", lambda: cases.learn(LIBRARY, error_rate=2)),
            ("one teammate", lambda: cases.draft(LIBRARY, {**SITUATION, "teammates": {}})),
            ("samples|count", lambda: cases.coverage(LIBRARY, samples=-1)),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                call()


def as_dict_of_situation(library, n):
    """The situation of an authored case as `onetwo.retrieve` takes it."""
    problems = cases.situations(library)
    there = lambda places: {i: at.astype(int).tolist() for i, at in enumerate(places) if not np.isnan(at[0])}
    return {
        "ball": problems.ball[n].astype(int).tolist(),
        "defending": cases.GOALS[int(problems.defending[n])],
        "teammates": there(problems.teammates[n]),
        "opponents": list(there(problems.opponents[n]).values()),
    }


class Tables(unittest.TestCase):
    def test_problems_are_the_same_from_arrays_pandas_and_csv(self):
        problems = drawn(20)
        frame = pd.DataFrame({"ball_x": problems.ball[:, 0], "ball_y": problems.ball[:, 1]})
        frame["defending"] = [cases.GOALS[int(goal)] for goal in problems.defending]
        for n in range(2):
            for axis, letter in enumerate("xy"):
                frame[f"teammate_{n}_{letter}"] = problems.teammates[:, n, axis]
                frame[f"opponent_{n}_{letter}"] = problems.opponents[:, n, axis]
        frame.loc[3, ["teammate_1_x", "teammate_1_y"]] = np.nan
        expected = cases.rank(LIBRARY, frame, 3)
        self.assertEqual(expected.rows(3)[0]["match"].get("2"), None)
        with tempfile.TemporaryDirectory() as folder:
            for file, write in (("a.csv", lambda path: frame.to_csv(path, index=False)), ("b.csv", lambda path: cases.write_csv(path, frame))):
                write(Path(folder, file))
                found = cases.rank(LIBRARY, cases.Problems.from_csv(Path(folder, file)), 3)
                np.testing.assert_array_equal(found.similarity, expected.similarity)
            Path(folder, "c.csv").write_text("ball_x,ball_y\n1\n")
            with self.assertRaisesRegex(ValueError, "line 2 has 1 cells"):
                cases.Problems.from_csv(Path(folder, "c.csv"))
        self.assertEqual(len(pd.DataFrame(expected.table())), 60)

    def test_a_library_survives_its_table_and_pandas_edits_it(self):
        for league, library in BUILT_IN.items():
            with tempfile.TemporaryDirectory() as folder:
                frame = pd.DataFrame(cases.table(library))
                cases.write(Path(folder, league), library, frame)
                again = onetwo.Library(directory=Path(folder, league))
                self.assertEqual(again.names, library.names)
                problems = drawn(2000)
                np.testing.assert_array_equal(cases.retrieve(again, problems), cases.retrieve(library, problems))
                frame["ball_scope_x"] *= 2
                cases.write(Path(folder, "wide", league), library, frame)
                wide = onetwo.Library(directory=Path(folder, "wide", league))
                fits = [(cases.retrieve(one, problems) >= 0).sum() for one in (library, wide)]
                self.assertGreater(fits[1], fits[0])
                with self.assertRaisesRegex(ValueError, "not empty"):
                    cases.write(Path(folder, league), library)
                with self.assertRaisesRegex(ValueError, "ball_x and ball_y"):
                    cases.write(Path(folder, "bad"), library, frame.assign(ball_x="here"))
                with self.assertRaisesRegex(ValueError, "case '../x'"):
                    cases.write(Path(folder, "bad"), library, frame.assign(case="../x"))


class Functions(unittest.TestCase):
    def test_leave_one_out_asks_the_other_cases(self):
        for library in BUILT_IN.values():
            found = cases.leave_one_out(library)
            self.assertEqual(found.case, library.names)
            self.assertTrue(all(case != nearest for case, nearest in zip(found.case, found.nearest)))
            self.assertTrue(0 < found.accuracy < 1)
            region = cases.leave_one_out(library, label=lambda row: row["case"].split("/")[0], weights={"ball": 5})
            self.assertEqual(region.same.tolist(), [a.split("/")[0] == b.split("/")[0] for a, b in zip(region.case, region.nearest)])

    def test_coverage_is_the_programs(self):
        arguments = [PROGRAM, "cases", "stats", "--problems", "3000", "--seed", "5", "--json"]
        printed = json.loads(subprocess.run(arguments, capture_output=True, text=True, check=True).stdout)
        found = cases.coverage(LIBRARY, samples=3000, seed=5)
        self.assertEqual((found["problems"], found["none"]), (printed["problems"], printed["none"]))
        theirs = {row["case"]: row for row in printed["cases"]}
        for row in found["cases"]:
            their = theirs[row["case"]]
            expected = [their["role"], their["verdicts"]["candidate"], their["wins"], their["lost_if_deleted"]]
            self.assertEqual([row[key] for key in ("role", "candidate", "wins", "sole")], expected, row["case"])
        problems = drawn(500)
        none = (cases.retrieve(LIBRARY, problems) < 0).sum()
        self.assertEqual(cases.coverage(LIBRARY, problems)["none"], none)

    def test_a_draft_is_retained_and_then_retrieved(self):
        problems = drawn(200)
        for n in np.flatnonzero(cases.retrieve(LIBRARY, problems) < 0):
            gap = as_dict(problems, n)
            draft = cases.draft(LIBRARY, gap)
            if draft["retrieved"]:
                break
        self.assertIsNone(onetwo.retrieve(gap)["case"])
        with tempfile.TemporaryDirectory() as folder:
            files = onetwo._native._files(LIBRARY) | {"corner/new": draft["text"]}
            cases.write(Path(folder, "four-legged"), files)
            grown = onetwo.Library(directory=Path(folder, "four-legged"))
            self.assertEqual(grown.retrieve(gap)["case"], "corner/new")

    def test_learning_is_the_programs(self):
        with tempfile.TemporaryDirectory() as folder:
            arguments = [PROGRAM, "cases", "learn", "--budget", "300", "--only", "scopes", "--dry-run", "--out", folder, "--json"]
            printed = json.loads(subprocess.run(arguments, capture_output=True, text=True, check=True).stdout)
        report, files = cases.learn(LIBRARY, budget=300, only=["scopes"], dry_run=True)
        self.assertEqual(report, printed)
        self.assertEqual(files, onetwo._native._files(LIBRARY))


if __name__ == "__main__":
    unittest.main()
