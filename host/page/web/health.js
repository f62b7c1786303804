// health: tab Health: robots at a glance, their links and the cameras, a plot, the program's log, then gauges with their limits.

import { byId, el, fill, number } from "./dom.js";
import { buildLog, showLog } from "./log.js";
import { buildPlot, showPlot } from "./plot.js";
import { drawPlots, plotPart } from "./plots.js";
import { spectrum } from "./spectrum.js";
import { choose, store } from "./store.js";

export function showHealth() {
  const tab = byId("tab-health");
  const scene = store.scene;
  if (tab.hidden || !scene) return;
  if (!tab.firstChild) {
    tab.append(el("h2", {}, "Robots"), el("div", { id: "glance" }), el("h2", {}, "Links"), el("div", { id: "vitals" }), el("div", { id: "spectrum" }), el("h2", {}, "Cameras"), el("div", { id: "cameras" }), el("h2", {}, "Plot"), ...buildPlot(),
      el("h2", {}, "Program log"), ...buildLog(), el("h2", {}, "Course of the match"), el("div", { id: "plots" }));
  }
  const robots = scene.robots.filter((robot) => robot.vitals);
  const second = Math.floor(scene.t * 2);
  fill(byId("glance"), `${second}`, () => glance(scene.glance ?? []));
  fill(byId("vitals"), `${second} ${robots.length}`, () => vitals(robots));
  const channels = store.state.spectrum;
  fill(byId("spectrum"), JSON.stringify(channels ?? null), () => (channels ? spectrum(channels) : []));
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

/** Our robots, each beside what it should have. */
function glance(list) {
  if (list.length === 0) return el("p", { class: "muted" }, "No robot of ours is seen or heard.");
  const numeric = (text, bad) => el("td", { class: `n${bad ? " bad" : ""}` }, text);
  const rows = list.map((one) => el("tr", { class: "pick", onclick: () => choose(one.team, one.shell) },
    el("td", {}, el("button", { class: `chip ${one.team}`, "data-glance": `${one.team}${one.shell}`, "aria-label": `${one.team} ${one.shell}` }, String(one.shell))),
    numeric(String(one.radio), false),
    el("td", { class: one.cameras[0]?.[1] <= 200 ? "" : "bad" }, one.cameras.map(([camera, ms]) => `${camera}: ${age(ms)}`).join(", ") || "never"),
    numeric(age(one.heard_ms), !(one.heard_ms <= 200)), numeric(number(one.battery), one.faults.includes("battery low")),
    el("td", { class: one.faults.length ? "bad" : "fine" }, one.faults.join(", ") || "none"),
    el("td", {}, one.version ?? (one.case_base ? `cases ${one.case_base}` : "–")),
    el("td", { class: one.wrong.length ? "bad" : "fine" }, one.wrong.join(" ") || "ok")));
  return [scroll("Robots at a glance", el("table", { class: "tight" },
    el("thead", {}, el("tr", {}, el("th", { scope: "col", title: "number on the shell" }, "shell"), head("radio", "number that it was flashed with: numbers.radio, in Parameters"), el("th", { scope: "col", title: "number of each camera, and how long ago it detected the robot" }, "seen by camera"),
      head("heard", "since its last frame"), head("V", "battery voltage"), el("th", { scope: "col" }, "faults"), el("th", { scope: "col", title: "firmware, and hashes of its image's sources, robot.toml and case base" }, "runs"), el("th", { scope: "col", title: "what it should have and has not, with the remedy" }, "beside what it should be"))),
    el("tbody", {}, rows)))];
}

/** Time since something, from ms. */
const age = (ms) => (ms == null ? "never" : ms < 1000 ? `${ms} ms` : `${Math.floor(ms / 1000)} s`);

function vitals(robots) {
  if (robots.length === 0) return el("p", { class: "muted" }, "No robot reports its state.");
  const cell = (value, digits, bad) => el("td", { class: `n${bad ? " bad" : ""}` }, number(value, digits));
  const rows = robots.map(({ team, id, vitals: v }) => el("tr", { class: "pick", title: `${v.refused} frames refused, ${v.lives === 1 ? "booted once" : `booted ${v.lives} times`}`, onclick: () => choose(team, id) },
    el("td", {}, el("button", { class: `chip ${team}`, "data-vitals": `${team}${id}`, "aria-label": `${team} ${id}` }, String(id))),
    el("td", { class: v.faults.length ? "bad" : "fine" }, v.faults.join(", ") || [v.ball ? "ball" : "", v.governed ? "limited" : ""].filter(Boolean).join(", ") || "ok", el("small", { class: "muted" }, v.kicker ? "charged" : "not charged")),
    windowed(v.link?.trip_ms, 1, over(40)), windowed(v.link?.loss_down, 1, over(10)), windowed(v.link?.loss_up, 1, over(10)),
    windowed(v.link?.frames, 0, under(10)), windowed(v.link?.telemetry, 0, under(2)), windowed(v.link?.kbps, 0, () => false),
    cell(v.telemetry_ms, 0, v.telemetry_ms > 500)));
  return [scroll("Robots and their links", el("table", { class: "tight" },
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "robot"), el("th", { scope: "col", title: "faults, else what it does; below it the kicker's capacitor" }, "state"), head("RTT", "mean round-trip time of the radio, ms"), head("loss ↓", "frames lost on the way to the robot, %"), head("↑ %", "frames lost on the way from it, %"),
      head("fr/s", "frames received a second"), head("tel/s", "telemetry received a second"), head("kbit/s", "frames of both directions"), head("report", "since its last telemetry, ms"))),
    el("tbody", {}, rows))),
    el("p", { class: "muted" }, "RTT to kbit/s: over 1 s, below it the worst such second within 10 s. report: ms since its telemetry. Capacitor voltage and temperatures: not reported, telemetry has no field for them."),
    ...packets(robots.filter(({ vitals: v }) => v.air))];
}

/** Packets of a base station that counts them, a row a robot. */
function packets(robots) {
  if (robots.length === 0) return [];
  const share = (part, all) => el("td", { class: `n${part > 0.1 * all ? " bad" : ""}` }, all ? number((100 * part) / all, 1) : "–");
  const rows = robots.map(({ team, id, vitals: { air } }) => el("tr", {}, el("td", {}, `${team} ${id}`),
    el("td", { class: "n" }, String(air.channel)), el("td", { class: "n" }, String(air.megabits)), el("td", { class: "n" }, String(air.sent)),
    el("td", { class: "n" }, String(air.acknowledged)), el("td", { class: "n" }, String(air.repeats)), el("td", { class: "n" }, String(air.lost)), share(air.lost, air.sent)));
  return [scroll("Packets of the base station", el("table", { class: "tight" },
    el("thead", {}, el("tr", {}, el("th", { scope: "col" }, "robot"), head("channel", "MHz above 2400"), head("Mbit/s", "rate on the air"), head("sent", "packets to the robot since the base station's start"),
      head("acked", "acknowledged by the robot's chip"), head("repeats", "repeats of packets"), head("lost", "not acknowledged in any repeat"), head("lost %", "of those sent"))),
    el("tbody", {}, rows)))];
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
