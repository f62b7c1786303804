"""Pictures: what is drawn, every render mode of every task, and a video by Gymnasium's own wrapper."""

import copy
import os
import pickle
import tempfile
import unittest
import warnings
from pathlib import Path

import gymnasium
import numpy as np
from gymnasium.utils.env_checker import check_env
from gymnasium.wrappers import RecordVideo
from moviepy import VideoFileClip

import onetwo
import onetwo.env
from onetwo.parallel import TaskParallelEnv

# A window without a screen.
os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
MODES = ["ansi", "rgb_array", "human"]
BLUE = (0x00, 0x72, 0xB2)
GREY = (0x55, 0x55, 0x55)
BALL = (0xE6, 0x9F, 0x00)


def drawn(simulator, width=960):
    """The picture, and the function from a place on the field, m, to its pixel."""
    rgb, width, height = simulator.pixels(width)
    picture = np.frombuffer(rgb, np.uint8).reshape(height, width, 3)
    return picture, lambda x, y: tuple(picture[round(height * (0.5 - y / 6.6)), round(width * (0.5 + x / 9.6))].tolist())


class Pictures(unittest.TestCase):
    def test_ball_and_robots_are_drawn_where_they_are(self):
        simulator = onetwo.Simulator(2, 1, agents=1, seed=1)
        simulator.place_ball(1.0, 2.0)
        simulator.place_robot(0, -2.0, 1.0)
        simulator.place_robot(1, -3.0, -1.0)
        simulator.place_robot(0, 3.0, -2.0, opponent=True)
        picture, at = drawn(simulator)
        self.assertEqual(picture.shape, (660, 960, 3))
        self.assertEqual(at(1.0, 2.0), BALL)
        self.assertEqual([at(-2.0, 1.0), at(-3.0, -1.0)], [BLUE, BLUE])
        self.assertEqual(at(3.0, -2.0), GREY)
        # The caller's robot has a black frame behind, and every robot a white front.
        black = [max(at(x - 0.09, y)) < 60 for x, y in ((-2.0, 1.0), (-3.0, -1.0))]
        self.assertEqual(black, [True, False])
        self.assertGreater(min(at(-2.0 + 0.073, 1.0)), 230)
        small, at = drawn(simulator, 101)
        self.assertEqual(small.shape, (68, 100, 3))
        self.assertIn('width="720"', simulator._repr_svg_())
        self.assertIn("<svg", simulator.svg())

    def test_every_task_renders_in_every_mode(self):
        for name in onetwo.env.TASKS:
            for mode in MODES:
                with self.subTest(name, mode=mode), warnings.catch_warnings():
                    warnings.simplefilter("error")
                    warnings.filterwarnings("ignore", category=DeprecationWarning)
                    env = gymnasium.make(name, render_mode=mode, width=200)
                    rates = {"Side": 33, "Scenario": 25}
                    rate = next((rate for part, rate in rates.items() if part in name), 40)
                    self.assertEqual(env.metadata["render_fps"], rate)
                    if mode == "ansi":
                        # The checker renders in the other modes too.
                        check_env(gymnasium.make(name, width=200).unwrapped)
                    env.reset(seed=1)
                    before = env.render()
                    for _ in range(12):
                        env.step(env.action_space.sample())
                    after = env.render()
                    if mode == "human":
                        self.assertIsNone(after)
                    elif mode == "ansi":
                        self.assertNotEqual(before, after)
                    else:
                        self.assertEqual((after.dtype, after.shape), (np.uint8, (140 if "Scenario" in name else 138, 200, 3)))
                        self.assertTrue((before != after).any())
                    env.close()
                    parallel = TaskParallelEnv(task=onetwo.env.TASKS[name], render_mode=mode, width=200)
                    parallel.reset(seed=1)
                    self.assertEqual(parallel.render() is None, mode == "human")
                    parallel.close()

    def test_a_copy_has_a_window_of_its_own(self):
        env = onetwo.env.TaskEnv(render_mode="human", width=200)
        env.reset(seed=1)
        for other in (copy.deepcopy(env), pickle.loads(pickle.dumps(env))):
            np.testing.assert_array_equal(other.step(np.ones(5))[0], copy.deepcopy(env).step(np.ones(5))[0])
        env.close()

    def test_a_vector_renders_each_episode(self):
        envs = onetwo.env.TaskVectorEnv(3, task="keep-away", render_mode="rgb_array", width=200)
        envs.reset(seed=1)
        single = onetwo.env.TaskEnv(task="keep-away", render_mode="rgb_array", width=200)
        single.reset(seed=2)
        frames = envs.render()
        self.assertEqual(len(frames), 3)
        np.testing.assert_array_equal(frames[1], single.render())

    def test_gymnasiums_wrapper_records_a_video_that_opens(self):
        with tempfile.TemporaryDirectory() as folder:
            env = gymnasium.make("onetwo/ShootAtKeeper-v0", render_mode="rgb_array", width=320)
            env = RecordVideo(env, folder, disable_logger=True)
            env.reset(seed=1)
            steps, over = 0, False
            while not over:
                _, _, terminated, truncated, _ = env.step(np.array([0.3, 0, 0, 0.9, 0], np.float32))
                steps, over = steps + 1, terminated or truncated
            env.close()
            [file] = Path(folder).glob("*.mp4")
            with VideoFileClip(str(file)) as video:
                self.assertEqual(video.size, [320, 220])
                self.assertEqual(video.fps, 40)
                self.assertAlmostEqual(video.duration, (steps + 1) / 40, delta=0.05)
                self.assertGreater(int(video.get_frame(0).std()), 5)

    def test_bad_values_are_refused_by_name(self):
        simulator = onetwo.Simulator()
        vector = onetwo.VectorSimulator(simulator, 2, 1)
        for name, call in (
            ("width 10", lambda: simulator.pixels(10)),
            ("width -1", lambda: simulator.svg(-1)),
            ("width 9999", lambda: onetwo.env.TaskEnv(render_mode="human", width=9999)),
            ("width", lambda: onetwo.env.TaskVectorEnv(2, render_mode="rgb_array", width="wide")),
            ("index 2", lambda: vector.pixels(2, 100)),
            ("render_mode 'film'", lambda: onetwo.env.TaskEnv(render_mode="film")),
            ("render_mode 'human'", lambda: onetwo.env.TaskVectorEnv(2, render_mode="human")),
            ("render_mode", lambda: onetwo.env.TaskVectorEnv(2).render()),
            ("render_mode", lambda: onetwo.env.TaskEnv().render()),
        ):
            with self.subTest(name), self.assertRaisesRegex(ValueError, name):
                call()


if __name__ == "__main__":
    unittest.main()
