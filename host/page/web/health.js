// Is everything well? Robots and their links at a glance, then numbers with their limits and their course.

import { byId, el, fill, number } from "./dom.js";
import { drawPlots, plotPart } from "./plots.js";
import { choose, store } from "./store.js";

export function showHealth() {
  const tab = byId("tab-health");
  const scene = store.scene;
  if (tab.hidden || !scene) return;
  if (!tab.firstChild) tab.append(el("div", { id: "vitals" }), el("h2", {}, "Course of the match"), el("div", { id: "plots" }));
  const robots = scene.robots.filter((robot) => robot.vitals);
  const second = Math.floor(scene.t * 2);
  fill(byId("vitals"), `${second} ${robots.length}`, () => vitals(robots));
  plotPart(byId("plots"), scene);
  drawPlots(byId("plots"));
}

function vitals(robots) {
  if (robots.length === 0) return el("p", { class: "muted" }, "No robot tells how it is.");
  const cell = (value, digits, bad) => el("td", { class: `n${bad ? " bad" : ""}` }, number(value, digits));
  const rows = robots.map(({ team, id, vitals: v }) => el("tr", { class: "pick", title: `${v.refused} frames refused, ${v.lives === 1 ? "booted once" : `booted ${v.lives} times`}`, onclick: () => choose(team, id) },
    el("td", {}, el("button", { class: `chip ${team}`, "data-vitals": `${team}${id}`, "aria-label": `${team} ${id}` }, String(id))),
    cell(v.battery, 1, v.battery != null && v.battery < 14.4),
    cell(v.trip_ms, 1, v.trip_ms > 40), cell(v.loss_down, 1, v.loss_down > 10), cell(v.loss_up, 1, v.loss_up > 10),
    cell(v.silence_ms, 0, v.silence_ms > 100), cell(v.unseen_ms, 0, v.unseen_ms > 200),
    el("td", { class: v.faults.length ? "bad" : "fine" }, v.faults.join(", ") || [v.ball ? "ball" : "", v.kicker ? "charged" : ""].filter(Boolean).join(", ") || "ok")));
  const head = (words, title) => el("th", { class: "n", title }, words);
  return el("div", { class: "scroll" }, el("table", { class: "tight" },
    el("thead", {}, el("tr", {}, el("th", {}, "robot"), head("V", "battery voltage"), head("RTT", "round-trip time of the radio, ms"), head("loss ↓", "frames lost on the way to the robot, %"), head("↑ %", "frames lost on the way from it, %"),
      head("heard", "since it was last heard, ms"), head("seen", "since a camera last saw it, ms"), el("th", {}, "state"))),
    el("tbody", {}, rows)),
    el("p", { class: "muted" }, "V: battery. RTT: round-trip time of the radio, ms. loss ↓ ↑: frames lost on their way to the robot and from it, %. heard, seen: since it was last heard, last seen by a camera, ms."));
}
