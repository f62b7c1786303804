// put: places to which the viewer dragged ball and robots: drawn there at once, as the host sees it with a later camera frame only,
// and in a paused match with none.

import { on, store } from "./store.js";

/** Seconds of the match until a camera has seen what was put. */
const SEEN = 0.1;

/** What was put, by name: `ball`, `blue 3`. */
const places = new Map();

const nameOf = (robot) => `${robot.team} ${robot.id}`;

/** Notes that a hand puts the robot there, or the ball where there is none. */
export function put(robot, at) {
  places.set(robot ? nameOf(robot) : "ball", { at, t: store.latest?.t ?? 0 });
}

/** The scene with everything where it was put. */
export function placed(scene) {
  if (!scene || places.size === 0) return scene;
  const ball = places.get("ball");
  return {
    ...scene,
    ball: ball && scene.ball ? { ...scene.ball, at: ball.at, velocity: [0, 0], height: 0, trail: [], ahead: [] } : scene.ball,
    robots: scene.robots.map((robot) => {
      const there = places.get(nameOf(robot));
      return there ? { ...robot, at: there.at, velocity: [0, 0] } : robot;
    }),
  };
}

on("newest", (scene) => {
  for (const [name, { t }] of places) if (scene.t > t + SEEN || scene.t < t) places.delete(name);
});
on("refused", () => places.clear());
on("state", () => places.clear());
