// playon: a moment of a recording, or of the match that runs, played on several times with different seeds: outcomes beside each other.

import { byId, clock, el, fill, number, table } from "./dom.js";
import { changed, store } from "./store.js";
import { request } from "./workbench.js";

/** How often the course of the tries is asked for, ms. */
const EVERY = 500;
/** Default number of tries. */
const TRIES = 20;

let answer = null;
let asked = 0;

async function inquire(body) {
  asked = performance.now();
  answer = await request(body);
}

const fail = (error) => changed("refused", error.message);

/** The part of the tab; `showPlayOn` fills it. */
export const playOnPart = () => [el("div", { id: "playon-choice" }), el("div", { id: "playon-result" })];

export function showPlayOn() {
  if (!byId("playon-choice")) return;
  const runs = answer?.report && !answer.report.over;
  if (!answer ? performance.now() - asked > 4 * EVERY : runs && performance.now() - asked > EVERY) inquire({ do: "play_on" }).catch(() => {});
  fill(byId("playon-choice"), `${answer?.from} ${Boolean(runs)}`, () => (answer?.from ? choice(runs) : []));
  fill(byId("playon-result"), JSON.stringify(answer?.report ?? null), () => (answer?.report ? result(answer.report) : []));
}

function choice(runs) {
  const tries = el("input", { type: "number", id: "playon-tries", min: "1", max: "500", value: String(TRIES), "aria-label": "Tries from this moment" });
  const play = () => inquire({ do: "play_on", plan: { at: store.scene.t, tries: Number(tries.value), seed: 1 } }).catch(fail);
  return [
    el("h2", {}, "Play on from here"),
    el("div", { class: "field-set" }, tries, "times", el("button", { id: "playon-begin", onclick: play }, "Play on from here"),
      runs ? el("button", { id: "playon-stop", onclick: () => inquire({ do: "stop_play_on" }).catch(fail) }, "Stop") : null),
    el("p", { class: "muted" }, answer.from === "recording" ? "From the moment that is shown, between two teams of ours, beside the recording." : "From the match as it is now, between its teams, with other seeds; pause it first to choose the moment. The match itself goes on."),
  ];
}

function result({ at, tries, seconds, outcomes, error, over }) {
  const pair = ({ blue, yellow }) => [`${blue} : ${yellow}`, "n"];
  const at1 = (seconds_) => (seconds_ == null ? "no" : `${number(seconds_, 1)} s`);
  const ball = ({ first_touch: team, lost_s: lost }) => (!team ? "none touches it" : lost == null ? `${team} keeps it` : `${team} loses it, ${at1(lost)}`);
  return [
    el("progress", { max: tries, value: outcomes.length, "aria-label": "Tries played on" }),
    el("p", { role: "status", "data-playon-over": String(over) }, `${outcomes.length} of ${tries} tries of ${seconds} s from ${clock(at)}${error ? `; ended: ${error}` : ""}`),
    table([["seed", "n"], ["goals", "n"], ["shots", "n"], "ball", "first shot", "stopped"], outcomes.map((one) => [
      [String(one.seed), "n"], pair(one.goals), pair(one.shots), ball(one), one.first_shot ? `${one.first_shot.team}, ${at1(one.first_shot.at_s)}` : "none", at1(one.stopped_s)])),
    el("p", { class: "muted" }, "Goals and shots: blue : yellow. Seconds from half a second before the moment."),
  ];
}
