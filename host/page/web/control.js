// control: tab Control: the requests that a viewer may send. All in a simulation, HALT on a real field, none in a recording; the time line's where it is sent.

import { byId, el, fill, say } from "./dom.js";
import { handPart, showHand } from "./hand.js";
import { ask } from "./link.js";
import { remotePart, showRemote } from "./remote.js";
import { playOnPart, showPlayOn } from "./playon.js";
import { showSkills, skillPart } from "./skills.js";
import { showSnapshots, snapshotPart } from "./snapshots.js";
import { on, store } from "./store.js";

const COMMANDS = [
  ["HALT", "Halt"], ["STOP", "Stop"], ["FORCE_START", "Force start"], ["NORMAL_START", "Normal start"],
  ["PREPARE_KICKOFF_BLUE", "Kick-off, blue"], ["PREPARE_KICKOFF_YELLOW", "Kick-off, yellow"],
  ["DIRECT_FREE_BLUE", "Free kick, blue"], ["DIRECT_FREE_YELLOW", "Free kick, yellow"],
  ["PREPARE_PENALTY_BLUE", "Penalty, blue"], ["PREPARE_PENALTY_YELLOW", "Penalty, yellow"],
];

export function showControl() {
  const tab = byId("tab-control");
  if (tab.hidden || !store.scene) return;
  const { powers, life, may_ask: mayAsk } = store.state;
  // A recording takes nothing from anybody: there the token makes no difference.
  const shown = mayAsk === false && powers !== "none" ? "locked" : powers;
  fill(tab, `${shown} ${life}`, () => ({ simulation, halt, tune: halt, none, replay, locked })[shown]());
  showHand();
  showRemote();
  showPlayOn();
  if (shown !== "simulation") return;
  showSnapshots();
  showSkills();
  say(byId("pause"), store.latest?.paused ? "Resume" : "Pause");
  const speed = byId("speed-now");
  if (speed && store.latest) say(speed, `${store.latest.speed} ×`);
  const robots = store.scene.robots.map((robot) => `${robot.team} ${robot.id}`);
  const select = byId("who");
  const all = [...new Set([...[...select.options].map((option) => option.value), ...robots])].sort();
  if (all.length !== select.options.length) select.replaceChildren(...all.map((name) => el("option", {}, name)));
}

const none = () => [
  el("p", { class: "muted" }, "A recording cannot be changed. Everything else works as in a match: layers, explanations, plots, and files of a moment."),
  ...playOnPart(),
];

const replay = () => [
  el("p", {}, "This recording goes out to the network. Pause, speed and moment (below, or by keys) are the program's: they hold for all that receive it and for all viewers. While it is paused nothing is sent."),
  ...playOnPart(),
];

const locked = () => el("p", { class: "muted" }, "You are a viewer. To send requests, open the page at the address with ?token= that the program printed when it started.");

const halt = () => [
  el("p", {}, store.state.powers === "tune" ? "On a real field the page can halt our robots, whatever the referee says, until the program ends, change parameters (the tab of that name), and drive one of them by hand." : "On a real field the page can do one thing: our robots stand, whatever the referee says, until the program ends."),
  el("button", { class: "danger", id: "halt", onclick: () => ask({ ask: "halt" }) }, "HALT our robots"),
  ...(store.state.powers === "tune" ? [...remotePart(), ...handPart()] : []),
];

function simulation() {
  const press = (words, request, more = {}) => el("button", { onclick: () => ask(request()), ...more }, words);
  const set = (...children) => el("div", { class: "field-set" }, ...children);
  const who = () => {
    const [team, id] = byId("who").value.split(" ");
    return { team, id: Number(id) };
  };
  const speed = el("input", { type: "range", min: "-4.3", max: "4.3", step: "0.1", value: String(Math.log2(store.latest?.speed || 1)), "aria-label": "Speed",
    oninput: (event) => ask({ ask: "speed", factor: Math.round(2 ** event.target.value * 20) / 20 || 0.05 }) });
  const seed = el("input", { type: "number", min: "0", id: "seed", value: String(store.scene.seed ?? 1), "aria-label": "Seed" });
  const loss = el("input", { type: "range", min: "0", max: "60", value: "0", "aria-label": "Radio loss", oninput: (event) => {
    say(byId("loss-now"), `${event.target.value} %`);
    ask({ ask: "loss", share: event.target.value / 100 });
  } });
  return [
    el("h2", {}, "Time"),
    set(press("Pause", () => ({ ask: "pause", on: !store.latest?.paused }), { id: "pause" }), press("1 tick", () => ({ ask: "step", ticks: 1 }), { id: "step" }), press("10 ticks", () => ({ ask: "step", ticks: 10 }))),
    set(el("label", {}, "Speed"), speed, el("span", { id: "speed-now" }), press("Clock's pace", () => ((speed.value = 0), { ask: "speed", factor: 1 }))),
    set(el("label", {}, "Seed"), seed, press("Restart", () => ({ ask: "restart", seed: Number(seed.value) }), { id: "restart" })),
    ...situations(press, set),
    ...handPart(),
    ...playOnPart(),
    ...snapshotPart(),
    ...skillPart(),
    el("h2", {}, "Referee"),
    set(...COMMANDS.map(([command, words]) => press(words, () => ({ ask: "referee", command }), { "data-command": command }))),
    el("h2", {}, "Faults"),
    set(el("label", {}, "Radio loses"), loss, el("span", { id: "loss-now" }, "0 %")),
    set(el("select", { id: "who", "aria-label": "Robot" }), press("Crash its computer", () => ({ ask: "power", ...who(), on: false }), { id: "crash" }), press("Boot it", () => ({ ask: "power", ...who(), on: true }), { id: "boot" })),
    el("p", { class: "muted" }, "Ball and robots can be dragged on the field."),
  ];
}

/** The cases' own situations: chosen by name, set up on the field, played from there. */
function situations(press, set) {
  const names = store.state.situations ?? [];
  if (names.length === 0) return [];
  const select = el("select", { id: "situation", "aria-label": "Situation" }, ...names.map((name) => el("option", {}, name)));
  return [
    el("h2", {}, "Situation"),
    set(select, press("Play it from here", () => ({ ask: "situation", name: select.value }), { id: "situate" })),
  ];
}

export function startControl() {
  on("newest", () => showControl());
}
