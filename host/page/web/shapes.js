// How are a layer's shapes drawn? Any layer that the program names, from plain shapes; what they mean is the program's affair.

import { colours, faint } from "./colours.js";

export function drawShapes(pen, shapes) {
  for (const shape of shapes) DRAW[shape.is]?.(pen, shape);
}

function finish({ context, pixel }, shape, fill) {
  if (fill) {
    context.fillStyle = faint(shape.tone, 0.13);
    context.fill();
  }
  context.strokeStyle = faint(shape.tone, 0.85);
  context.lineWidth = 1.3 * pixel;
  context.stroke();
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
    context.strokeStyle = colours[shape.tone];
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
  text({ context, camera, ratio }, shape) {
    const [x, y] = camera.to(shape.at);
    context.save();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.font = `500 11px system-ui, "DejaVu Sans", sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.strokeStyle = faint("back", 0.75);
    context.lineWidth = 3;
    context.lineJoin = "round";
    context.strokeText(shape.text, x, y);
    context.fillStyle = colours[shape.tone];
    context.fillText(shape.text, x, y);
    context.restore();
  },
  heat({ context }, shape) {
    const picture = heatPicture(shape);
    const [[x0, y0], [x1, y1]] = [shape.low, shape.high];
    context.save();
    context.imageSmoothingEnabled = true;
    // Rows run from least y up, as the field does.
    context.drawImage(picture, x0, y0, x1 - x0, y1 - y0);
    context.restore();
  },
};

const pictures = new WeakMap();

/** A map of values as a picture of one pixel a cell, made once for each map: dark violet over orange to pale yellow. */
function heatPicture(shape) {
  if (pictures.has(shape)) return pictures.get(shape);
  const columns = Math.max(1, shape.columns);
  const rows = Math.max(1, Math.floor(shape.cells.length / columns));
  const picture = new OffscreenCanvas(columns, rows);
  const image = new ImageData(columns, rows);
  shape.cells.slice(0, columns * rows).forEach((value, i) => {
    const [r, g, b] = heatColour(value / 255);
    image.data.set([r, g, b, value === 0 ? 0 : 60 + value * 0.55], i * 4);
  });
  picture.getContext("2d").putImageData(image, 0, 0);
  pictures.set(shape, picture);
  return picture;
}

/** Rises in lightness all the way, so that it reads without hue too. */
const STOPS = [[42, 10, 74], [120, 28, 109], [188, 55, 84], [237, 105, 37], [251, 180, 26], [252, 255, 164]];

function heatColour(x) {
  const at = Math.min(0.9999, Math.max(0, x)) * (STOPS.length - 1);
  const [low, share] = [Math.floor(at), at % 1];
  return STOPS[low].map((from, i) => from + (STOPS[low + 1][i] - from) * share);
}

/** What is told of the shape under a point, the topmost first. */
export function noteAt(layers, shown, [x, y]) {
  for (const layer of [...layers].reverse()) {
    if (!shown(layer.name, layer.on)) continue;
    for (const shape of [...layer.shapes].reverse()) {
      if (shape.note && contains(shape, x, y)) return shape.note;
    }
  }
  return null;
}

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
