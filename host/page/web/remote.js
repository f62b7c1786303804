// remote: part of the tab Control: our team's remote control at the league's game controller, and the state that it answers with.

import { byId, el, fill, number } from "./dom.js";
import { ask } from "./link.js";
import { store } from "./store.js";

/** Request, its words, and the request that withdraws it. */
const REQUESTS = [
  ["timeout", "Timeout", "withdraw-timeout"], ["end-timeout", "End the timeout"], ["substitution", "Substitution", "withdraw-substitution"],
  ["challenge", "Challenge flag"], ["fail-placement", "Fail our placement"], ["emergency-stop", "Emergency stop", "withdraw-emergency-stop"],
];

export const remotePart = () => [el("div", { id: "remote" })];

export function showRemote() {
  const part = byId("remote");
  const state = store.latest?.remote;
  if (!part) return;
  fill(part, JSON.stringify(state ?? null), () => (state === undefined ? [] : [el("h2", {}, "Game controller"), ...(state ? shown(state) : [el("p", { class: "muted" }, "No connection to its port for remote controls.")])]));
}

function shown(state) {
  const press = ([name, words, withdraw]) => {
    const active = state.active.includes(name);
    const undo = active && withdraw;
    return el("button", { "data-remote": name, disabled: !undo && !state.available.includes(name), class: name === "emergency-stop" ? "danger" : null, ...(withdraw ? { "aria-pressed": String(active) } : {}),
      onclick: () => ask({ ask: "remote", request: undo ? withdraw : name }) }, undo ? `Withdraw: ${words}` : words);
  };
  const keeper = el("input", { type: "number", min: "0", max: "15", id: "remote-keeper", value: String(state.keeper ?? 0) });
  const cards = state.yellow_cards_due_s.map((s) => `${number(s, 0)} s`).join(", ");
  return [
    el("div", { class: "field-set" }, REQUESTS.map(press)),
    el("div", { class: "field-set" }, el("label", { for: "remote-keeper" }, "Keeper"), keeper,
      el("button", { "data-remote": "keeper", disabled: !state.available.includes("keeper"), onclick: () => ask({ ask: "remote", request: "keeper", robot: Number(keeper.value) }) }, "Make it keeper")),
    el("p", { class: "muted" }, `${state.robots_on_field} of ${state.max_robots} robots on the field; ${state.timeouts_left} timeouts, ${number(state.timeout_left_s, 0)} s; ${state.challenge_flags_left} challenge flags; ${state.substitutions_left} substitutions left${cards ? `; yellow cards end in ${cards}` : ""}${state.emergency_stop_in_s > 0 ? `; emergency stop in ${number(state.emergency_stop_in_s)} s` : ""}.`),
  ];
}
