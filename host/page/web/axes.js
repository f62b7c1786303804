// axes: ticks of an axis: at round numbers, with their unit; times as on the clock.

import { colours, faint } from "./colours.js";
import { clock } from "./dom.js";

/** The step between ticks at round numbers, of which at most `most` fit. */
export function stepOf(low, high, most) {
  const rough = Math.max((high - low) / Math.max(1, most), 1e-6);
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * ([1, 2, 5, 10].find((factor) => factor * power >= rough * (1 - 1e-9)) ?? 10);
}

/** Round numbers from `low` to `high`. */
export function ticksOf(low, high, most) {
  const step = stepOf(low, high, most);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; i++) ticks.push(i * step);
  return ticks;
}

/** Number of digits that distinguishes two ticks. */
export const digitsOf = (step) => Math.max(0, Math.min(6, -Math.floor(Math.log10(step) + 1e-9)));

/** Lowest and highest shown of these values: 0 is among them where all are on one side of it and near. */
export function rangeOf(values, limit) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) [low, high] = [Math.min(low, value), Math.max(high, value)];
  if (low > high) [low, high] = [0, 1];
  if (limit != null && high > limit / 2) high = Math.max(high, limit);
  if (low > 0 && low < high / 2) low = 0;
  if (high - low < 1e-6) [low, high] = [low - Math.max(0.5, Math.abs(low) * 0.1), high + Math.max(0.5, Math.abs(high) * 0.1)];
  const margin = (high - low) * 0.06;
  return [low === 0 ? 0 : low - margin, high + margin];
}

/** Where times and values lie on a canvas, CSS pixels. */
export class Axes {
  constructor(context, [width, height], [first, last], [low, high], unit) {
    Object.assign(this, { context, width, height, first, last, low, high, unit, left: 46, right: width - 8, top: 8, bottom: height - 18 });
  }

  x(t) {
    return this.left + ((t - this.first) / Math.max(1e-3, this.last - this.first)) * (this.right - this.left);
  }

  y(value) {
    return this.bottom - ((value - this.low) / (this.high - this.low)) * (this.bottom - this.top);
  }

  timeAt(x) {
    return this.first + (Math.min(1, Math.max(0, (x - this.left) / (this.right - this.left)))) * (this.last - this.first);
  }

  draw() {
    const { context } = this;
    context.font = `11px system-ui, "DejaVu Sans", sans-serif`;
    context.lineWidth = 1;
    const most = Math.max(2, Math.floor((this.bottom - this.top) / 26));
    const digits = digitsOf(stepOf(this.low, this.high, most));
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const tick of ticksOf(this.low, this.high, most)) {
      const y = Math.round(this.y(tick)) + 0.5;
      this.line(this.left, y, this.right, y, faint("plain", 0.22));
      context.fillStyle = colours.dim;
      context.fillText(tick.toFixed(digits), this.left - 4, Math.max(y, 6));
    }
    context.textAlign = "left";
    context.textBaseline = "top";
    context.fillStyle = colours.dim;
    context.fillText(this.unit, this.left + 4, this.top);
    context.textBaseline = "top";
    const seconds = this.last - this.first;
    const wanted = [0.5, 1, 2, 5, 10, 30, 60, 120, 300, 600, 1200].find((step) => step >= seconds / Math.max(2, (this.right - this.left) / 64)) ?? 3600;
    for (let i = Math.ceil(this.first / wanted); i * wanted <= this.last; i++) {
      const x = Math.round(this.x(i * wanted)) + 0.5;
      this.line(x, this.top, x, this.bottom, faint("plain", 0.12));
      context.fillStyle = colours.dim;
      context.textAlign = x > this.right - 16 ? "right" : x < this.left + 16 ? "left" : "center";
      context.fillText(clock(i * wanted, wanted < 1 ? 1 : 0), x, this.bottom + 4);
    }
    this.line(this.left, this.top, this.left, this.bottom, colours.dim);
    this.line(this.left, this.bottom, this.right, this.bottom, colours.dim);
  }

  line(x, y, x2, y2, colour, dashes = []) {
    const { context } = this;
    context.strokeStyle = colour;
    context.setLineDash(dashes);
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x2, y2);
    context.stroke();
    context.setLineDash([]);
  }

  /** A line through `[t, value]`; where nothing came for longer than `gap` seconds it is broken. */
  course(points, colour, dashes, gap) {
    const { context } = this;
    context.strokeStyle = colour;
    context.lineWidth = 1.6;
    context.setLineDash(dashes);
    context.beginPath();
    let before = -Infinity;
    for (const [t, value] of points) {
      if (t - before > gap) context.moveTo(this.x(t), this.y(value));
      else context.lineTo(this.x(t), this.y(value));
      before = t;
    }
    context.stroke();
    context.setLineDash([]);
    context.lineWidth = 1;
  }
}

/** A canvas made ready to draw on in CSS pixels; none while it is not laid out. */
export function ready(canvas, [width, height]) {
  if (width === 0 || height === 0) return null;
  const ratio = devicePixelRatio || 1;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  return context;
}
