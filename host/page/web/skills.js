// skills: tries of a skill in the simulator beside the match, as `onetwo evaluate skills` plays them.

import { byId, el, fill, number, table } from "./dom.js";
import { changed, store } from "./store.js";
import { request } from "./workbench.js";

/** How often the course of the tries is asked for, ms. */
const EVERY = 500;

let answer = null;
let asked = 0;
const chosen = { skill: "kick", world: "nominal", tries: 20, seed: 1 };

async function inquire(body) {
  asked = performance.now();
  answer = await request(body);
}

const fail = (error) => changed("refused", error.message);

/** The part of the tab; `showSkills` fills it. */
export const skillPart = () => [
  el("h2", {}, "Skill tests"),
  el("div", { id: "skill-choice", class: "field-set" }),
  el("div", { id: "skill-result" }),
];

export function showSkills() {
  if (!byId("skill-choice")) return;
  const runs = answer?.report && !answer.report.over;
  if (!answer ? performance.now() - asked > 4 * EVERY : runs && performance.now() - asked > EVERY) inquire({ do: "tries" }).catch(() => {});
  fill(byId("skill-choice"), `${Boolean(answer)} ${runs} ${store.state.may_ask}`, choice);
  fill(byId("skill-result"), JSON.stringify(answer?.report ?? null), result);
}

function choice() {
  if (!answer) return [];
  const select = (name, all) => {
    const made = el("select", { id: `skill-${name}`, "aria-label": name === "skill" ? "Skill" : "World", onchange: (event) => (chosen[name] = event.target.value) }, ...all.map((one) => el("option", {}, one)));
    made.value = chosen[name];
    return made;
  };
  const tries = el("input", { type: "number", id: "skill-tries", min: "1", max: "500", value: String(chosen.tries), "aria-label": "Tries", onchange: (event) => (chosen.tries = Number(event.target.value)) });
  return [
    select("skill", answer.choices.skills), "in", select("world", answer.choices.worlds), tries, "times",
    el("button", { id: "skill-try", onclick: () => inquire({ do: "tries", plan: chosen }).catch(fail) }, "Try"),
    answer.report && !answer.report.over ? el("button", { id: "skill-stop", onclick: () => inquire({ do: "stop_tries" }).catch(fail) }, "Stop") : null,
  ].filter(Boolean);
}

function result() {
  const { report } = answer ?? {};
  if (!report) return el("p", { class: "muted" }, "Each try starts from the beginning, with the default parameters, through world, cameras, host, radio and robots. On a real field only kickers are tested: tab Parameters.");
  const { row, tries, failed, error, over } = report;
  const seconds = (time) => (time == null ? "–" : `${number(time, 2)} s`);
  return [
    el("progress", { max: tries, value: row.tries, "aria-label": "Tries played" }),
    el("p", { role: "status", "data-tries-over": String(over) }, `${row.succeeded} of ${row.tries} tries succeeded${error ? `; ended: ${error}` : ""}`),
    table(["skill", "world", ["share", "n"], ["median time", "n"], ["95 % within", "n"]],
      [[row.skill, row.world, [row.tries ? `${number((100 * row.succeeded) / row.tries, 1)} %` : "–", "n"], [seconds(row.time_median_s), "n"], [seconds(row.time_p95_s), "n"]]]),
    failed.length ? el("details", {}, el("summary", {}, "Failed tries"), el("ul", { class: "learned" }, failed.map(({ number: which, start, what, command }) => el("li", {}, `try ${which}: ${start}: ${what} `, el("code", {}, command))))) : null,
  ];
}
