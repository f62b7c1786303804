// ghost: the case on the workbench, drawn on the field in one of its symmetries, with handles for pointer and keys.

import { colours, faint, stroke } from "./colours.js";
import { drawShapes } from "./shapes.js";
import { changed } from "./store.js";
import { bench, copyOf, edit, isOpen, preview } from "./workbench.js";

/** A hand may miss a handle by so much, CSS pixels. */
const REACH = 16;
/** A hand puts things on whole centimetres, mm. */
const GRID = 10;

const metres = ([x, y]) => [x / 1000, y / 1000];
const millimetres = (at) => at.map((x) => Math.round((x * 1000) / GRID) * GRID);

/** The point of an action, if it has one. */
export const pointOf = (action) => action.go_to_point ?? action.dribble_to ?? action.turn?.face ?? null;

/** What can be taken hold of: `key`, `part`, `at` in mm, `label`, and for a scope its axis and centre. */
export function handles(copy = copyOf()) {
  if (!copy) return [];
  const scopes = (part, { at, scope }) => [0, 1].map((axis) => ({
    key: `${part} scope ${"xy"[axis]}`, part, axis, centre: at, scope, label: `${part} scope ${"xy"[axis]}`,
    at: at.map((x, i) => (i === axis ? x + scope[axis] : x)),
  }));
  const actions = (robot, i) => robot.actions.flatMap((action, k) => {
    const part = `tm${i + 1}.${k + 1}`;
    const leg = copy.legs.find((one) => one.robot === i + 1 && one.number === k + 1);
    const at = pointOf(action) ?? leg?.to.map(Math.round);
    return at ? [{ key: part, part, at, label: `${part} ${actionWords(action)}` }] : [];
  });
  return [
    { key: "ball", part: "ball", at: copy.ball.at, label: "ball" }, ...scopes("ball", copy.ball),
    ...copy.robots.flatMap((robot, i) => [{ key: `tm${i + 1}`, part: `tm${i + 1}`, at: robot.at, label: `tm${i + 1}` }, ...actions(robot, i)]),
    ...copy.opponents.flatMap((one, i) => [{ key: `opp${i + 1}`, part: `opp${i + 1}`, at: one.at, label: `opp${i + 1}` }, ...scopes(`opp${i + 1}`, one)]),
  ];
}

/** An action in words. */
export function actionWords(action) {
  if (typeof action === "string") return action.replace("_", " ");
  const [[what, how]] = Object.entries(action);
  if (what === "turn") return how.face ? "turn to face" : `turn to ${how.heading_deg}°`;
  return { go_to_point: "go to point", dribble_to: "dribble to", pass_ball: `pass to tm${how}`, receive_ball: `receive from tm${how}`, kick: `kick ${how}` }[what] ?? what;
}

/** The change that puts a handle there, mm; a scope's edge by its distance from the centre. */
export function moveTo(handle, at) {
  if (handle.axis === undefined) return { edit: "move", part: handle.part, to: at };
  const radii = handle.scope.map((mm, i) => (i === handle.axis ? Math.max(GRID, Math.abs(at[i] - handle.centre[i])) : mm));
  return { edit: "scope", part: handle.part, radii };
}

export const chosenHandle = () => handles().find((handle) => handle.key === bench.chosen) ?? null;

export function chooseHandle(key) {
  if (bench.chosen === key) return;
  bench.chosen = key;
  changed("bench");
  changed("frame");
}

/** Keys move the chosen handle as the screen shows it: arrows by 10 mm, with shift by 100. */
export function nudge(event, camera) {
  const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  const handle = way && !event.ctrlKey && !event.altKey && !event.metaKey ? chosenHandle() : null;
  if (!handle) return false;
  const [from, to] = [camera.from([0, 0]), camera.from(way)];
  const by = event.shiftKey ? 100 : 10;
  const steps = to.map((x, i) => Math.round((x - from[i]) * camera.scale) * by);
  event.preventDefault();
  event.stopPropagation();
  // On the place that it has by then: keys come faster than answers.
  const at = (pending?.key === handle.key ? pending.at : handle.at).map((x, i) => x + steps[i]);
  pending = { key: handle.key, at };
  edit(moveTo(handle, at)).then(() => pending?.at === at && (pending = null));
  return true;
}

let pending = null;

/** What a hand holds: the handle, where it is, and the text that the drag began with. */
let held = null;

/** Takes hold of the handle at that pixel, if there is one. */
export function grab(point, camera) {
  if (!isOpen()) return false;
  const far = (handle) => Math.hypot(...camera.to(metres(handle.at)).map((x, i) => x - point[i]));
  // Of two at one place the smaller one: points and scopes before robots.
  const near = handles().map((handle, i) => [far(handle), -i, handle]).filter(([off]) => off < REACH).sort((a, b) => Math.round((a[0] - b[0]) / 4) || a[1] - b[1]);
  if (near.length === 0) return false;
  const [, , handle] = near[0];
  chooseHandle(handle.key);
  held = { handle, at: handle.at, from: bench.sheet.text, moved: false };
  return true;
}

export function pullHeld(point, camera) {
  if (!held) return;
  held.at = millimetres(camera.from(point));
  held.moved = true;
  preview(moveTo(held.handle, held.at), held.from);
  changed("frame");
}

export function dropHeld() {
  if (held?.moved) edit(moveTo(held.handle, held.at), held.from);
  held = null;
  changed("frame");
}

/** Layers of the case that is being played: two cases at a time cannot be distinguished. */
const PLAYED = ["case-scopes", "ball-path", "adapted"];

/** Whether that layer gives way to the ghost. */
export const givesWay = (name) => PLAYED.includes(name) && isOpen();

let drawn = { copy: null, shapes: [] };

/** The case as plain shapes, m. */
function shapesOf(copy, radius) {
  const shapes = [];
  const ellipse = (at, radii, tone, fill, note) => shapes.push({ is: "ellipse", at: metres(at), radii, tone, fill, note });
  const line = (points, tone, dashed) => shapes.push({ is: "line", points: points.map(metres), tone, arrow: true, dashed });
  const text = (at, words, tone) => shapes.push({ is: "text", at: metres(at), text: words, tone });
  ellipse(copy.ball.at, metres(copy.ball.scope), "ball", true);
  for (const leg of copy.legs) {
    const [dx, dy] = leg.to.map((x, i) => x - leg.from[i]);
    const long = Math.hypot(dx, dy) || 1;
    const side = (at, r, sign) => metres([at[0] - (sign * r * dy) / long, at[1] + (sign * r * dx) / long]);
    const [near, wide] = leg.radii;
    shapes.push({ is: "polygon", points: [side(leg.from, near, 1), side(leg.to, wide, 1), side(leg.to, wide, -1), side(leg.from, near, -1)], tone: "ball", fill: true });
    line([leg.from, leg.to], "ball", leg.kind === "kick");
  }
  copy.opponents.forEach((one, i) => {
    ellipse(one.at, metres(one.scope), "plain", true);
    if (one.presence !== "excluded") ellipse(one.at, [radius, radius], "plain", false);
    text(one.at, `opp${i + 1}${{ required: " required", excluded: " excluded" }[one.presence] ?? ""}`, "plain");
  });
  copy.robots.forEach((robot, i) => {
    let from = robot.at;
    for (const action of robot.actions) {
      const at = pointOf(action);
      if (!at) continue;
      line([from, at], "case", true);
      if (!action.turn) from = at;
    }
    ellipse(robot.at, [radius, radius], "case", true);
    text(robot.at, `tm${i + 1}`, "case");
  });
  return shapes;
}

/** Draws the ghost and its handles. */
export function drawGhost(pen, field) {
  const copy = isOpen() ? copyOf() : null;
  if (!copy) return;
  if (drawn.copy !== copy) drawn = { copy, shapes: shapesOf(copy, field.robot_radius) };
  drawShapes(pen, { name: "workbench", shapes: drawn.shapes });
  const { context, pixel } = pen;
  for (const handle of handles(copy)) {
    const chosen = handle.key === bench.chosen;
    const [x, y] = metres(held?.handle.key === handle.key ? held.at : handle.at);
    const r = (handle.axis === undefined ? 5 : 4) * pixel;
    context.fillStyle = handle.part === "ball" && handle.axis === undefined ? colours.ball : faint(chosen ? "accent" : "case", 0.9);
    context.beginPath();
    if (handle.axis === undefined) context.arc(x, y, r, 0, 2 * Math.PI);
    else context.rect(x - r, y - r, 2 * r, 2 * r);
    context.fill();
    context.lineWidth = (chosen ? 2.5 : 1) * pixel;
    context.strokeStyle = chosen ? stroke("accent") : colours.rim;
    if (chosen) {
      context.beginPath();
      context.arc(x, y, r + 4 * pixel, 0, 2 * Math.PI);
    }
    context.stroke();
  }
}
