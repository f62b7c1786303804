// plot: plot with axes of any gauge, or of any robots: a cursor shows values, a click goes to its time.

import { Axes, rangeOf, ready } from "./axes.js";
import { colours, faint, stroke } from "./colours.js";
import { OF_ROBOTS, pointsOf, valueAt } from "./course.js";
import { clock, el, fill, number, say, sizeOf } from "./dom.js";
import { changed, on, recall, remember, store } from "./store.js";
import { seek, span, time } from "./transport.js";

/** What is plotted: the robots' number or gauge, seconds shown (0: the whole match), and robots. */
const chosen = { name: "speed", seconds: 30, robots: ["blue0"], ...recall("plot", {}) };
/** The time under the cursor, s; none while there is none. */
let cursor = null;
let axes = null;
let drawn = "";
let lines = [];

/** Lines of robots are distinguished by their dashes too. */
const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3], [4, 2], [1, 2]];

const ofRobots = () => OF_ROBOTS.find(([key]) => key === chosen.name);
const gap = () => (chosen.seconds ? 0.5 : 2.5);

function range() {
  const [first, last] = span();
  if (!chosen.seconds) return [first, Math.max(last, first + 1)];
  // The shown moment stays in sight, with what followed it where that is known.
  const end = Math.min(Math.max(last, first + chosen.seconds), Math.max(time.live ? last : time.at + chosen.seconds * 0.25, first + chosen.seconds));
  return [end - chosen.seconds, end];
}

function choose(change) {
  Object.assign(chosen, change);
  remember("plot", chosen);
  drawn = "";
  changed("panels");
}

/** Shows a gauge in the plot. */
export const plotGauge = (name) => choose({ name });

export function buildPlot() {
  const canvas = el("canvas", { id: "plot", class: "plot-large", tabindex: "0", role: "slider", "aria-label": "Plot: arrows move the cursor, Enter goes to its time", "aria-valuemin": "0" });
  const at = (event) => axes?.timeAt(event.offsetX);
  const move = (t) => {
    cursor = t;
    drawn = "";
    changed("panels");
  };
  canvas.addEventListener("pointermove", (event) => move(at(event)));
  canvas.addEventListener("pointerleave", () => move(null));
  canvas.addEventListener("click", (event) => axes && seek(at(event), false));
  canvas.addEventListener("blur", () => move(null));
  canvas.addEventListener("keydown", (event) => {
    if (!axes) return;
    const step = (axes.last - axes.first) / 100;
    const by = { ArrowLeft: -1, ArrowRight: 1, PageDown: -10, PageUp: 10 }[event.key];
    const to = { Home: axes.first, End: axes.last }[event.key];
    if (by !== undefined) move(Math.min(axes.last, Math.max(axes.first, (cursor ?? time.at) + by * step)));
    else if (to !== undefined) move(to);
    else if (event.key === "Enter") seek(cursor ?? time.at, false);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  return [
    el("div", { class: "field-set" },
      el("select", { id: "plot-name", "aria-label": "Plotted number", onchange: (event) => choose({ name: event.target.value }) }),
      el("select", { id: "plot-seconds", "aria-label": "Plotted time", onchange: (event) => choose({ seconds: Number(event.target.value) }) },
        [[10, "10 s"], [30, "30 s"], [60, "1 min"], [0, "match"]].map(([n, words]) => el("option", { value: n, selected: n === chosen.seconds }, words)))),
    el("div", { class: "field-set", id: "plot-robots", role: "group", "aria-label": "Plotted robots" }),
    canvas,
    el("p", { id: "plot-values", class: "muted" }),
  ];
}

function chooser(scene) {
  const gauges = scene.gauges.map((gauge) => [`${gauge.group}/${gauge.name}`, gauge]);
  const select = document.getElementById("plot-name");
  if (select === document.activeElement) return;
  fill(select, gauges.map(([name]) => name).join() + chosen.name, () => {
    const option = (value, words) => el("option", { value, selected: value === chosen.name }, words);
    const groups = Map.groupBy ? [...Map.groupBy(gauges, ([, gauge]) => gauge.group)] : [["numbers", gauges]];
    return [el("optgroup", { label: "robots" }, OF_ROBOTS.map(([key, words]) => option(key, words))),
      ...groups.map(([group, list]) => el("optgroup", { label: group }, list.map(([name, gauge]) => option(name, gauge.name))))];
  });
  const robots = scene.robots.map((robot) => [robot.team, robot.id]).sort((a, b) => a[0].localeCompare(b[0]) || a[1] - b[1]);
  const set = document.getElementById("plot-robots");
  set.hidden = !ofRobots();
  fill(set, JSON.stringify([robots, chosen.robots]), () => robots.map(([team, id]) => {
    const key = `${team}${id}`;
    const on = chosen.robots.includes(key);
    const toggle = () => choose({ robots: on ? chosen.robots.filter((one) => one !== key) : [...chosen.robots, key] });
    return el("button", { class: `chip ${team}${on ? " picked" : ""}`, "data-plot-robot": key, "aria-pressed": String(on), "aria-label": `${team} ${id}`, onclick: toggle }, String(id));
  }));
}

const colourOf = (robot) => stroke(robot?.startsWith("yellow") ? "yellow" : robot ? "blue" : "accent");

export function showPlot(scene) {
  chooser(scene);
  const canvas = document.getElementById("plot");
  const size = sizeOf(canvas);
  const fine = chosen.seconds > 0;
  const [first, last] = range();
  const key = [size, chosen.name, chosen.robots, chosen.seconds, Math.round(last * (fine ? 4 : 1)), Math.round(time.at * 10), store.samples.length, cursor].join();
  if (key === drawn) return;
  drawn = key;
  const of = ofRobots();
  lines = (of ? chosen.robots : [null]).map((robot) => ({ robot, points: pointsOf(robot, chosen.name, [first, last], fine) }));
  const context = ready(canvas, size);
  if (!context) return;
  const gauge = scene.gauges.find((one) => `${one.group}/${one.name}` === chosen.name);
  const limit = gauge?.limit == null ? null : Math.abs(gauge.limit);
  const unit = of ? of[2] : gauge?.unit ?? "";
  axes = new Axes(context, size, [first, last], rangeOf(lines.flatMap(({ points }) => points.map(([, value]) => value)), limit), unit);
  context.fillStyle = faint("plain", 0.05);
  context.fillRect(axes.left, axes.top, axes.right - axes.left, axes.bottom - axes.top);
  axes.draw();
  if (limit != null && limit <= axes.high && limit >= axes.low) axes.line(axes.left, axes.y(limit), axes.right, axes.y(limit), colours.bad, [4, 4]);
  lines.forEach(({ robot, points }, i) => axes.course(points, colourOf(robot), DASHES[i % DASHES.length], gap()));
  if (time.at >= first && time.at <= last) axes.line(axes.x(time.at), axes.top, axes.x(time.at), axes.bottom, colours.text);
  if (cursor !== null) axes.line(axes.x(cursor), axes.top, axes.x(cursor), axes.bottom, colours.accent, [3, 3]);
  describe(canvas, unit);
}

/** Values at the cursor, or at the shown moment. */
function describe(canvas, unit) {
  const t = cursor ?? time.at;
  const value = ({ robot, points }) => `${robot ? robot.replace(/(\d+)$/, " $1") + " " : ""}${number(valueAt(points, t, gap() + 0.6), 2)} ${unit}`;
  const none = lines.length === 0 ? "no robot is chosen" : lines.every(({ points }) => points.length === 0) ? "nothing is known of this time" : null;
  const words = `${clock(t)}: ${none ?? lines.map(value).join(", ")}`;
  say(document.getElementById("plot-values"), words);
  canvas.setAttribute("aria-valuemax", number(axes.last, 1));
  canvas.setAttribute("aria-valuenow", number(t, 1));
  canvas.setAttribute("aria-valuetext", words);
}

on("course", () => {
  drawn = "";
  changed("panels");
});
on("colours", () => (drawn = ""));
