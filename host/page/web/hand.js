// hand: one robot driven by hand: buttons that are held, keys, or a gamepad. An order 30 times a second while the hand holds; a release, a hidden page or a lost connection stops the robot.

import { byId, el, say } from "./dom.js";
import { ask } from "./link.js";
import { on, store } from "./store.js";

/** From order to order, ms: each holds for 100 ms. */
const EVERY = 33;
/** Turn at full speed, rad/s, for each m/s of the drive. */
const TURN_PER_SPEED = 3;
/** Fastest turn that is taken, rad/s. */
const TURN_MAX = 6;
/** Which robot is it: it turns to and fro on its place, rad/s, for so long each way, ms: a quarter of a turn. */
const [SHOW_RATE, SHOW_EVERY] = [3, 500];
/** A stick nearer to its middle rests: sticks of gamepads do not return exactly. */
const STICK_RESTS = 0.12;
/** Buttons of a standard gamepad: while the left one on the shoulder is held the robot is driven. */
const [DEAD_MAN, DRIBBLER, KICK] = [4, 0, 7];

/** Name, face, words, and keys of each button. */
const BUTTONS = [["ccw", "↺", "turn left", "q"], ["ahead", "▲", "ahead", "w", "ArrowUp"], ["cw", "↻", "turn right", "e"],
  ["left", "◀", "left", "a", "ArrowLeft"], ["back", "▼", "back", "s", "ArrowDown"], ["right", "▶", "right", "d", "ArrowRight"], ["kick", "Kick", "kick", "k"], ["show", "Which is it?", "Which is it? It turns to and fro", "i"]];
const KEYS = new Map(BUTTONS.flatMap(([name, , , ...keys]) => keys.map((key) => [key, name])));

const held = new Set();
let driving = null;
/** After a refusal or a lost connection everything has to be released first. */
let blocked = false;

const release = () => held.clear();

/** The part of the tab Control. */
export function handPart() {
  const hold = (name) => ({
    onpointerdown: (event) => {
      event.preventDefault();
      byId("hand-pad").focus({ preventScroll: true });
      if (event.isTrusted) event.target.setPointerCapture(event.pointerId);
      held.add(name);
    },
    onlostpointercapture: () => held.delete(name), onpointerup: () => held.delete(name), oncontextmenu: (event) => event.preventDefault(),
  });
  const buttons = BUTTONS.map(([name, face, words, key]) => el("button", { "data-hand": name, title: `${words} (${key})`, "aria-label": `${words}, hold`, ...hold(name) }, face));
  return [
    el("h2", {}, "One robot by hand"),
    el("div", { class: "field-set" }, el("label", { for: "hand-robot" }, "Robot"), el("select", { id: "hand-robot", onchange: release }),
      el("label", { for: "hand-speed" }, "m/s"), el("input", { type: "number", id: "hand-speed", min: "0.1", max: "2", step: "0.1", value: "0.5" }),
      el("label", { for: "hand-kick" }, "kick, m/s"), el("input", { type: "number", id: "hand-kick", min: "1", max: "6.2", step: "0.1", value: "3" }),
      el("label", {}, el("input", { type: "checkbox", id: "hand-dribbler" }), " dribbler")),
    el("div", { id: "hand-pad", tabindex: "0", role: "group", "aria-label": "Drive by keys: W A S D or arrows, Q and E to turn, K to kick, I to show which one it is, as long as they are held",
      onkeydown: (event) => key(event, true), onkeyup: (event) => key(event, false), onfocusout: release }, ...buttons),
    el("div", { class: "field-set" }, el("button", { id: "hand-end", onclick: end }, "Back to the coach"), el("span", { id: "hand-state", role: "status" })),
    el("p", { class: "muted" }, "Hold a button, a key while the pad has the focus (W A S D, Q E, K, I), or LB of a gamepad (left stick drives, right stick turns, A dribbles, RT kicks). While nothing is held the robot stands, and so do the others of its team, until “Back to the coach”. Only while the game runs; HALT always wins. The ball is kicked straight ahead when it lies at the dribbler. “Which is it?” turns the robot to and fro on its place."),
  ];
}

function key(event, down) {
  const pressed = event.key === " " || event.key === "Enter";
  const name = pressed ? event.target.dataset.hand : KEYS.get(event.key.length === 1 ? event.key.toLowerCase() : event.key);
  if (!name || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  event.stopPropagation();
  if (down) held.add(name);
  else held.delete(name);
}

function end() {
  release();
  const [team] = byId("hand-robot").value.split(" ");
  ask({ ask: "drive", team, robot: null });
  driving = null;
}

/** Shares of the speed ahead, to the left and of the turn, and what else a gamepad wants; null: nothing is held. */
function gamepad() {
  const pad = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected && one.buttons[DEAD_MAN]?.pressed);
  const stick = (i) => (Math.abs(pad.axes[i] ?? 0) < STICK_RESTS ? 0 : -pad.axes[i]);
  return pad ? { drive: [stick(1), stick(0), stick(2)], dribbler: pad.buttons[DRIBBLER]?.pressed, kick: pad.buttons[KICK]?.pressed } : null;
}

function wanted() {
  const pad = gamepad();
  if (!pad && held.size === 0) return null;
  const has = (name) => Number(held.has(name));
  const [ahead, left, turn] = pad?.drive ?? [has("ahead") - has("back"), has("left") - has("right"), has("ccw") - has("cw")];
  const show = has("show") ? (performance.now() % (2 * SHOW_EVERY) < SHOW_EVERY ? SHOW_RATE : -SHOW_RATE) : null;
  const speed = Math.min(2, Math.max(0, byId("hand-speed").valueAsNumber || 0)) / Math.max(1, Math.hypot(ahead, left));
  const rate = Math.max(-TURN_MAX, Math.min(TURN_MAX, turn * TURN_PER_SPEED * Math.max(0.5, speed)));
  const kick = pad?.kick || held.has("kick") ? byId("hand-kick").valueAsNumber : null;
  return { velocity: (show ? [0, 0, show] : [ahead * speed, left * speed, rate]).map((x) => Number(x.toFixed(3))), dribbler: byId("hand-dribbler").checked || Boolean(pad?.dribbler), kick: kick || null };
}

const still = { velocity: [0, 0, 0], dribbler: false, kick: null };

function tick() {
  const shown = byId("hand-pad") && !byId("tab-control").hidden && !document.hidden;
  const order = shown ? wanted() : null;
  if (!order) blocked = false;
  const [team, id] = (byId("hand-robot")?.value ?? "").split(" ");
  if (order && !blocked && id) {
    driving = { ask: "drive", team, robot: Number(id) };
    blocked = !ask({ ...driving, ...order });
  } else if (driving) {
    // Released: the stop need not wait for the order's end.
    ask({ ...driving, ...still });
    driving = null;
  }
}

export function showHand() {
  const select = byId("hand-robot");
  if (!select) return;
  // On a real field those that report: ours.
  const names = store.scene.robots.filter((robot) => robot.vitals).map((robot) => `${robot.team} ${robot.id}`).sort();
  const all = [...new Set([...[...select.options].map((option) => option.value), ...names])].sort();
  if (all.length !== select.options.length) {
    const chosen = select.value;
    select.replaceChildren(...all.map((name) => el("option", {}, name)));
    if (chosen) select.value = chosen;
  }
  const phase = store.newest?.game.phase;
  const waits = phase === "run" ? "" : `, but the referee says ${phase}: the robot waits for force start`;
  say(byId("hand-state"), blocked ? "stopped: release everything first" : driving ? `${driving.team} ${driving.robot} is driven${waits}` : "nothing is held");
}

export function startHand() {
  setInterval(tick, EVERY);
  // The page that is hidden sends its stop before its timers slow down.
  document.addEventListener("visibilitychange", () => { release(); tick(); });
  addEventListener("blur", release);
  on("refused", () => (blocked = driving !== null));
}
