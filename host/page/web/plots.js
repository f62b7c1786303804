// plots: small plots over the match: a line for each gauge, its limit dashed, the shown moment marked.

import { colours, faint } from "./colours.js";
import { Axes, rangeOf, ready } from "./axes.js";
import { sampleOf } from "./course.js";
import { clock, el, fill, number } from "./dom.js";
import { plotGauge } from "./plot.js";
import { on, store } from "./store.js";
import { seek, span, time } from "./transport.js";

let sampled = -1;

// One sample a second, as the program keeps them: the page adds those that come while it is open.
on("newest", (scene) => {
  const second = Math.floor(scene.t);
  if (second === sampled) return;
  sampled = second;
  const last = store.samples.at(-1);
  if (last && Math.floor(last.t) >= second) return;
  store.samples.push(sampleOf(scene));
});

export function plotPart(into, scene) {
  const groups = new Map();
  for (const gauge of scene.gauges) groups.set(gauge.group, [...(groups.get(gauge.group) ?? []), gauge]);
  fill(into, scene.gauges.map((gauge) => `${gauge.group}/${gauge.name}`).join(), () => [...groups].flatMap(([group, gauges]) => [
    el("h2", {}, group),
    ...gauges.flatMap((gauge) => {
      const name = `${gauge.group}/${gauge.name}`;
      return [
        el("div", { class: "plot-head" }, el("button", { class: "plain", title: "Show it large, with a cursor", "data-large": name, onclick: () => { plotGauge(name); document.getElementById("plot").focus(); } }, gauge.name), el("b", { "data-value": name }, "")),
        el("canvas", { class: "plot", role: "img", "aria-label": `Course of ${gauge.name}; a click goes there`, "data-plot": name, "data-unit": gauge.unit, "data-limit": gauge.limit ?? "", onclick: (event) => lies.has(event.target) && seek(lies.get(event.target).timeAt(event.offsetX), false), onpointermove: (event) => hover(event) }),
      ];
    }),
  ]));
  for (const gauge of scene.gauges) {
    const slot = into.querySelector(`[data-value="${CSS.escape(`${gauge.group}/${gauge.name}`)}"]`);
    if (!slot) continue;
    slot.textContent = `${number(gauge.value, Math.abs(gauge.value) < 10 ? 2 : 0)} ${gauge.unit}`;
    const over = gauge.limit != null && (gauge.limit < 0 ? gauge.value < -gauge.limit : gauge.value > gauge.limit);
    slot.style.color = over ? "var(--bad)" : "";
  }
}

/** So many plots are drawn in one frame: all at once would cost it what it has. */
const AT_ONCE = 3;
const inSight = new WeakSet();
const watching = new IntersectionObserver((entries) => entries.forEach(({ target, isIntersecting }) => (isIntersecting ? inSight.add(target) : inSight.delete(target))));

export function drawPlots(into) {
  const key = `${Math.floor(time.at)} ${store.samples.length} ${into.clientWidth} ${document.documentElement.dataset.theme}`;
  let left = AT_ONCE;
  for (const canvas of into.querySelectorAll("canvas")) {
    if (!canvas.dataset.watched) {
      canvas.dataset.watched = "yes";
      watching.observe(canvas);
    }
    if (left === 0 || canvas.dataset.drawn === key || !inSight.has(canvas)) continue;
    canvas.dataset.drawn = key;
    left -= 1;
    draw(canvas);
  }
}

/** Where times lie on each canvas. */
const lies = new WeakMap();

/** The value at the pointer. */
function hover(event) {
  const axes = lies.get(event.target);
  if (!axes) return;
  const t = axes.timeAt(event.offsetX);
  const sample = store.samples.findLast((one) => one.t <= t);
  const value = sample?.values[event.target.dataset.plot];
  event.target.title = `${clock(t)}: ${number(value, 2)} ${event.target.dataset.unit}`;
}

function draw(canvas) {
  const size = [canvas.clientWidth, canvas.clientHeight];
  const context = ready(canvas, size);
  if (!context) return;
  const name = canvas.dataset.plot;
  const points = store.samples.filter((sample) => sample.values[name] !== undefined).map((sample) => [sample.t, sample.values[name]]);
  const limit = canvas.dataset.limit === "" ? null : Math.abs(Number(canvas.dataset.limit));
  const [first, last] = span();
  const axes = new Axes(context, size, [first, Math.max(last, first + 1)], rangeOf(points.map(([, value]) => value), limit), canvas.dataset.unit);
  lies.set(canvas, axes);
  context.fillStyle = faint("plain", 0.05);
  context.fillRect(axes.left, axes.top, axes.right - axes.left, axes.bottom - axes.top);
  axes.draw();
  if (limit != null && limit <= axes.high && limit >= axes.low) axes.line(axes.left, axes.y(limit), axes.right, axes.y(limit), colours.bad, [4, 4]);
  axes.course(points, colours.accent, [], 2.5);
  axes.line(axes.x(time.at), axes.top, axes.x(time.at), axes.bottom, colours.text);
}
