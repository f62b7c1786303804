// course: points of a plotted line: every kept scene for some seconds, one sample a second for the whole match.

import { getJson } from "./link.js";
import { changed, on, store } from "./store.js";

/** Numbers of a robot: key, words, unit, from a scene's robot, and its place in a sample, where it is there. */
export const OF_ROBOTS = [
  ["speed", "speed", "m/s", (r) => Math.hypot(...r.velocity), 0], ["x", "x", "m", (r) => r.at[0]], ["y", "y", "m", (r) => r.at[1]],
  ["heading", "heading", "°", (r) => (r.heading * 180) / Math.PI], ["battery", "battery", "V", (r) => r.vitals?.battery, 1],
  ["trip", "round trip over 1 s", "ms", (r) => r.vitals?.link?.trip_ms[0], 2], ["down", "loss to it over 1 s", "%", (r) => r.vitals?.link?.loss_down[0], 3],
  ["up", "loss from it over 1 s", "%", (r) => r.vitals?.link?.loss_up[0], 4], ["frames", "frames received over 1 s", "/s", (r) => r.vitals?.link?.frames[0], 5],
  ["telemetry", "telemetry received over 1 s", "/s", (r) => r.vitals?.link?.telemetry[0], 6], ["silence", "since it was heard", "ms", (r) => r.vitals?.silence_ms, 7],
  ["unseen", "since a camera saw it", "ms", (r) => r.vitals?.unseen_ms, 8],
];

/** What is kept of a scene: as little as lines need. */
const slim = (scene) => ({
  t: scene.t, gauges: new Map(scene.gauges.map((gauge) => [`${gauge.group}/${gauge.name}`, gauge.value])),
  robots: new Map(scene.robots.map((robot) => [`${robot.team}${robot.id}`, OF_ROBOTS.map(([, , , of]) => of(robot))])),
});

/** Seconds that were fetched, by number, and how many at most. */
const fetched = new Map();
const SECONDS_MAX = 90;
/** Scenes that have just come: the second that is being played is not fetched. */
let recent = [];
let fetching = false;

on("newest", (scene) => {
  recent.push(slim(scene));
  if (recent.length > 200) recent.shift();
});
on("state", () => {
  fetched.clear();
  recent = [];
});

/** One second at a time, so that no frame waits for many. */
async function fetchSecond(second) {
  if (fetching) return;
  fetching = true;
  try {
    const scenes = (await getJson(`/api/second/${second}`)).map(slim);
    if (fetched.size >= SECONDS_MAX) fetched.delete(fetched.keys().next().value);
    fetched.set(second, scenes);
  } catch {
    fetched.set(second, []);
  } finally {
    fetching = false;
  }
  changed("course");
}

/** Kept scenes from `first` to `last`, s, as far as they are here; the others are fetched. */
function scenesIn(first, last) {
  const here = [];
  const newest = Math.floor(store.latest?.t ?? 0);
  for (let second = Math.floor(first); second <= Math.floor(last); second++) {
    const whole = second < newest || store.state.recorded;
    if (fetched.has(second)) here.push(...fetched.get(second));
    else if (recent.length && recent[0].t <= second) here.push(...recent.filter((one) => Math.floor(one.t) === second));
    else if (whole) fetchSecond(second);
    else here.push(...recent.filter((one) => Math.floor(one.t) === second));
  }
  return here.filter((one) => one.t >= first && one.t <= last);
}

/** Points of a line: of a robot's number (`blue3`, `speed`) or a gauge (none, `vision/packets a second`). */
export function pointsOf(robot, name, [first, last], fine) {
  const value = (x) => x != null && Number.isFinite(x);
  const i = OF_ROBOTS.findIndex(([key]) => key === name);
  if (fine) {
    return scenesIn(first, last).map((one) => [one.t, robot ? one.robots.get(robot)?.[i] : one.gauges.get(name)]).filter(([, x]) => value(x));
  }
  const place = OF_ROBOTS[i]?.[4];
  const inside = store.samples.filter((sample) => sample.t >= first && sample.t <= last);
  return inside.map((sample) => [sample.t, robot ? sample.robots?.[robot]?.[place] : sample.values[name]]).filter(([, x]) => value(x));
}

/** The value at a time: of the last point by then, unless it is older than `gap` seconds. */
export function valueAt(points, t, gap) {
  const point = points.findLast(([at]) => at <= t + 1e-6);
  return point && t - point[0] <= gap ? point[1] : null;
}

/** A scene's sample, as the program keeps one a second. */
export function sampleOf(scene) {
  const values = Object.fromEntries(scene.gauges.map((gauge) => [`${gauge.group}/${gauge.name}`, gauge.value]));
  const numbers = (robot) => OF_ROBOTS.filter(([, , , , place]) => place !== undefined).map(([, , , of]) => of(robot) ?? null);
  return { t: scene.t, values, robots: Object.fromEntries(scene.robots.map((robot) => [`${robot.team}${robot.id}`, numbers(robot)])) };
}
