// How did a number go over the match? A line a gauge, its limit dashed, the shown moment marked.

import { colours, faint } from "./colours.js";
import { el, fill, number } from "./dom.js";
import { on, store } from "./store.js";
import { span, time } from "./transport.js";

let sampled = -1;

// One sample a second, as the program keeps them: the page adds those that come while it looks on.
on("newest", (scene) => {
  const second = Math.floor(scene.t);
  if (second === sampled) return;
  sampled = second;
  const last = store.samples.at(-1);
  if (last && Math.floor(last.t) >= second) return;
  const values = Object.fromEntries(scene.gauges.map((gauge) => [`${gauge.group}/${gauge.name}`, gauge.value]));
  store.samples.push({ t: scene.t, values });
});

export function plotPart(into, scene) {
  const groups = new Map();
  for (const gauge of scene.gauges) groups.set(gauge.group, [...(groups.get(gauge.group) ?? []), gauge]);
  fill(into, scene.gauges.map((gauge) => `${gauge.group}/${gauge.name}`).join(), () => [...groups].flatMap(([group, gauges]) => [
    el("h2", {}, group),
    ...gauges.flatMap((gauge) => {
      const name = `${gauge.group}/${gauge.name}`;
      return [
        el("div", { class: "plot-head" }, el("span", {}, gauge.name), el("b", { "data-value": name }, "")),
        el("canvas", { class: "plot", "data-plot": name, "data-limit": gauge.limit ?? "" }),
      ];
    }),
  ]));
  for (const gauge of scene.gauges) {
    const slot = into.querySelector(`[data-value="${CSS.escape(`${gauge.group}/${gauge.name}`)}"]`);
    if (!slot) continue;
    slot.textContent = `${number(gauge.value, Math.abs(gauge.value) < 10 ? 2 : 0)} ${gauge.unit}`;
    const over = gauge.limit != null && (gauge.limit < 0 ? gauge.value < -gauge.limit : gauge.value > gauge.limit);
    slot.style.color = over ? colours.bad : "";
  }
}

export function drawPlots(into) {
  const key = `${Math.floor(time.at * 2)} ${store.samples.length} ${into.clientWidth} ${document.documentElement.dataset.theme}`;
  if (into.dataset.drawn === key) return;
  into.dataset.drawn = key;
  for (const canvas of into.querySelectorAll("canvas")) draw(canvas);
}

function draw(canvas) {
  const ratio = devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (width === 0) return;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const name = canvas.dataset.plot;
  const points = store.samples.filter((sample) => sample.values[name] !== undefined).map((sample) => [sample.t, sample.values[name]]);
  const limit = canvas.dataset.limit === "" ? null : Math.abs(Number(canvas.dataset.limit));
  const values = points.map(([, value]) => value);
  const top = Math.max(1e-6, ...values, limit != null && Math.max(...values, 0) > limit * 0.5 ? limit : 0) * 1.1;
  const low = Math.min(0, ...values);
  const [first, last] = span();
  const x = (t) => ((t - first) / Math.max(1, last - first)) * (width - 2) + 1;
  const y = (value) => height - 2 - ((value - low) / (top - low)) * (height - 6);
  context.fillStyle = faint("plain", 0.07);
  context.fillRect(0, 0, width, height);
  if (limit != null && limit <= top) {
    context.strokeStyle = colours.bad;
    context.setLineDash([4, 4]);
    context.beginPath();
    context.moveTo(0, y(limit));
    context.lineTo(width, y(limit));
    context.stroke();
    context.setLineDash([]);
  }
  context.strokeStyle = colours.accent;
  context.lineWidth = 1.5;
  context.beginPath();
  points.forEach(([t, value], i) => (i ? context.lineTo(x(t), y(value)) : context.moveTo(x(t), y(value))));
  context.stroke();
  context.fillStyle = colours.text;
  context.fillRect(x(time.at), 0, 1, height);
}
