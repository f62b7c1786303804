"""Answers of the package against those of the built program: the same inputs, compared as whole objects.

ONETWO names the program; `cargo xtask test --only python` builds it and runs these tests.
"""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import onetwo

PROGRAM = os.environ["ONETWO"]
LIBRARIES = Path(__file__).parents[3] / "casebase/library/cases"
GOOD = {"ball": [-600, 10], "defending": "yellow", "teammates": {"1": [-700, 0], "3": [200, 800]}, "opponents": [[-150, 40]]}
SITUATIONS = [
    GOOD,
    {**GOOD, "ball": [1200, -300], "teammates": {1: [1000, -300], 2: [1500, 700]}},
    {**GOOD, "defending": "cyan", "opponents": []},
    {"ball": [2000, 900], "defending": "yellow", "teammates": {"4": [1800, 900]}, "opponents": [[2300, 0], [2500, 200]]},
    {**GOOD, "teammates": {}},
]
MALFORMED = [
    {**GOOD, "ball": [1.5, 2]},
    {**GOOD, "ball": [1]},
    {**GOOD, "defending": "left"},
    {**GOOD, "teammates": {"16": [0, 0]}},
    {**GOOD, "teammates": {str(robot): [robot, 0] for robot in range(12)}},
    {**GOOD, "stray": 1},
    {"ball": [0, 0]},
    [],
    "{",
]


def program(*arguments, lines="", fails=False):
    """What the program prints on its standard output, or on its standard error where it must fail."""
    run = subprocess.run([PROGRAM, *arguments], input=lines, capture_output=True, text=True, check=False)
    assert (run.returncode != 0) == fails, (arguments, run.returncode, run.stderr)
    return run.stderr if fails else run.stdout


def text(problem):
    return problem if isinstance(problem, str) else json.dumps(problem)


def asked(verb, problems, *flags):
    """The program's answers to problems."""
    lines = "".join(text(problem) + "\n" for problem in problems)
    return [json.loads(line) for line in program("cases", verb, *flags, lines=lines).splitlines()]


class Answers(unittest.TestCase):
    def test_retrieve_answers_as_the_program(self):
        expected = asked("retrieve", SITUATIONS)
        self.assertEqual([onetwo.retrieve(problem) for problem in SITUATIONS], expected)
        self.assertTrue(any(answer["case"] for answer in expected) and any(not answer["case"] for answer in expected))

    def test_explain_answers_as_the_program(self):
        expected = asked("explain", SITUATIONS, "--json")
        self.assertEqual([onetwo.explain(problem) for problem in SITUATIONS], expected)
        self.assertGreater(len(expected[0]["cases"]), 10)

    def test_settings_and_leagues_are_those_of_the_flags(self):
        flags = ("--league", "division-b", "--set", "thr_c=1200", "--set", "free_path=fuzzy")
        settings = {"thr_c": 1200, "free_path": "fuzzy"}
        library = onetwo.Library("division-b")
        for verb, ask, more in (("retrieve", library.retrieve, ()), ("explain", library.explain, ("--json",))):
            expected = asked(verb, SITUATIONS, *flags, *more)
            self.assertEqual([ask(problem, settings=settings) for problem in SITUATIONS], expected)
            self.assertEqual(expected[0]["settings"]["thr_c"], "1200")

    def test_a_directory_is_read_as_the_program_reads_it(self):
        directory = LIBRARIES / "four-legged"
        library = onetwo.Library(directory=directory)
        expected = asked("retrieve", SITUATIONS, "--library", str(directory))
        self.assertEqual([onetwo.retrieve(problem, library=library) for problem in SITUATIONS], expected)
        self.assertEqual(len(library), 4 * len(library.names))
        self.assertEqual(library.names, onetwo.Library().names)

    def test_a_malformed_problem_is_refused_in_the_programs_words(self):
        expected = asked("retrieve", MALFORMED)
        for number, (problem, answer) in enumerate(zip(MALFORMED, expected, strict=True), 1):
            for ask in (onetwo.retrieve, onetwo.explain):
                with self.assertRaises(ValueError) as caught:
                    ask(problem)
                self.assertEqual(f"line {number}: {caught.exception}", answer["error"])

    def test_what_names_no_library_or_setting_is_refused_in_the_programs_words(self):
        def refusal(ask):
            with self.assertRaises(ValueError) as caught:
                ask()
            return str(caught.exception)

        retrieve = ("cases", "retrieve")
        self.assertEqual(
            f"error: {refusal(lambda: onetwo.Library('five-legged'))}\n",
            program(*retrieve, "--league", "five-legged", fails=True),
        )
        for setting in ("thr_c=-1", "nonsense=1"):
            name, value = setting.split("=")
            self.assertEqual(
                f"error: --set {refusal(lambda: onetwo.retrieve(GOOD, settings={name: value}))}\n",
                program(*retrieve, "--set", setting, fails=True),
            )
        with tempfile.TemporaryDirectory() as empty:
            for directory in (Path(empty) / "none", Path(empty)):
                self.assertEqual(
                    f"error: {refusal(lambda: onetwo.Library(directory=directory))}\n",
                    program(*retrieve, "--library", str(directory), fails=True),
                )


class Numbers(unittest.TestCase):
    def test_a_situation_may_hold_numpys_numbers_and_no_others(self):
        expected = onetwo.retrieve({"ball": [-600, 10], "defending": "yellow", "teammates": {"1": [-700, 0]}, "opponents": []})
        for ball in (np.array([-600, 10]), [np.int64(-600), np.int16(10)], (-600, 10), np.array([-600, 10], ">i4")):
            problem = {"ball": ball, "defending": "yellow", "teammates": {np.int64(1): np.array([-700, 0])}, "opponents": []}
            self.assertEqual(onetwo.retrieve(problem), expected)
        good = {"ball": [-600, 10], "defending": "yellow", "teammates": {1: [-700, 0]}, "opponents": []}
        endless = []
        endless.append(endless)
        for key, value in (
            ("ball", [float("nan"), 0]),
            ("ball", np.array([np.inf, 0.0])),
            ("ball", object()),
            ("ball", {1, 2}),
            ("ball", b"xy"),
            ("teammates", {(1, 2): [0, 0]}),
            ("opponents", endless),
            ("defending", 3),
        ):
            for ask in (onetwo.retrieve, onetwo.explain):
                with self.subTest(key), self.assertRaisesRegex(ValueError, key):
                    ask({**good, key: value})
        for call in (
            lambda: onetwo.retrieve(good, settings=[1]),
            lambda: onetwo.retrieve(good, settings={"thr_c": None}),
            lambda: onetwo.retrieve(good, library="four-legged"),
            lambda: onetwo.Library(5),
            lambda: onetwo.Library(directory=5),
            lambda: onetwo.trial(seed=-1),
            lambda: onetwo.trial(robots=2**70),
            lambda: onetwo.trial(scenario=1),
            lambda: onetwo.trial(symmetry="no"),
            lambda: onetwo.trial(loss="none"),
        ):
            with self.assertRaises(ValueError):
                call()


class Trials(unittest.TestCase):
    def test_a_trial_is_the_programs(self):
        for arguments, flags in (
            ({}, ""),
            ({"scenario": "1", "opponents": "2d", "seed": 7}, "--scenario 1 --opponents 2d --seed 7"),
            ({"approach": "reactive", "scenario": "random"}, "--approach reactive --scenario random"),
            ({"profile": "robots", "seed": 2**64 - 1}, f"--profile robots --seed {2**64 - 1}"),
            (
                {"robots": 3, "retrievers": 1, "positioning": "independent", "loss": 0.25, "settings": {"thr_c": 1200}},
                "--robots 3 --retrievers 1 --positioning independent --loss 0.25 --set thr_c=1200",
            ),
            ({"symmetry": False, "case_opponents": False}, "--no-symmetry --no-opponents"),
        ):
            with self.subTest(flags):
                expected = json.loads(program("trial", "--json", *flags.split()))
                self.assertEqual(onetwo.trial(**arguments), expected)

    def test_bad_arguments_are_refused(self):
        for arguments, words in (
            ({"scenario": "5"}, "take 1, 2, 3, 4 or random"),
            ({"opponents": "3d"}, "take dg or 2d"),
            ({"approach": "none"}, "take cbr"),
            ({"profile": "none"}, "take simulated or robots"),
            ({"positioning": "none"}, "take dependent or independent"),
            ({"robots": 5}, "take a number from 1 to 4"),
            ({"loss": 1.5}, "take a share from 0 to 1"),
            ({"loss": float("nan")}, "take a share from 0 to 1"),
            ({"settings": {"thr_c": "x"}}, "thr_c=x"),
            ({"library": onetwo.Library("division-b")}, "cannot be played"),
        ):
            with self.subTest(arguments), self.assertRaisesRegex(ValueError, words):
                onetwo.trial(**arguments)


if __name__ == "__main__":
    unittest.main()
