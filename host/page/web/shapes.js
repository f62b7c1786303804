// shapes: drawing of a layer's shapes: any layer that the program names, from plain shapes whose meaning the program knows.

import { faint, stroke } from "./colours.js";
import { drawHeat, heatNote } from "./heat.js";
import { on } from "./store.js";

export function drawShapes(pen, { name, shapes }) {
  shapes.forEach((shape, i) => DRAW[shape.is]?.(pen, shape, `${name} ${i}`));
}

function finish({ context, pixel }, shape, fill) {
  if (fill) {
    context.fillStyle = shape.tone === "forbidden" ? hatch(context, pixel) : faint(shape.tone, 0.13);
    context.fill();
  }
  context.strokeStyle = faint(shape.tone, 0.85);
  context.lineWidth = 1.3 * pixel;
  context.stroke();
}

let hatched = null;
on("colours", () => (hatched = null));

/** What is to be kept out of is hatched: it differs from the rest without any colour. */
function hatch(context, pixel) {
  if (!hatched) {
    const tile = new OffscreenCanvas(8, 8);
    const pen = tile.getContext("2d");
    pen.fillStyle = faint("forbidden", 0.08);
    pen.fillRect(0, 0, 8, 8);
    pen.strokeStyle = faint("forbidden", 0.4);
    for (const from of [-8, 0, 8]) {
      pen.moveTo(from, 8);
      pen.lineTo(from + 8, 0);
    }
    pen.stroke();
    hatched = context.createPattern(tile, "repeat");
  }
  hatched.setTransform(new DOMMatrix([pixel, 0, 0, pixel, 0, 0]));
  return hatched;
}

function trace(context, points) {
  context.beginPath();
  points.forEach(([x, y], i) => (i ? context.lineTo(x, y) : context.moveTo(x, y)));
}

const DRAW = {
  ellipse(pen, shape) {
    pen.context.beginPath();
    pen.context.ellipse(shape.at[0], shape.at[1], shape.radii[0], shape.radii[1], 0, 0, 2 * Math.PI);
    finish(pen, shape, shape.fill);
  },
  polygon(pen, shape) {
    trace(pen.context, shape.points);
    pen.context.closePath();
    finish(pen, shape, shape.fill);
  },
  capsule(pen, shape) {
    const { context } = pen;
    const [[x0, y0], [x1, y1], r] = [shape.from, shape.to, shape.radius];
    const along = Math.atan2(y1 - y0, x1 - x0);
    context.beginPath();
    context.arc(x0, y0, r, along + Math.PI / 2, along - Math.PI / 2);
    context.arc(x1, y1, r, along - Math.PI / 2, along + Math.PI / 2);
    context.closePath();
    finish(pen, shape, true);
  },
  line({ context, pixel }, shape) {
    if (shape.points.length < 2) return;
    context.strokeStyle = stroke(shape.tone);
    context.lineWidth = 1.5 * pixel;
    if (shape.dashed) context.setLineDash([6 * pixel, 4 * pixel]);
    trace(context, shape.points);
    context.stroke();
    context.setLineDash([]);
    if (!shape.arrow) return;
    const [[x0, y0], [x, y]] = shape.points.slice(-2);
    const along = Math.atan2(y - y0, x - x0);
    context.beginPath();
    for (const side of [-1, 1]) {
      context.moveTo(x, y);
      context.lineTo(x - 8 * pixel * Math.cos(along + side * 0.45), y - 8 * pixel * Math.sin(along + side * 0.45));
    }
    context.stroke();
  },
  text({ camera, words, robot }, shape, key) {
    words.ask({ key, at: camera.to(shape.at), text: shape.text, tone: shape.tone, gap: robot, above: true, middle: true, rank: 1 });
  },
  heat: drawHeat,
};

/** Notes of the shapes under a point, the topmost first. */
export function noteAt(layers, shown, [x, y]) {
  for (const layer of [...layers].reverse()) {
    if (!shown(layer.name, layer.on)) continue;
    for (const shape of [...layer.shapes].reverse()) {
      const note = shape.is === "heat" ? heatNote(shape, x, y) : shape.note && contains(shape, x, y) ? shape.note : null;
      if (note) return note;
    }
  }
  return null;
}

/** What layers say of a robot: the notes of rings about it. */
export function notesOf(layers, shown, robot) {
  const about = (shape) => shape.is === "ellipse" && shape.note && !shape.fill && Math.hypot(shape.at[0] - robot.at[0], shape.at[1] - robot.at[1]) < NEAR;
  return layers.filter((layer) => shown(layer.name, layer.on)).flatMap((layer) => layer.shapes.filter(about).map((shape) => shape.note));
}

/** A ring belongs to a robot whose centre is so near to its own, m: what layers were made from may be a moment older. */
const NEAR = 0.05;

function contains(shape, x, y) {
  if (shape.is === "ellipse") return ((x - shape.at[0]) / shape.radii[0]) ** 2 + ((y - shape.at[1]) / shape.radii[1]) ** 2 <= 1;
  if (shape.is === "capsule") {
    const [dx, dy] = [shape.to[0] - shape.from[0], shape.to[1] - shape.from[1]];
    const along = ((x - shape.from[0]) * dx + (y - shape.from[1]) * dy) / (dx * dx + dy * dy || 1);
    const u = Math.min(1, Math.max(0, along));
    return Math.hypot(x - shape.from[0] - u * dx, y - shape.from[1] - u * dy) <= shape.radius;
  }
  if (shape.is !== "polygon") return false;
  let inside = false;
  shape.points.forEach(([x0, y0], i) => {
    const [x1, y1] = shape.points[(i + 1) % shape.points.length];
    if (y0 > y !== y1 > y && x < ((x1 - x0) * (y - y0)) / (y1 - y0) + x0) inside = !inside;
  });
  return inside;
}
