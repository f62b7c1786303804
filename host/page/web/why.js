// why: tab Why: each robot's role, its order and the reason, the state of its case; and each team's cycle.

import { byId, el, fill, number } from "./dom.js";
import { explainEvent, explainNow } from "./explain.js";
import { choose, isChosen, store } from "./store.js";

export function showWhy() {
  const tab = byId("tab-why");
  const scene = store.scene;
  if (tab.hidden || !scene) return;
  const minds = scene.robots.filter((robot) => robot.mind);
  const key = JSON.stringify([minds.map((r) => [r.team, r.id, r.mind.role, r.mind.directive, r.mind.why, r.mind.state, r.mind.step,
    r.mind.part, r.mind.reactive, isChosen(r) && r.mind.timers.map((t) => t.seconds.toFixed(1))]), scene.cycles.map((c) => [c.team, c.number, c.state, c.case, c.coordinator]), store.state.life]);
  const top = tab.scrollTop;
  const replaced = fill(tab, key, () => {
    if (minds.length === 0) return el("p", { class: "muted" }, "Nothing is known of any robot's decisions: no host of ours is at work here, or no robot of its team is seen yet (tab Health, and alarms on the field).");
    return ["blue", "yellow"].flatMap((team) => teamPart(scene, team, minds.filter((robot) => robot.team === team)));
  });
  if (replaced) tab.scrollTop = top;
  for (const cycle of scene.cycles) {
    const slot = tab.querySelector(`[data-cycle="${cycle.team}"]`);
    if (slot) slot.textContent = `${number(cycle.seconds)} s`;
  }
}

/** Brings the chosen robot's card into the panel; where the page itself scrolls, it stays where it is. */
export function showChosen() {
  const tab = byId("tab-why");
  const card = tab.querySelector(".card.chosen");
  if (tab.hidden || !card) return;
  const [box, at] = [tab.getBoundingClientRect(), card.getBoundingClientRect()];
  if (at.top < box.top) tab.scrollTop += at.top - box.top - 8;
  else if (at.bottom > box.bottom) tab.scrollTop += at.bottom - box.bottom + 8;
}

function teamPart(scene, team, robots) {
  if (robots.length === 0) return [];
  const cycle = scene.cycles.find((one) => one.team === team);
  return [
    el("h2", {}, el("span", { class: `chip ${team}` }, team), el("button", { onclick: () => explainNow(team), "data-explain": team, title: "Which case would fit this moment, and why" }, "Explain this moment")),
    cycle ? cycleBox(cycle) : null,
    ...robots.map(card),
  ];
}

function cycleBox(cycle) {
  const last = store.matchEvents.findLast((h) => h.kind === "case" && h.team === cycle.team && h.t <= store.scene.t + 0.05);
  const words = cycle.case ? `${cycle.case}${cycle.symmetry && cycle.symmetry !== "identity" ? ` · ${cycle.symmetry}` : ""}` : "no case";
  return el("div", { class: "cycle" },
    el("div", { class: "name" }, words),
    cycle.meant ? el("div", { class: "muted" }, cycle.meant) : null,
    el("div", { class: "row" },
      el("span", {}, cycle.state), el("span", { class: "muted", "data-cycle": cycle.team }, ""),
      el("span", { class: "muted" }, `cycle ${cycle.number}, led by ${cycle.coordinator}`)),
    el("div", { class: "row" },
      ...cycle.players.map((id, i) => el("span", { class: `chip ${cycle.team}`, title: `case robot ${i + 1}` }, String(id))),
      cycle.case && last?.problem ? el("button", { onclick: () => explainEvent(last), "data-retrieval": cycle.team }, "Why this case?") : null));
}

function card(robot) {
  const { mind } = robot;
  const chosen = isChosen(robot);
  const state = mind.part ? `${mind.state}${mind.step ? `, ${mind.step}` : ""}` : mind.reactive;
  return el("div", { class: `card ${robot.team}${chosen ? " chosen" : ""}`, "data-robot": `${robot.team}${robot.id}`, tabindex: "0", role: "button", "aria-pressed": String(chosen),
    onclick: () => choose(robot.team, robot.id), onkeydown: (event) => [" ", "Enter"].includes(event.key) && event.target.matches(":focus-visible") && choose(robot.team, robot.id) },
    el("div", { class: "top" }, el("b", {}, String(robot.id)), el("span", {}, mind.role), el("span", { class: "state" }, state)),
    el("p", {}, mind.directive),
    mind.why ? el("p", { class: "why" }, mind.why) : null,
    mind.part ? el("p", { class: "why" }, mind.part) : null,
    chosen && mind.timers.length ? el("p", { class: "why" }, mind.timers.map((timer) => `${timer.name} ${number(timer.seconds)} s`).join(" · ")) : null);
}
