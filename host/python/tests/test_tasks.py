"""Tasks, saved states, the vector environment and PettingZoo's API: what they promise, over every task."""

import copy
import json
import math
import os
import pickle
import subprocess
import sys
import unittest
import warnings

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from pettingzoo.test import parallel_api_test, parallel_seed_test

import onetwo
import onetwo.env
from onetwo.parallel import TaskParallelEnv

# Gymnasium's checker renders in every mode: a window without a screen.
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
TASKS = list(onetwo.env.TASKS.values())
MATCHES = ["3v3", "6v6"]
SINGLE = [task for task in TASKS if task not in MATCHES]
TRIALS = [task for task in TASKS if task.startswith("scenario")]
OTHERS = ["none", "scripted", "coach", "reactive", "marking", "zone"]


def play(simulator, steps, seed=0):
    """Drawn actions; what came of them."""
    draw = np.random.default_rng(seed)
    return [simulator.step(draw.uniform(-1, 1, simulator.action_size).astype(np.float32)) for _ in range(steps)]


def modes(task):
    """Settings in which a task is tried: the true state, another world, what a host estimates."""
    return [{}] if task in TRIALS else [{}, {"world": "random"}, {"observation": "sensed"}]


def observed(simulator):
    """The observation as a list."""
    into = np.zeros(simulator.observation_size, np.float32)
    simulator.observe(into)
    return into.tolist()


def ended(simulator, action):
    """The sum of rewards and the end, with this action or what it returns for a state."""
    total, end = 0.0, None
    while end is None:
        reward, end = simulator.step(action(simulator.state()) if callable(action) else action)
        total += reward
    return total, end


def chase(state, robot):
    """Orders that drive a robot to the ball and hold it."""
    me, ball = state["own"][robot], state["ball"]["position"]
    dx, dy, heading = ball[0] - me["position"][0], ball[1] - me["position"][1], me["heading"]
    turn = math.remainder(math.atan2(dy, dx) - heading, 2 * math.pi)
    forward, left = dx * math.cos(heading) + dy * math.sin(heading), dy * math.cos(heading) - dx * math.sin(heading)
    return [float(np.clip(value, -0.4, 0.4)) for value in (forward, left, turn / 2)] + [0.0, 1.0]


class States(unittest.TestCase):
    def test_every_copy_of_every_task_goes_on_bit_for_bit(self):
        for task in TASKS:
            for mode in modes(task):
                with self.subTest(task=task, **mode):
                    simulator = onetwo.Simulator(task=task, seed=7, **mode)
                    play(simulator, 15)
                    if task not in TRIALS:
                        simulator.place_ball(0.5, 0.25, 1.0, -0.5)
                    play(simulator, 5, 1)
                    other = onetwo.Simulator(task=task, **mode)
                    other.restore(simulator.save())
                    copies = [other, copy.deepcopy(simulator), pickle.loads(pickle.dumps(simulator))]
                    expected = play(simulator, 20, 2), simulator.state(), observed(simulator), simulator.trace_hash
                    for one in copies:
                        self.assertEqual((play(one, 20, 2), one.state(), observed(one), one.trace_hash), expected)

    def test_a_state_goes_on_in_another_process(self):
        code = (
            "import json, sys, onetwo; s = onetwo.Simulator(task=sys.argv[1], world='random:3');"
            "s.restore(bytes.fromhex(sys.argv[2]));"
            "print(json.dumps([[s.step([0.4, -0.1, 0.2, 1.0, 0.5] * (s.action_size // 5)) for _ in range(20)], s.trace_hash]))"
        )
        for task in ("keep-away", "3v3"):
            simulator = onetwo.Simulator(task=task, world="random:3", seed=2)
            play(simulator, 10)
            arguments = [sys.executable, "-c", code, task, simulator.save().hex()]
            printed = json.loads(subprocess.run(arguments, capture_output=True, text=True, check=True).stdout)
            action = [0.4, -0.1, 0.2, 1.0, 0.5] * (simulator.action_size // 5)
            found = [list(simulator.step(action)) for _ in range(20)]
            self.assertEqual(printed, [found, simulator.trace_hash])

    def test_environments_keep_their_random_generators(self):
        action = np.full(5, 0.3, np.float32)
        env = onetwo.env.TaskEnv(task="shoot-at-keeper")
        env.reset(seed=3)
        env.step(action)
        other = onetwo.env.TaskEnv(task="shoot-at-keeper")
        other.restore(env.save())
        for one in (other, copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
            going = copy.deepcopy(env)
            np.testing.assert_array_equal(going.step(action)[0], one.step(action)[0])
            np.testing.assert_array_equal(going.reset()[0], one.reset()[0])

    def test_foreign_and_damaged_bytes_are_refused(self):
        simulator = onetwo.Simulator(task="keep-away", seed=1)
        state = simulator.save()
        before = simulator.trace_hash
        damaged = bytearray(state)
        damaged[len(state) // 2] ^= 1
        version = bytearray(state)
        version[12] += 1
        for words, bad in (
            ("no saved state", b""),
            ("no saved state", b"onetwo"),
            ("no saved state", bytes(200)),
            ("no saved state", pickle.dumps(3)),
            ("take the bytes", "text"),
            ("damaged", state[:-1]),
            ("damaged", state + b"x"),
            ("damaged", bytes(damaged)),
            ("version 3 of the format", bytes(version)),
            ("this one has", onetwo.Simulator(task="score").save()),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                simulator.restore(bad)
        self.assertEqual(simulator.trace_hash, before)
        env = onetwo.env.TaskEnv(task="keep-away")
        for words, bad in (
            ("no saved environment", state),
            ("no saved environment", None),
            ("damaged", env.save()[:30]),
            ("random generators", onetwo.env.TaskVectorEnv(2, task="keep-away").save()),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                env.restore(bad)


class Tasks(unittest.TestCase):
    def test_gymnasiums_checker_passes_for_every_task_and_driver(self):
        made = [(name, mode) for name, task in onetwo.env.TASKS.items() for mode in modes(task)]
        made += [("onetwo/Scenario3-v0", {"own": 4, "agents": 1, "teammates_by": "coach", "opponents_by": "two-defenders"})]
        made += [("onetwo/ShootAtKeeper-v0", {"opponents_by": by}) for by in OTHERS]
        made += [("onetwo/ThreeASide-v0", {"agents": 1, "teammates_by": "coach", "world": "random"})]
        for name, settings in made:
            with self.subTest(name, **settings), warnings.catch_warnings():
                warnings.simplefilter("error")
                warnings.filterwarnings("ignore", message=".*not having a.*spec|.*render modes.*|.*close.*")
                check_env(gymnasium.make(name, **settings).unwrapped)

    def test_drawn_actions_stay_within_the_spaces(self):
        for task, mode in [(task, mode) for task in TASKS for mode in modes(task)]:
            env = onetwo.env.TaskEnv(task=task, **mode)
            env.action_space.seed(1)
            observation, _ = env.reset(seed=1)
            for _ in range(100 if task in MATCHES else 2000):
                self.assertTrue(env.observation_space.contains(observation), task)
                observation, reward, terminated, truncated, _ = env.step(env.action_space.sample())
                self.assertTrue(math.isfinite(reward))
                if terminated or truncated:
                    observation, _ = env.reset()

    def test_a_shot_at_the_keeper_scores_or_is_saved(self):
        simulator = onetwo.Simulator(task="shoot-at-keeper")
        ends = set()
        for seed in range(30):
            simulator.reset(seed)
            total, end = ended(simulator, [0.3, 0.0, 0.0, 0.9, 0.0])
            ends.add(end)
            self.assertEqual(end == "goal", total > 9.0, (end, total))
        self.assertLessEqual({"goal", "lost"}, ends)

    def test_a_pass_counts_once_it_has_travelled(self):
        simulator = onetwo.Simulator(task="pass-and-receive", seed=1)
        for distance, expected in ((2.0, "received"), (0.6, "time")):
            simulator.reset(1)
            simulator.place_ball(0.0, 0.0)
            simulator.place_robot(0, -0.12, 0.0)
            simulator.place_robot(1, distance, 0.0, math.pi)
            receive = [0.0, 0.0, 0.0, 0.0, 1.0]
            kick = [0.2, 0.0, 0.0, 0.3, 0.0]
            total, end = ended(simulator, lambda state: (kick if state["time_s"] < 0.2 else [0.0] * 5) + receive)
            self.assertEqual(end, expected)
            self.assertEqual(end == "received", total > 9.0)

    def test_a_contested_ball_is_won_and_lost(self):
        simulator = onetwo.Simulator(task="contested-ball", seed=1)
        self.assertEqual(ended(simulator, [0.0] * 5)[1], "lost")
        simulator.reset(1)
        simulator.place_robot(0, 3.0, 2.0, opponent=True)
        x, y, _ = simulator.state()["ball"]["position"]
        simulator.place_robot(0, x - 0.2, y)
        self.assertEqual(ended(simulator, lambda state: chase(state, 0))[1], "won")

    def test_the_ball_is_lost_to_a_taker_or_leaves_its_square(self):
        simulator = onetwo.Simulator(task="keep-away", seed=1)
        self.assertEqual(ended(simulator, [0.0] * 15)[1], "lost")
        simulator.reset(1)
        simulator.place_ball(1.9, 0.0, 2.0, 0.0)
        self.assertEqual(ended(simulator, [0.0] * 15)[1], "out")
        alone = onetwo.Simulator(task="keep-away", opponents=0, time_limit_s=2.0)
        total, end = ended(alone, [0.0] * 15)
        self.assertEqual((round(total, 3), end), (2.0, "time"))

    def test_under_the_referee_goals_count_and_the_match_goes_on(self):
        simulator = onetwo.Simulator(task="3v3", opponents_by="none", time_limit_s=30.0, seed=1)
        observation = np.empty(simulator.observation_size, np.float32)
        phases = set()
        # Until the ball is in play, then a shot into the opponents' goal.
        shot = [0.3, 0.0, 0.0, 0.8, 0.0] + [0.0] * 10
        placed = False
        for _ in range(900):
            reward, end = simulator.step(shot if placed else [0.0] * 15, None, observation)
            phases.add((observation[-4], observation[-3]))
            if simulator.state()["in_play"] and not placed:
                placed = True
                simulator.place_ball(2.0, 0.0)
                simulator.place_robot(0, 1.88, 0.0)
                simulator.place_robot(0, 3.0, 2.0, opponent=True)
            if simulator.score == (1, 0):
                self.assertGreater(reward, 9.0)
                break
        self.assertEqual((simulator.score, end), ((1, 0), None))
        self.assertGreater(len(phases), 1)

    def test_our_coach_and_the_reference_teams_play(self):
        for by in OTHERS[2:]:
            simulator = onetwo.Simulator(2, 3, opponents_by=by, agents=1, teammates_by="coach", seed=3)
            start = simulator.state()
            play(simulator, 60)
            state = simulator.state()
            # Robots that stand for good move by less than 1 mm; those of a team take their places.
            for side, robots in (("own", [1]), ("opponents", [0, 1, 2])):
                moved = [math.dist(state[side][n]["position"], start[side][n]["position"]) for n in robots]
                self.assertGreater(max(moved), 0.1, (by, side, moved))

    def test_a_legged_robot_grabs_the_ball_and_kicks_it(self):
        simulator = onetwo.Simulator(1, 0, task="scenario-1", seed=2)
        self.assertEqual((simulator.robots, simulator.period_ms), ((1, 1, 0), 40))
        total, end = ended(simulator, lambda state: chase(state, 0)[:3] + [float(state["own"][0]["ball_contact"]), 1.0])
        before = simulator.state()["ball"]["position"][0]
        self.assertIn(end, ("goal", "close", "out"))
        self.assertGreater(before, 2.6)
        self.assertGreater(total, 2.0)

    def test_trials_are_those_of_the_paper(self):
        for task, opponents, outcomes in (("scenario-4", "scripted", 3), ("scenario-2", "two-defenders", 2)):
            ends = set()
            for seed in range(12):
                simulator = onetwo.Simulator(4, task=task, agents=1, teammates_by="coach", opponents_by=opponents, seed=seed)
                ends.add(ended(simulator, [0.0] * 5)[1])
            self.assertLessEqual(ends, {"goal", "close", "lost", "out", "time"})
            self.assertGreaterEqual(len(ends), outcomes - 1, (task, ends))

    def test_what_is_sensed_follows_the_truth_late_and_with_noise(self):
        truth, sensed = (onetwo.Simulator(2, 2, seed=5, observation=name) for name in ("truth", "sensed"))
        np.testing.assert_array_equal(observed(truth), observed(sensed))
        errors = []
        for _ in range(60):
            for simulator in (truth, sensed):
                simulator.step([0.2, 0.1, 0.1, 0.0, 0.0] * 2)
            errors.append(np.abs(np.array(observed(truth)) - observed(sensed))[:7])
        self.assertEqual(truth.state(), sensed.state())
        self.assertGreater(np.max(errors), 0.0)
        # Places of ball and robot, as shares of half the field's length of 4.8 m: within 5 cm.
        self.assertLess(np.max(np.array(errors)[20:, [0, 1, 5, 6]]), 0.01)

    def test_a_policy_moves_the_others(self):
        seen = []

        def policy(observation):
            seen.append(observation)
            return np.tile(np.array([1.0, 0.0, 0.0, 0.0, 0.0], np.float32), 2)

        env = onetwo.env.TaskEnv(3, 2, agents=1, teammates_by=policy, opponents_by=policy)
        observation, _ = env.reset(seed=1)
        before = env.simulator.state()
        for _ in range(20):
            env.step(np.zeros(5, np.float32))
        after = env.simulator.state()
        moved = [math.dist(a["position"], b["position"]) for a, b in zip(before["own"] + before["opponents"], after["own"] + after["opponents"])]
        self.assertLess(moved[0], 0.01)
        self.assertGreater(min(moved[1:]), 0.1)
        # Both sides see themselves attack +x: a teammate as the agent does, an opponent turned by half a turn.
        teammates, opponents = seen[0], seen[1]
        np.testing.assert_array_equal(teammates[5:13], observation[13:21])
        np.testing.assert_array_equal(opponents[[0, 1]], -observation[[0, 1]])
        np.testing.assert_array_equal(opponents[5:11], -observation[29:35])

    def test_bad_settings_are_value_errors_with_their_names(self):
        for name, call in (
            ("task", lambda: onetwo.Simulator(task="golf")),
            ("agents", lambda: onetwo.Simulator(2, agents=3)),
            ("agents", lambda: onetwo.Simulator(agents=0)),
            ("teammates_by", lambda: onetwo.Simulator(teammates_by="them")),
            ("opponents_by", lambda: onetwo.Simulator(opponents_by=3)),
            ("world", lambda: onetwo.Simulator(world="mars")),
            ("observation", lambda: onetwo.Simulator(observation="guessed")),
            ("observation", lambda: onetwo.Simulator(task="scenario-1", observation="sensed")),
            ("world", lambda: onetwo.Simulator(task="scenario-1", world="random")),
            ("league", lambda: onetwo.Simulator(task="scenario-1", league="division-b")),
            ("league", lambda: onetwo.Simulator(league="four-legged")),
            ("own", lambda: onetwo.Simulator(5, task="scenario-1")),
            ("opponents", lambda: onetwo.Simulator(2, 3, task="scenario-1")),
            ("period_ms", lambda: onetwo.Simulator(task="scenario-1", period_ms=50)),
            ("teammates_by", lambda: onetwo.Simulator(task="scenario-1", teammates_by="zone")),
            ("opponents_by", lambda: onetwo.Simulator(task="scenario-1", opponents_by="coach")),
            ("opponents_by", lambda: onetwo.Simulator(opponents_by="two-defenders")),
            ("opponents_by", lambda: onetwo.env.TaskEnv(task="scenario-1", opponents_by=lambda observation: observation)),
            ("opponents_by", lambda: TaskParallelEnv(task="scenario-1", opponents_by="agents")),
            ("place_ball", lambda: onetwo.Simulator(task="scenario-1").place_ball(0.0, 0.0)),
            ("place_robot", lambda: onetwo.Simulator(task="scenario-1").place_robot(0, 0.0, 0.0)),
            ("own", lambda: onetwo.Simulator(1, task="pass-and-receive")),
            ("period_ms", lambda: onetwo.Simulator(task="3v3", period_ms=25)),
            ("opponent_actions", lambda: onetwo.Simulator(task="contested-ball").step([0.0] * 5, [0.0] * 5)),
            ("opponents_by", lambda: onetwo.env.TaskVectorEnv(2, opponents_by=lambda observation: observation)),
            ("render_mode", lambda: onetwo.env.TaskVectorEnv(2, render_mode="ansi")),
            ("count", lambda: onetwo.env.TaskVectorEnv(0)),
            ("threads", lambda: onetwo.env.TaskVectorEnv(2, threads=-1)),
            ("threads", lambda: onetwo.env.TaskVectorEnv(2, threads=0)),
            ("seed", lambda: onetwo.env.TaskVectorEnv(2).reset(seed=[1])),
            ("actions", lambda: onetwo.env.TaskVectorEnv(2).step(np.zeros((3, 5)))),
            ("no agent", lambda: (env := TaskParallelEnv(), env.reset(), env.step({"own_7": np.zeros(5)}))),
        ):
            with self.subTest(name), self.assertRaisesRegex(ValueError, name):
                call()

    def test_gymnasium_finds_the_tasks_in_either_order_of_imports(self):
        for code in (
            "import gymnasium; gymnasium.make('onetwo:onetwo/Score-v0').reset(seed=1)",
            "import onetwo, gymnasium; gymnasium.make('onetwo/KeepAway-v0').reset(seed=1)",
            "import gymnasium, onetwo; gymnasium.make('onetwo/PassAndReceive-v0').reset(seed=1)",
        ):
            subprocess.run([sys.executable, "-c", code], check=True)


class Vectors(unittest.TestCase):
    def test_a_vector_plays_what_single_environments_play(self):
        tried = [(task, 5, mode) for task in SINGLE for mode in modes(task)[-2:]] + [("3v3", 2, {"world": "random"})]
        for task, count, mode in tried:
            settings = {"task": task, "time_limit_s": 0.6, **mode}
            native = onetwo.env.TaskVectorEnv(count, threads=3, **settings)
            singles = SyncVectorEnv([lambda: onetwo.env.TaskEnv(**settings)] * count)
            self.assertIs(native.metadata["autoreset_mode"], AutoresetMode.NEXT_STEP)
            self.assertEqual(native.observation_space, singles.observation_space)
            self.assertEqual(native.action_space, singles.action_space)
            np.testing.assert_array_equal(native.reset(seed=4)[0], singles.reset(seed=4)[0])
            native.action_space.seed(1)
            finished = 0
            for _ in range(60):
                action = native.action_space.sample()
                found, expected = native.step(action), singles.step(action)
                for one, other in zip(found[:4], expected[:4]):
                    np.testing.assert_array_equal(one, other, task)
                done = found[2] | found[3]
                finished += done.sum()
                if done.any():
                    self.assertEqual(found[4]["end"][done].tolist(), expected[4]["end"][done].tolist())
            self.assertGreater(finished, count)

    def test_copies_of_a_vector_go_on_and_make_vec_makes_one(self):
        vector = gymnasium.make_vec("onetwo/KeepAway-v0", 4, vectorization_mode="vector_entry_point").unwrapped
        self.assertIsInstance(vector, onetwo.env.TaskVectorEnv)
        vector.reset(seed=1)
        vector.action_space.seed(2)
        for _ in range(30):
            vector.step(vector.action_space.sample())
        restored = onetwo.env.TaskVectorEnv(4, task="keep-away")
        restored.restore(vector.save())
        copies = [restored, copy.deepcopy(vector), pickle.loads(pickle.dumps(vector))]
        for _ in range(200):
            action = vector.action_space.sample()
            expected = vector.step(action)
            for one in copies:
                for a, b in zip(one.step(action)[:4], expected[:4]):
                    np.testing.assert_array_equal(a, b)


class Agents(unittest.TestCase):
    def test_pettingzoos_checkers_pass_for_every_task(self):
        for task in TASKS:
            for by in (None,) if task in TRIALS else (None, "agents"):
                cycles = 20 if task in MATCHES else 300
                with self.subTest(task, by=by):
                    parallel_api_test(TaskParallelEnv(task=task, opponents_by=by), num_cycles=cycles)
                    parallel_seed_test(lambda: TaskParallelEnv(task=task, opponents_by=by), num_cycles=cycles)

    def test_agents_see_the_field_from_their_side_and_share_the_reward(self):
        env = TaskParallelEnv(2, 2, opponents_by="agents")
        observations, _ = env.reset(seed=1)
        self.assertEqual(list(observations), ["own_0", "own_1", "opponent_0", "opponent_1"])
        first, second, other = observations["own_0"], observations["own_1"], observations["opponent_1"]
        np.testing.assert_array_equal(first[5:13], second[13:21])
        np.testing.assert_array_equal(first[13:21], second[5:13])
        np.testing.assert_array_equal(other[5:9], -first[29:33])
        forward = {name: np.array([1, 0, 0, 0, 0], np.float32) for name in env.agents}
        before = env.simulator.state()
        _, rewards, terminated, _, infos = env.step(forward)
        self.assertEqual(rewards["own_0"], rewards["own_1"])
        self.assertEqual(rewards["own_0"], -rewards["opponent_0"])
        self.assertFalse(any(terminated.values()))
        self.assertEqual(infos["own_0"]["end"], None)
        after = env.simulator.state()
        for side in ("own", "opponents"):
            for a, b in zip(before[side], after[side]):
                self.assertGreater(math.dist(a["position"], b["position"]), 0.001)

    def test_a_saved_environment_of_agents_goes_on(self):
        env = TaskParallelEnv(task="keep-away", opponents_by="agents")
        env.reset(seed=1)
        action = {name: np.full(5, 0.2, np.float32) for name in env.agents}
        env.step(action)
        other = TaskParallelEnv(task="keep-away", opponents_by="agents")
        other.restore(env.save())
        twin = pickle.loads(pickle.dumps(env))
        found, expected = other.step(action), env.step(action)
        self.assertEqual(found[1:], expected[1:])
        self.assertEqual(twin.step(action)[1:], expected[1:])
        np.testing.assert_array_equal(other.reset()[0]["own_2"], env.reset()[0]["own_2"])


if __name__ == "__main__":
    unittest.main()
