// drag: pointer input on the field: drags ball and robots of a simulation, moves and zooms the view, chooses robots, explains shapes.

import { byId } from "./dom.js";
import { dropHeld, grab, pullHeld } from "./ghost.js";
import { shows } from "./layers.js";
import { ask } from "./link.js";
import { put } from "./put.js";
import { noteAt, notesOf } from "./shapes.js";
import { changed, choose, store } from "./store.js";
import { time } from "./transport.js";

/** Tolerance of a pointer, CSS pixels; period in which a pull is sent, ms. */
const REACH = 14;
const EVERY = 40;

export function startDrag(canvas, camera) {
  const fingers = new Map();
  let held = null;
  /** Holds a handle of the case on the workbench. */
  let handle = false;
  let moved = false;
  let sentAt = 0;
  /** Where the canvas lay when the drag began: measured at every move, it would be laid out as often. */
  let box = null;
  const spot = (event) => {
    if (fingers.size === 0) box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  function under(point) {
    const scene = store.scene;
    if (!scene) return null;
    const off = (at) => Math.hypot(...camera.to(at).map((x, i) => x - point[i]));
    if (scene.ball && off(scene.ball.at) < REACH * 0.8) return { ball: true };
    const radius = Math.max(REACH, scene.field.robot_radius * camera.scale);
    const near = scene.robots.map((robot) => [off(robot.at), robot]).filter(([far]) => far < radius).sort((a, b) => a[0] - b[0]);
    return near.length ? { robot: near[0][1] } : null;
  }

  function pull(point, last) {
    const at = camera.from(point).map((x) => Math.round(x * 1000) / 1000);
    put(held.robot, at);
    changed("frame");
    const now = performance.now();
    if (!last && now - sentAt < EVERY) return;
    sentAt = now;
    if (held.ball) ask({ ask: "ball", at });
    else ask({ ask: "robot", team: held.robot.team, id: held.robot.id, at });
  }

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, spot(event));
    moved = false;
    handle = fingers.size === 1 && grab(spot(event), camera);
    held = !handle && fingers.size === 1 && store.state.powers === "simulation" && time.live ? under(spot(event)) : null;
  });

  canvas.addEventListener("pointermove", (event) => {
    const before = fingers.get(event.pointerId);
    const here = spot(event);
    if (!before) return hover(here);
    const way = here.map((x, i) => x - before[i]);
    if (!moved && Math.hypot(...way) < 4) return;
    moved = true;
    if (handle) pullHeld(here, camera);
    else if (held) pull(here, false);
    else if (fingers.size === 2) {
      const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      const far = (at) => Math.hypot(at[0] - other[0], at[1] - other[1]);
      camera.zoomAt(here.map((x, i) => (x + other[i]) / 2), far(here) / Math.max(1, far(before)));
    } else camera.pan = camera.pan.map((x, i) => x + way[i]);
    if (!(held || handle) || moved) fingers.set(event.pointerId, here);
    changed("frame");
  });

  const up = (event) => {
    const here = spot(event);
    if (held && moved) pull(here, true);
    if (handle) dropHeld();
    else if (!moved && fingers.size === 1 && event.type === "pointerup") {
      const found = under(here);
      choose(found?.robot?.team ?? null, found?.robot?.id);
      if (store.chosen) changed("asked", "why");
      // A finger cannot hover: its touch shows what lies there.
      if (event.pointerType !== "mouse") hover(here);
    }
    fingers.delete(event.pointerId);
    [held, handle] = [null, false];
  };
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoomAt(spot(event), Math.exp(-event.deltaY * 0.0015));
    changed("frame");
  }, { passive: false });
  canvas.addEventListener("pointerleave", (event) => event.pointerType === "mouse" && (byId("note").style.display = "none"));

  function hover(here) {
    const note = byId("note");
    const found = under(here);
    canvas.style.cursor = found ? (store.state.powers === "simulation" && time.live ? "grab" : "pointer") : "default";
    const layers = store.scene?.layers ?? [];
    const words = found?.robot ? [robotWords(found.robot), ...notesOf(layers, shows, found.robot)].join("\n") : found?.ball ? ballWords(store.scene.ball) : noteAt(layers, shows, camera.from(here));
    note.style.display = words ? "block" : "none";
    if (!words) return;
    note.textContent = words;
    // Beside the pointer, within the picture.
    note.style.left = `${Math.max(4, Math.min(here[0] + 16, canvas.clientWidth - note.offsetWidth - 4))}px`;
    note.style.top = `${here[1] + 16 + note.offsetHeight < canvas.clientHeight ? here[1] + 16 : Math.max(4, here[1] - note.offsetHeight - 16)}px`;
  }
}

const place = ([x, y]) => `(${x.toFixed(2)}, ${y.toFixed(2)}) m`;
const speed = ([x, y]) => `${Math.hypot(x, y).toFixed(2)} m/s`;

function robotWords(robot) {
  const { mind } = robot;
  const thoughts = mind ? `\n${mind.role}: ${mind.directive}${mind.why ? `\n${mind.why}` : ""}${mind.part ? `\n${mind.part}` : ""}` : "";
  return `${robot.team} ${robot.id}  ${place(robot.at)}  ${speed(robot.velocity)}${thoughts}`;
}

const ballWords = (ball) => `ball  ${place(ball.at)}  ${speed(ball.velocity)}${ball.height > 0.01 ? `  ${ball.height.toFixed(2)} m high` : ""}`;
