// tune: tab Parameters: a team's parameters with unit, range and default; those that may change during play are set here, the
// others are read at the start.

import { byId, el, fill, number, say } from "./dom.js";
import { kickTest } from "./kicks.js";
import { ask, getJson } from "./link.js";
import { store } from "./store.js";

/** The program is asked for values so often, ms. */
const EVERY = 1000;

let teams = [];
let asked = 0;
let version = 0;
let text = "[]";
let sought = "";

async function more() {
  if (performance.now() - asked < EVERY) return;
  asked = performance.now();
  const answer = await getJson("/api/parameters");
  const now = JSON.stringify(answer);
  if (now === text) return;
  [teams, text, version] = [answer, now, version + 1];
}

const mayChange = () => ["simulation", "tune"].includes(store.state.powers) && store.state.may_ask !== false;

export function showTune() {
  const tab = byId("tab-tune");
  if (tab.hidden) return;
  more().then(draw).catch(() => {});
  draw();
}

function draw() {
  fill(byId("tab-tune"), `${version} ${store.scene?.robots.length} ${store.state.powers} ${store.state.may_ask} ${store.state.recorded}`, () => [
    el("p", { id: "tune-note", class: "muted", role: "status" }, note()),
    el("input", { id: "tune-search", type: "search", placeholder: "Search names and meanings", "aria-label": "Search parameters", value: sought, oninput: (event) => search(event.target.value) }),
    ...teams.flatMap(team),
  ]);
  search(sought);
}

/** Shows the parameters whose name or meaning has every word, and those read at the start only where one is found. */
function search(words) {
  sought = words;
  const all = words.toLowerCase().split(/\s+/).filter(Boolean);
  for (const one of byId("tab-tune").querySelectorAll(".param")) one.hidden = !all.every((word) => one.dataset.about.includes(word));
  for (const part of byId("tab-tune").querySelectorAll("details[data-start]")) {
    const found = part.querySelectorAll(".param:not([hidden])").length > 0;
    part.hidden = !found;
    if (all.length) part.open = found;
  }
}

function note() {
  if (store.state.recorded) return "A recording has its teams' settings in its header: replay FILE --json prints them.";
  if (teams.length === 0) return "No team's parameters are known yet.";
  if (store.state.powers === "halt") return "Read only: to change parameters on a real field start control with --live-parameters.";
  if (!mayChange()) return "You are a viewer: to change something, open the page at the address with ?token= that the program printed.";
  return "Enter or leaving a box sets a value; an empty box sets the default. Changes hold from the next plan on.";
}

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const words = (value) => (value == null ? "" : String(value));

/** The parameters of a team: those that can change while it plays, then those that are read at the start. */
function team({ team: name, list, kicks, roll, test, file, toml }) {
  const [live, start] = [true, false].map((now) => list.filter((one) => one.live === now));
  const rows = (some) => el("div", { class: "params" }, some.flatMap((one) => (one.each_robot ? robots(name, one, list) : [row(name, one, true)])));
  const changed = list.filter((one) => one.value != null && !same(one.value, one.default)).length;
  return [
    el("h2", {}, el("span", { class: `chip ${name}` }, name[0].toUpperCase()), ` ${name}: ${changed} of ${list.length} changed`),
    rows(live),
    roll ? el("p", { class: "muted" }, `Rolling ball: learned ${number(roll.value, 3)} ± ${number(roll.error, 3)} m/s² of ${roll.samples} balls.`) : null,
    learned(name, kicks, list),
    ...kickTest(name, test, mayChange(), (robot, value) => change(name, { key: "calibration.kick", robot }, value)),
    el("details", { "data-start": name }, el("summary", {}, "Read when the program starts"), rows(start)),
    el("div", { class: "field-set" },
      file ? el("button", { "data-save": name, disabled: !mayChange(), onclick: () => ask({ ask: "save" }) }, `Save to ${file}`) : null,
      toml ? el("a", { class: "button", download: `team-${name}.toml`, href: `data:application/toml;charset=utf-8,${encodeURIComponent(toml)}` }, "Download team.toml") : null),
  ];
}

/** One box for each robot that is on the field or has a value of its own. */
function robots(name, one, list) {
  if (one !== list.find(({ key }) => key === one.key)) return [];
  const own = new Map(list.filter(({ key, robot }) => key === one.key && robot != null).map((some) => [some.robot, some]));
  const on = (store.scene?.robots ?? []).filter((robot) => robot.team === name).map(({ id }) => id);
  return [...new Set([...on, ...own.keys()])].sort((a, b) => a - b).map((robot, i) => row(name, own.get(robot) ?? { ...one, robot, value: null }, i === 0));
}

/** Name, value and unit; what it means below, for the first robot of several alone. */
function row(name, one, first) {
  const label = one.robot == null ? one.key : `${one.key} ${one.robot}`;
  const id = `tune-${name}-${label.replaceAll(/[ .]/g, "-")}`;
  const differs = one.value != null && !same(one.value, one.default);
  const range = one.range ? `, ${one.range[0]} to ${one.range[1]}${one.unit && ` ${one.unit}`}` : one.unit ? `, ${one.unit}` : "";
  const about = el("small", { class: "muted", id: `${id}-about`, hidden: !first }, `${one.meaning}${range}${one.default == null ? "" : `; default: ${one.default}`}`);
  const value = one.live && mayChange() ? box(name, one, id) : el("output", { id, class: "value" }, words(one.value) || "–");
  return el("div", { class: differs ? "param differs" : "param", "data-key": label, "data-about": `${label} ${one.meaning}`.toLowerCase() },
    el("label", { for: id }, label), value, el("span", { class: "unit" }, one.unit), about);
}

function box(name, one, id) {
  const isNumber = one.range != null;
  const made = el("input", { id, type: isNumber ? "number" : "text", value: words(one.value), title: words(one.value), placeholder: words(one.default) || "default", "aria-describedby": `${id}-about`,
    ...(isNumber ? { min: one.range[0], max: one.range[1], step: "any" } : {}) });
  let sent = made.value;
  const set = () => {
    if (made.value === sent || !made.validity.valid) return;
    sent = made.value;
    change(name, one, made.value === "" ? null : isNumber ? Number(made.value) : made.value);
  };
  made.addEventListener("change", set);
  made.addEventListener("keydown", (event) => {
    if (event.key === "Escape") {
      made.value = sent;
      made.blur();
    }
  });
  return made;
}

function change(name, { key, robot }, value) {
  ask({ ask: "parameter", team: name, key, ...(robot == null ? {} : { robot }), value });
  asked = 0;
  say(byId("tune-note"), `${name}: ${key}${robot == null ? "" : ` of robot ${robot}`} = ${value ?? "default"}`);
}

/** What was learned of each robot's kicker; a press takes it as its gain. */
function learned(name, kicks, list) {
  if (kicks.length === 0) return el("p", { class: "muted" }, "Nothing learned of kickers yet: robots kick, the tracker fits the ball's speed, and the median of the last 15 kicks is shown here.");
  const kick = list.find(({ key }) => key === "calibration.kick");
  return el("ul", { class: "learned" }, kicks.map(({ robot, value, error, samples }) => el("li", {}, `robot ${robot}: learned ${number(value, 3)} ± ${number(error, 3)} of ${samples} kicks `,
    mayChange() ? el("button", { "data-take": `${name}${robot}`, onclick: () => change(name, { ...kick, robot }, Number(value.toFixed(3))) }, "Take") : null)));
}
