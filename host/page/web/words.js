// words: labels on the field: finds a place for each where it hides no other and no robot. Beside what it belongs to where there is
// room, else a little farther off, else it is left out.

import { faint, stroke } from "./colours.js";
import { on } from "./store.js";

const SIZE = 12;
const LINE = 15;
/** Directions from the anchor in which a label may stand, the preferred first: below, above, right, left, and the corners. */
const BELOW = [[0, 1], [0, -1], [1, 0], [-1, 0], [1, 1], [-1, 1], [1, -1], [-1, -1]];
const ABOVE = [[0, -1], [0, 1], [1, 0], [-1, 0], [1, -1], [-1, -1], [1, 1], [-1, 1]];

export class Words {
  constructor() {
    this.taken = [];
    this.asked = [];
  }

  /** Reserves the place of a robot, CSS pixels. */
  keepFree([x, y], radius) {
    this.taken.push(x - radius, y - radius, x + radius, y + radius);
  }

  /** Requests a label at a place, CSS pixels, `gap` away from it; `middle`: on it where there is room. Higher ranks come first. */
  ask({ key, at, text, tone, gap, above = false, middle = false, rank = 0 }) {
    this.asked.push({ key, at, text, tone, gap, above, middle, rank });
  }

  /** Finds places and draws; the transform is left as it was found. */
  draw({ context, ratio }) {
    [this.wide, this.high] = [context.canvas.width / ratio, context.canvas.height / ratio];
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    for (const word of this.asked.sort((a, b) => b.rank - a.rank)) {
      const picture = pictureOf(word.text, word.tone, ratio);
      const spot = this.place(word, picture.wide);
      if (spot) context.drawImage(picture.image, Math.round(spot[0] * ratio) - picture.rim, Math.round(spot[1] * ratio) - picture.rim);
    }
    context.restore();
  }

  /** Tries one place after the other; a flat list of boxes and no new objects, as this is done for every label of every frame. */
  place({ key, at: [x, y], gap, above, middle }, wide) {
    const ways = above ? ABOVE : BELOW;
    const last = stood.get(key);
    for (let n = last === undefined ? 0 : -1; n < 2 * ways.length + 1; n++) {
      const i = n < 0 ? last : n;
      if (i === 0 && !middle) continue;
      const [along, down] = i === 0 ? HERE : ways[(i - 1) % ways.length];
      const off = i > ways.length ? gap + LINE : gap;
      const left = x + along * (off + wide / 2) - wide / 2;
      const top = y + down * (off + LINE / 2) - LINE / 2;
      if (!this.isFree(left, top, left + wide, top + LINE)) continue;
      // It stays where it stood in the frame before while there is room: labels that jump cannot be read. Farther off it does not stay.
      if (i <= ways.length) stood.set(key, i);
      else stood.delete(key);
      this.taken.push(left, top, left + wide, top + LINE);
      return [left, top];
    }
    stood.delete(key);
    return null;
  }

  isFree(left, top, right, bottom) {
    const { taken } = this;
    if (left < 0 || top < 0 || right > this.wide || bottom > this.high) return false;
    for (let i = 0; i < taken.length; i += 4) {
      if (left < taken[i + 2] && right > taken[i] && top < taken[i + 3] && bottom > taken[i + 1]) return false;
    }
    return true;
  }
}

const HERE = [0, 0];
const stood = new Map();

/** Labels drawn once and kept: letters with a rim are expensive to draw, and most labels stay for many frames. */
const pictures = new Map();
const PICTURES_MAX = 600;
on("colours", () => pictures.clear());
const rule = new OffscreenCanvas(1, 1).getContext("2d");

function pictureOf(text, tone, ratio) {
  const key = `${tone} ${ratio} ${text}`;
  if (pictures.has(key)) return pictures.get(key);
  if (pictures.size >= PICTURES_MAX) pictures.clear();
  const font = `500 ${SIZE}px system-ui, "DejaVu Sans", sans-serif`;
  rule.font = font;
  const wide = rule.measureText(text).width;
  const rim = Math.ceil(3 * ratio);
  const canvas = new OffscreenCanvas(Math.ceil(wide * ratio) + 2 * rim, Math.ceil(LINE * ratio) + 2 * rim);
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, rim, rim);
  context.font = font;
  context.textBaseline = "middle";
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = faint("back", 0.8);
  context.strokeText(text, 0, LINE / 2);
  context.fillStyle = stroke(tone);
  context.fillText(text, 0, LINE / 2);
  const picture = { image: canvas.transferToImageBitmap(), wide, rim };
  pictures.set(key, picture);
  return picture;
}
