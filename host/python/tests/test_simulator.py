"""The simulator and its Gymnasium environment: what they promise of spaces, seeds, tasks and bad input."""

import copy
import math
import pickle
import subprocess
import sys
import unittest
import warnings
from array import array

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env

import onetwo
import onetwo.env

STAND = [0.0] * 5


def played(simulator, seed, steps=80):
    """The trace of an episode of drawn actions."""
    simulator.reset(seed)
    draw = np.random.default_rng(seed)
    for _ in range(steps):
        simulator.step(draw.uniform(-1, 1, simulator.action_size).astype(np.float32))
    return simulator.trace_hash


def until_end(simulator, actions):
    """The sum of rewards and how the episode ended."""
    total, end = 0.0, None
    while end is None:
        reward, end = simulator.step(actions)
        total += reward
    return total, end


class Episodes(unittest.TestCase):
    def test_a_seed_and_actions_decide_everything(self):
        first, second = onetwo.Simulator(3, 3), onetwo.Simulator(3, 3, seed=9)
        self.assertEqual(played(first, 4), played(second, 4))
        self.assertEqual(played(first, 4), played(first, 4))
        self.assertNotEqual(played(first, 4), played(first, 5))

    def test_a_kick_scores(self):
        simulator = onetwo.Simulator()
        simulator.place_ball(2.0, 0.0)
        simulator.place_robot(0, 1.9, 0.0)
        total, end = until_end(simulator, [0.5, 0.0, 0.0, 0.8, 0.0])
        self.assertEqual(end, "goal")
        self.assertGreater(simulator.state()["ball"]["position"][0], 4.5)
        # 10 for the goal, and 2.5 m nearer to its middle, less the way that the ball ran ahead of the robot.
        self.assertTrue(11.0 < total < 12.6, total)
        self.assertLess(simulator.time_s, 2.0)

    def test_an_own_goal_a_ball_off_the_field_and_time_end_it(self):
        simulator = onetwo.Simulator(time_limit_s=1.0)
        for (x, y, vx, vy), expected in (
            ((-4.0, 0.0, -3.0, 0.0), "own_goal"),
            ((0.0, 2.5, 0.0, 4.0), "out"),
            ((4.0, 2.0, 4.0, 0.0), "out"),
            ((0.0, 0.0, 0.0, 0.0), "time"),
        ):
            simulator.reset(1)
            simulator.place_robot(0, -2.0, -2.0)
            simulator.place_ball(x, y, vx, vy)
            total, end = until_end(simulator, STAND)
            self.assertEqual(end, expected)
            self.assertEqual(end == "own_goal", total < -5.0)
            self.assertEqual(simulator.step(STAND), (0.0, end))
        self.assertAlmostEqual(simulator.time_s, 1.0)

    def test_actions_move_the_robot_as_they_say(self):
        simulator = onetwo.Simulator(1, 1)
        for action, (dx, dy, turned) in (
            ([0.2, 0, 0, 0, 0], (1, 0, 0)),
            ([0, 0.2, 0, 0, 0], (0, 1, 0)),
            ([0, 0, 0.2, 0, 0], (0, 0, 1)),
            ([-0.2, 0, 0, 0, 0], (-1, 0, 0)),
        ):
            simulator.reset(1)
            simulator.place_ball(0, -2)
            simulator.place_robot(0, 0, 0)
            simulator.place_robot(0, 1, 2, math.pi, opponent=True)
            for _ in range(4):
                simulator.step(action, [0, 0, 0, 0, 0])
            robot = simulator.state()["own"][0]
            x, y = robot["position"]
            for value, sign in ((x, dx), (y, dy), (robot["heading"], turned)):
                self.assertGreater(value * sign, 0.01) if sign else self.assertLess(abs(value), 0.01)
        # Orders for opponents reach them; without any they stand.
        other = simulator.state()["opponents"][0]
        self.assertEqual(other["position"], (1.0, 2.0))
        for _ in range(4):
            simulator.step(STAND, [1, 0, 0, 0, 0])
        self.assertLess(simulator.state()["opponents"][0]["position"][0], 0.99)

    def test_an_observation_is_the_state_in_its_scales(self):
        simulator = onetwo.Simulator(2, 1, seed=3)
        for _ in range(20):
            simulator.step([1.0, 0.5, 0.2, 0.0, 1.0] * 2)
        observation = array("f", bytes(4 * simulator.observation_size))
        simulator.observe(observation)
        state, expected = simulator.state(), []
        # Division B: 9 x 6 m and 0.3 m to the boards.
        x_scale, y_scale = 4.5 + 0.3, 3.0 + 0.3
        ball = state["ball"]
        expected += [ball["position"][0] / x_scale, ball["position"][1] / y_scale, ball["position"][2]]
        expected += [speed / 8.0 for speed in ball["velocity"][:2]]
        for robot in state["own"] + state["opponents"]:
            expected += [robot["position"][0] / x_scale, robot["position"][1] / y_scale]
            expected += [math.sin(robot["heading"]), math.cos(robot["heading"])]
            expected += [speed / 3.5 for speed in robot["velocity"]]
            expected += [robot["turning"] / 15.0, float(robot["ball_contact"])]
        self.assertEqual(len(expected), simulator.observation_size)
        np.testing.assert_allclose(observation, np.clip(expected, -1, 1), atol=1e-6)

    def test_bad_input_is_refused(self):
        simulator = onetwo.Simulator(2, 1)
        before = simulator.trace_hash
        for act, words in (
            (lambda: simulator.step([0.0] * 9), "expected 10 numbers"),
            (lambda: simulator.step(np.zeros(11, np.float32)), "expected 10 numbers"),
            (lambda: simulator.step("ten"), "expected 10 numbers"),
            (lambda: simulator.step([math.nan] * 10), "number 0 is NaN"),
            (lambda: simulator.step([0.0] * 10, [0.0] * 10), "opponent_actions: expected 5"),
            (lambda: simulator.observe(np.zeros(29, np.float64)), "buffer of 29 float32"),
            (lambda: simulator.observe(np.zeros(28, np.float32)), "buffer of 29 float32"),
            (lambda: simulator.observe(bytes(29 * 4)), "buffer of 29 float32"),
            (lambda: simulator.place_robot(2, 0, 0), "has 2 robots"),
            (lambda: simulator.place_ball(math.inf, 0), "finite"),
            (lambda: onetwo.Simulator(0), "1 to 11"),
            (lambda: onetwo.Simulator(1, 12), "at most 11"),
            (lambda: onetwo.Simulator(period_ms=0), "1 to 100 ms"),
            (lambda: onetwo.Simulator(time_limit_s=math.nan), "more than 0 s"),
            (lambda: onetwo.Simulator(league="four-legged"), "take division-b"),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                act()
        self.assertEqual(simulator.trace_hash, before)


class Environment(unittest.TestCase):
    def test_gymnasiums_own_checker_passes(self):
        for own, opponents in ((1, 0), (3, 3), (11, 11)):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                warnings.filterwarnings("ignore", message=".*not having a.*spec|.*render modes.*|.*close.*")
                check_env(gymnasium.make("onetwo/Score-v0", own=own, opponents=opponents).unwrapped)

    def test_the_checker_sees_a_fault(self):
        class Faulty(onetwo.env.ScoreEnv):
            def reset(self, *, seed=None, options=None):
                return super().reset(seed=None, options=options)

        with self.assertRaises(AssertionError):
            check_env(Faulty())

    def test_a_seed_repeats_every_episode_after_it(self):
        def traces(env, seed):
            found = []
            env.action_space.seed(seed)
            env.reset(seed=seed)
            for _ in range(3):
                ended = False
                while not ended:
                    observation, _, terminated, truncated, _ = env.step(env.action_space.sample())
                    self.assertTrue(env.observation_space.contains(observation))
                    ended = terminated or truncated
                found.append(env.unwrapped.simulator.trace_hash)
                env.reset()
            return found

        env = gymnasium.make("onetwo/Score-v0", own=2, opponents=1, time_limit_s=2.0)
        first = traces(env, 3)
        self.assertEqual(first, traces(gymnasium.make("onetwo/Score-v0", own=2, opponents=1, time_limit_s=2.0), 3))
        self.assertNotEqual(first, traces(env, 4))
        self.assertEqual(len(set(first)), 3)

    def test_truncation_and_termination_are_told_apart(self):
        env = onetwo.env.ScoreEnv(time_limit_s=0.05)
        env.reset(seed=1)
        stand = np.zeros(5, np.float32)
        self.assertEqual(env.step(stand)[2:4], (False, False))
        _, _, terminated, truncated, info = env.step(stand)
        self.assertEqual((terminated, truncated, info["end"]), (False, True, "time"))
        env.reset(seed=1)
        env.simulator.place_ball(4.45, 2.0, 7.0, 0.0)
        _, _, terminated, truncated, info = env.step(stand)
        self.assertEqual((terminated, truncated, info["end"]), (True, False, "out"))

    def test_the_package_alone_needs_neither_gymnasium_nor_numpy(self):
        code = "import sys, onetwo; onetwo.Simulator().step([0.0] * 5); print({'numpy', 'gymnasium'} & set(sys.modules))"
        printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        self.assertEqual(printed.strip(), "set()")


class Edges(unittest.TestCase):
    def test_a_copy_and_a_pickle_go_on_bit_for_bit(self):
        simulator = onetwo.Simulator(2, 1, seed=3)
        played(simulator, 3, 20)
        simulator.place_ball(1.0, 0.5, 2.0, -1.0)
        simulator.place_robot(0, -1.0, 0.25, 1.0, opponent=True)
        for other in (copy.copy(simulator), copy.deepcopy(simulator), pickle.loads(pickle.dumps(simulator))):
            self.assertEqual(other.trace_hash, simulator.trace_hash)
            there = copy.deepcopy(simulator)
            for one in (there, other):
                for _ in range(30):
                    one.step([0.5, 0.1, -0.2, 1.0, 0.0] * 2, STAND)
            self.assertEqual((other.trace_hash, other.state()), (there.trace_hash, there.state()))
        env = onetwo.env.ScoreEnv(opponents=1)
        env.reset(seed=5)
        twin = pickle.loads(pickle.dumps(copy.deepcopy(env)))
        action = env.action_space.sample()
        self.assertEqual(env.step(action)[1], twin.step(action)[1])
        library = onetwo.Library("division-b")
        for other in (copy.deepcopy(library), pickle.loads(pickle.dumps(library))):
            self.assertEqual(other.names, library.names)

    def test_every_bad_value_is_a_value_error_with_its_name(self):
        simulator = onetwo.Simulator(2)
        big = 10**400
        for name, call in (
            ("own", lambda: onetwo.Simulator(own=-1)),
            ("own", lambda: onetwo.Simulator(own="3")),
            ("own", lambda: onetwo.Simulator(own=1.5)),
            ("own", lambda: onetwo.Simulator(own=b"1")),
            ("opponents", lambda: onetwo.Simulator(opponents=big)),
            ("period_ms", lambda: onetwo.Simulator(period_ms=2**32)),
            ("time_limit_s", lambda: onetwo.Simulator(time_limit_s="long")),
            ("time_limit_s", lambda: onetwo.Simulator(time_limit_s=math.nan)),
            ("time_limit_s", lambda: onetwo.Simulator(time_limit_s=big)),
            ("league", lambda: onetwo.Simulator(league=5)),
            ("seed", lambda: onetwo.Simulator(seed=np.int64(-1))),
            ("seed", lambda: simulator.reset(2**64)),
            ("seed", lambda: simulator.reset(1.0)),
            ("index", lambda: simulator.place_robot(-1, 0, 0)),
            ("heading", lambda: simulator.place_robot(0, 0, 0, math.inf)),
            ("opponent", lambda: simulator.place_robot(0, 0, 0, opponent="yes")),
            ("x", lambda: simulator.place_ball(1e300, 0)),
            ("vy", lambda: simulator.place_ball(0, 0, 0, np.float64("nan"))),
            ("actions", lambda: simulator.step("stand")),
            ("actions", lambda: simulator.step(np.zeros(9, ">f4"))),
            ("actions", lambda: simulator.step(np.full(10, np.nan))),
            ("opponent_actions", lambda: simulator.step([0.0] * 10, [0.0] * 5)),
            ("into", lambda: simulator.observe(np.zeros(21, ">f4"))),
            ("into", lambda: simulator.observe(np.zeros(21, np.float64))),
            ("render", lambda: onetwo.env.ScoreEnv().render()),
            ("render_mode", lambda: onetwo.env.ScoreEnv(render_mode="film")),
        ):
            with self.subTest(name), self.assertRaisesRegex(ValueError, name):
                call()

    def test_numbers_of_numpy_are_numbers(self):
        simulator = onetwo.Simulator(np.int8(1), np.uint64(1), period_ms=np.int32(20), time_limit_s=np.float32(3), seed=np.uint64(7))
        simulator.place_robot(np.int16(0), np.float32(0.5), np.int64(1), np.float16(0))
        orders = [0.25, -0.5, 0.75, 0.0, 1.0]
        hashes = set()
        for kind in ("<f4", ">f4", ">f8", np.float16):
            one = copy.deepcopy(simulator)
            one.step(np.array(orders, kind))
            hashes.add(one.trace_hash)
        self.assertEqual(len(hashes), 1)

    def test_the_environment_is_found_by_module_and_name_and_renders_a_line(self):
        code = "import gymnasium; print(gymnasium.make('onetwo.env:onetwo/Score-v0').unwrapped.metadata['render_modes'])"
        printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
        self.assertEqual(printed.strip(), "['ansi', 'rgb_array', 'human']")
        env = gymnasium.make("onetwo/Score-v0", opponents=1, render_mode="ansi")
        env.reset(seed=1)
        line = env.render()
        self.assertRegex(line, r"^0\.00 s; ball \(.*\); own 0 \(.*\); opponents 0 \(.*\)$")


if __name__ == "__main__":
    unittest.main()
