// timeline: timeline of events: a row for each kind of event under the ruler; a click goes there.

import { colours, faint, stroke } from "./colours.js";
import { byId, clock, sizeOf } from "./dom.js";
import { on, store } from "./store.js";
import { seek, span, time } from "./transport.js";

/** Rows from above, and the kinds in each. */
const ROWS = [["referee", ["command", "stage", "event"]], ["fouls", ["foul", "fault"]], ["cases", ["case", "cycle"]], ["ball", ["kick"]]];
const LEFT = 52;

let drawn = "";

const x = (t, width) => LEFT + ((t - span()[0]) / Math.max(1, span()[1] - span()[0])) * (width - LEFT - 8);

export function tone(matchEvent) {
  if (matchEvent.kind === "foul" || matchEvent.kind === "fault") return colours.forbidden;
  if (matchEvent.kind === "case") return colours.case;
  return stroke(matchEvent.team ?? "plain");
}

export function drawTimeline(force = false) {
  const canvas = byId("timeline");
  const ratio = devicePixelRatio || 1;
  const [width, height] = sizeOf(canvas);
  if (width === 0) return;
  const key = [width, height, ratio, store.matchEvents.length, store.marks.length, Math.round(x(time.at, width) * 2), Math.round(span()[1])].join();
  if (!force && key === drawn) return;
  drawn = key;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  ruler(context, width, height);
  const step = (height - 15) / ROWS.length;
  context.font = `11px system-ui, "DejaVu Sans", sans-serif`;
  context.textBaseline = "middle";
  ROWS.forEach(([name, kinds], row) => {
    const y = 14 + row * step;
    context.textAlign = "left";
    if (step > 9) {
      context.fillStyle = colours.dim;
      context.fillText(name, 2, y + step / 2);
    }
    context.fillStyle = faint("plain", 0.07);
    context.fillRect(LEFT, y + 1, width - LEFT - 8, step - 2);
    for (const matchEvent of store.matchEvents) {
      if (!kinds.includes(matchEvent.kind)) continue;
      context.fillStyle = tone(matchEvent);
      context.globalAlpha = matchEvent.kind === "cycle" ? 0.45 : 1;
      // Yellow stands in the lower half of a row, blue in the upper one.
      const half = matchEvent.team ? step / 2 - 1.5 : step - 3;
      const top = y + 1.5 + (matchEvent.team === "yellow" ? step / 2 : 0);
      context.fillRect(x(matchEvent.t, width) - 1, top, matchEvent.kind === "cycle" ? 1 : 2.2, half);
    }
    context.globalAlpha = 1;
  });
  for (const goal of store.matchEvents.filter((h) => h.kind === "goal")) flag(context, x(goal.t, width), [width, height], stroke(goal.team ?? "ball"), `goal${goal.team ? ` ${goal.team}` : ""}`);
  for (const mark of store.marks) flag(context, x(mark.t, width), [width, height], colours.accent, "");
  context.fillStyle = colours.text;
  context.fillRect(x(time.at, width) - 1, 0, 2, height);
}

function ruler(context, width) {
  const [first, last] = span();
  const room = (last - first) / Math.max(1, (width - LEFT) / 70);
  const step = [1, 2, 5, 10, 30, 60, 120, 300, 600].find((s) => s >= room) ?? 1200;
  context.fillStyle = colours.dim;
  context.font = `11px system-ui, "DejaVu Sans", sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "top";
  for (let t = Math.ceil(first / step) * step; t <= last; t += step) context.fillText(clock(t, 0), x(t, width), 1);
}

function flag(context, at, [width, height], colour, words) {
  // At the right edge it waves to the left.
  const side = at > width - 84 ? -1 : 1;
  context.fillStyle = colour;
  context.fillRect(at - 1, 12, 2, height - 12);
  context.beginPath();
  context.moveTo(at, 11);
  context.lineTo(at + side * 9, 15);
  context.lineTo(at, 19);
  context.fill();
  if (words) {
    context.textAlign = side > 0 ? "left" : "right";
    context.textBaseline = "top";
    context.font = `600 11px system-ui, "DejaVu Sans", sans-serif`;
    // Upon the marks of the rows, with a rim.
    context.lineJoin = "round";
    context.lineWidth = 4;
    context.strokeStyle = colours.panel;
    context.strokeText(words, at + side * 11, 10);
    context.fillText(words, at + side * 11, 10);
  }
}

export function startTimeline() {
  const canvas = byId("timeline");
  const to = (event) => {
    const box = canvas.getBoundingClientRect();
    const share = (event.clientX - box.left - LEFT) / Math.max(1, box.width - LEFT - 8);
    const [first, last] = span();
    seek(first + Math.min(1, Math.max(0, share)) * (last - first));
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    to(event);
  });
  canvas.addEventListener("pointermove", (event) => event.buttons && to(event));
  canvas.addEventListener("mousemove", (event) => {
    const width = canvas.clientWidth;
    const near = store.matchEvents.filter((h) => Math.abs(x(h.t, width) - event.offsetX) < 4).slice(-3);
    canvas.title = near.map((h) => `${clock(h.t)}  ${h.words}`).join("\n") || "Blue in the upper half of a row, yellow in the lower one; a click goes there";
  });
  on("match-events", () => drawTimeline(true));
  on("colours", () => drawTimeline(true));
  on("panels", () => drawTimeline());
}
