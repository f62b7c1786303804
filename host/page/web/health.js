// health: tab Health: robots, their links and the cameras, a plot, the program's log, then gauges with their limits.

import { byId, el, fill, number } from "./dom.js";
import { buildLog, showLog } from "./log.js";
import { buildPlot, showPlot } from "./plot.js";
import { drawPlots, plotPart } from "./plots.js";
import { choose, store } from "./store.js";

export function showHealth() {
  const tab = byId("tab-health");
  const scene = store.scene;
  if (tab.hidden || !scene) return;
  if (!tab.firstChild) {
    tab.append(el("div", { id: "vitals" }), el("h2", {}, "Cameras"), el("div", { id: "cameras" }), el("h2", {}, "Plot"), ...buildPlot(),
      el("h2", {}, "Program log"), ...buildLog(), el("h2", {}, "Course of the match"), el("div", { id: "plots" }));
  }
  const robots = scene.robots.filter((robot) => robot.vitals);
  const second = Math.floor(scene.t * 2);
  fill(byId("vitals"), `${second} ${robots.length}`, () => vitals(robots));
  fill(byId("cameras"), `${second}`, () => cameras(scene.cameras ?? []));
  showPlot(scene);
  showLog();
  plotPart(byId("plots"), scene);
  drawPlots(byId("plots"));
}

const head = (words, title) => el("th", { class: "n", title, scope: "col" }, words);
/** A value over the last second, and under it the worst within ten. */
const windowed = ([now, worst] = [null, null], digits, bad) => el("td", { class: `n${bad(now) ? " bad" : ""}` }, number(now, digits), el("small", { class: bad(worst) ? "bad" : "muted" }, number(worst, digits)));
const over = (limit) => (x) => x != null && x > limit;
const under = (limit) => (x) => x != null && x < limit;
const scroll = (label, ...parts) => el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": label }, ...parts);

function vitals(robots) {
  if (robots.length === 0) return el("p", { class: "muted" }, "No robot reports its state.");
  const cell = (value, digits, bad) => el("td", { class: `n${bad ? " bad" : ""}` }, number(value, digits));
  const rows = robots.map(({ team, id, vitals: v }) => el("tr", { class: "pick", title: `${v.refused} frames refused, ${v.lives === 1 ? "booted once" : `booted ${v.lives} times`}`, onclick: () => choose(team, id) },
    el("td", {}, el("button", { class: `chip ${team}`, "data-vitals": `${team}${id}`, "aria-label": `${team} ${id}` }, String(id))),
    el("td", { class: v.faults.length ? "bad" : "fine" }, v.faults.join(", ") || [v.ball ? "ball" : "", v.governed ? "limited" : ""].filter(Boolean).join(", ") || "ok", el("small", { class: "muted" }, v.kicker ? "charged" : "not charged")),
    cell(v.battery, 1, v.battery != null && v.battery < 14.4),
    windowed(v.link?.trip_ms, 1, over(40)), windowed(v.link?.loss_down, 1, over(10)), windowed(v.link?.loss_up, 1, over(10)),
    windowed(v.link?.frames, 0, under(10)), windowed(v.link?.telemetry, 0, under(2)), windowed(v.link?.kbps, 0, () => false),
    cell(v.telemetry_ms, 0, v.telemetry_ms > 500), cell(v.silence_ms, 0, v.silence_ms > 100), cell(v.unseen_ms, 0, v.unseen_ms > 200)));
  return [scroll("Robots and their links", el("table", { class: "tight" },
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "robot"), el("th", { scope: "col", title: "faults, else what it does; below it the kicker's capacitor" }, "state"), head("V", "battery voltage"), head("RTT", "mean round-trip time of the radio, ms"), head("loss ↓", "frames lost on the way to the robot, %"), head("↑ %", "frames lost on the way from it, %"),
      head("fr/s", "frames received a second"), head("tel/s", "telemetry received a second"), head("kbit/s", "frames of both directions"), head("report", "since its last telemetry, ms"), head("heard", "since it was last heard, ms"), head("seen", "since a camera last saw it, ms"))),
    el("tbody", {}, rows))),
    el("p", { class: "muted" }, "RTT to kbit/s: over 1 s, below it the worst such second within 10 s. report, heard, seen: ms since its telemetry, any frame, a camera. Capacitor voltage, temperatures and firmware version: not reported, telemetry has no field for them.")];
}

function cameras(list) {
  if (list.length === 0) return el("p", { class: "muted" }, "No camera has sent anything.");
  const rows = list.map((camera) => el("tr", {}, el("td", {}, String(camera.id)),
    windowed(camera.frames, 0, under(30)), windowed(camera.delay_ms, 1, over(50)), windowed(camera.lost, 1, over(5)),
    el("td", { class: "n" }, String(camera.lost_total)), el("td", { class: `n${camera.age_ms > 200 ? " bad" : ""}` }, number(camera.age_ms, 0))));
  return [scroll("Cameras", el("table", { class: "tight" },
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "camera"), head("fr/s", "camera frames a second"), head("delay", "from taking a camera frame to sending it, ms"), head("lost %", "camera frames lost, by their numbers"), head("lost", "camera frames lost so far"), head("age", "since its last camera frame, ms"))),
    el("tbody", {}, rows))),
    el("p", { class: "muted" }, "Over 1 s, below it the worst such second within 10 s. delay: from taking to sending, by the camera's own clock.")];
}
