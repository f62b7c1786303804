// rehearse: rehearsal of a case: many attempts in the simulator beside the match, their results, and some of them to be watched.

import { byId, el, fill, number, table } from "./dom.js";
import { changed, store } from "./store.js";
import { bench, request } from "./workbench.js";

/** Attempts of a rehearsal, and how often its progress is asked for, ms. */
const TRIALS = 50;
const EVERY = 400;

let report = null;
let text = "";
let asking = false;
/** What is watched: its moments, and when it began. */
let film = null;

const fail = (error) => changed("refused", error.message);

async function begin(opponents) {
  text = bench.sheet.text;
  report = await request({ do: "rehearse", name: bench.name, text, trials: TRIALS, opponents, seed: 1 });
  changed("bench");
  if (!asking) follow();
}

async function follow() {
  asking = true;
  try {
    while (report && !report.over) {
      await new Promise((later) => setTimeout(later, EVERY));
      report = await request({ do: "rehearsal" });
      changed("bench");
    }
  } catch (error) {
    fail(error);
  } finally {
    asking = false;
  }
}

async function watch(sample) {
  const { moments, ours, result, story } = await request({ do: "sample", number: sample });
  film = { sample, moments, ours, result, story, began: performance.now() };
  changed("bench");
  changed("frame");
}

function end() {
  film = null;
  changed("bench");
  changed("frame");
}

export function showRehearsal() {
  fill(byId("bench-rehearse"), JSON.stringify([report, film?.sample, report && text !== bench.sheet.text, bench.list?.rehearses]), () => [
    el("h2", {}, `Rehearse ${TRIALS} ×`),
    bench.list?.rehearses === false ? el("p", { class: "muted" }, "Beside a real field nothing is rehearsed.") : el("div", { class: "field-set" },
      ...["playing", "standing"].map((opponents) => el("button", { "data-rehearse": opponents, onclick: () => begin(opponents).catch(fail) }, `against ${opponents}`)),
      report && !report.over ? el("button", { id: "bench-stop", onclick: () => request({ do: "stop" }).catch(fail) }, "Stop") : null),
    report ? results() : el("p", { class: "muted" }, "Its robots alone are set up near their places, in this league's simulator, and must retrieve it themselves. They attack towards +x."),
  ]);
}

function results() {
  const { done, trials, score, over, error, samples } = report;
  const share = (n) => (done ? `${number((100 * n) / done, 0)} %` : "–");
  const rows = [["retrieved", score.retrieved, share(score.retrieved)], ["completed", score.completed, share(score.completed)],
    ...Object.entries(score.outcomes).map(([what, n]) => [`then ${what}`, n, share(n)]), ...Object.entries(score.aborted).map(([what, n]) => [`broken off: ${what}`, n, share(n)]),
    ...Object.entries(score.instead).map(([what, n]) => [`instead: ${what}`, n, share(n)])];
  return el("div", { id: "bench-results", "data-over": String(over) },
    text === bench.sheet.text ? null : el("p", { class: "muted" }, "The case was changed since."),
    el("progress", { max: trials, value: done, "aria-label": "Attempts played" }),
    el("p", {}, `${done} of ${trials} attempts against ${score.opponents} opponents${error ? `; ended: ${error}` : ""}`),
    table(["result", ["n", "n"], ["share", "n"]], rows.map(([words, n, percent]) => [words, [String(n), "n"], [percent, "n"]])),
    over ? samples.map((sample) => el("div", { class: "field-set" },
      el("button", { "data-sample": String(sample.number), class: film?.sample === sample.number ? "on" : "", onclick: () => (film?.sample === sample.number ? end() : watch(sample.number).catch(fail)) }, film?.sample === sample.number ? "Stop" : "Watch"),
      el("span", {}, `attempt ${sample.number}: ${sample.result}`))) : null,
    film ? el("pre", { class: "story", tabindex: "0", "aria-label": "What happened in it" }, film.story.join("\n")) : null);
}

/** The scene of what is watched, over the match's own field; none where nothing is. */
export function filmScene(scene, now) {
  if (!film || !scene) return null;
  if (store.tab !== "bench") return null;
  const last = film.moments[film.moments.length - 1];
  // Once through, a second's rest, and again.
  const t = ((now - film.began) / 1000) % (last.t + 1);
  const next = film.moments.findIndex((moment) => moment.t > t);
  const moment = film.moments[next < 0 ? film.moments.length - 1 : Math.max(0, next - 1)];
  const robots = moment.robots.map(([x, y, heading], i) => ({
    team: i < film.ours ? "yellow" : "blue", id: i < film.ours ? i : i - film.ours, at: [x, y], heading, velocity: [0, 0], confidence: 1, mind: null, vitals: null,
  }));
  const trail = film.moments.slice(Math.max(0, next - 25), Math.max(1, next)).map((one) => one.ball);
  return {
    ...scene, robots, layers: [], raw: { balls: [], robots: [] }, game: { ...scene.game, placement: null },
    ball: { at: moment.ball, velocity: [0, 0], height: 0, confidence: 1, trail, ahead: [] },
  };
}
