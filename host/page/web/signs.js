// signs: legend of the field: every mark that a frame may show, drawn as it is drawn there, with its meaning.

import { byId, el } from "./dom.js";
import { changed } from "./store.js";

/** Marks by group: a drawing of 34 by 18, and what it stands for. */
const SIGNS = [
  ["Robots and ball", [
    ['<circle cx="17" cy="9" r="7" class="blue"/><text x="17" y="12.5" class="blue-ink">3</text>', "blue's robot; its flat side is its front"],
    ['<circle cx="17" cy="9" r="7" class="yellow"/><rect x="12.5" y="4.5" width="9" height="9" class="plate"/><text x="17" y="12.5" class="on-plate">3</text>', "yellow's robot, by its dark square"],
    ['<path d="M4 9h22m-5-4l5 4l-5 4" class="line"/>', "velocity: as far as it gets in a quarter of a second"],
    ['<circle cx="17" cy="9" r="7" class="line bad dashed"/>', "the robot reports a fault (tab Health)"],
    ['<circle cx="17" cy="9" r="7" class="line accent"/>', "the robot that you have chosen"],
    ['<circle cx="17" cy="9" r="5" class="ball"/>', "ball; paler where its place is doubtful, ringed in the air"],
    ['<path d="M3 13Q14 3 31 8" class="line ball-line"/>', "where the ball came from"],
    ['<path d="M3 9h28" class="line ball-line dashed"/>', "where it will roll"],
  ]],
  ["Plans", [
    ['<path d="M3 13Q14 3 24 9" class="line"/><circle cx="27" cy="9" r="3.5" class="line"/>', "a robot's path, and where it will stand"],
    ['<path d="M3 9h18" class="line ball-line dotted"/><path d="M22 9l5-5l5 5l-5 5z" class="line ball-line"/>', "where that robot wants the ball: pass or shot"],
    ['<ellipse cx="17" cy="9" rx="14" ry="7" class="case-area"/>', "scope of the case being played: ball or robot may be anywhere in it"],
    ['<path d="M4 4h22v10h-22zM8 9h20m-5-4l5 4l-5 4" class="line case-line"/>', "the ball's path in that case"],
    ['<circle cx="17" cy="9" r="5" class="line"/>', "a robot's place in it: robot → robot of the case"],
  ]],
  ["Rules", [
    ['<rect x="4" y="2" width="26" height="14" class="forbidden"/><path d="M4 16l12-14M14 16l12-14M24 16l6-7" class="line forbidden-line"/>', "hatched: robots must keep out now"],
    ['<circle cx="17" cy="9" r="5" class="line forbidden-line"/><path d="M9 9h16M17 1v16" class="line forbidden-line"/>', "where the referee wants the ball placed"],
  ]],
];

function drawing(shapes) {
  const picture = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  picture.setAttribute("viewBox", "0 0 34 18");
  picture.setAttribute("aria-hidden", "true");
  // The marks are this file's own text, none of it comes from outside.
  picture.innerHTML = shapes;
  return picture;
}

export function toggleSigns() {
  const panel = byId("signs");
  panel.hidden = !panel.hidden;
  byId("signs-open").setAttribute("aria-expanded", String(!panel.hidden));
  if (panel.firstChild) return;
  panel.append(...SIGNS.flatMap(([name, signs]) => [el("h2", {}, name), ...signs.map(([shapes, meaning]) => el("p", {}, drawing(shapes), meaning))]),
    el("p", { class: "muted" }, "Layers switches each of them on and off, and has more. A pointer on a shape shows its note."));
  changed("frame");
}

export function startSigns() {
  byId("signs-open").addEventListener("click", toggleSigns);
}
