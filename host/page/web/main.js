// main: entry point: receives scenes, draws a frame when something moved, updates the panels ten times a second.

import { bench } from "./bench.js";
import { Camera } from "./camera.js";
import { showCases } from "./cases.js";
import { startColours } from "./colours.js";
import { startControl, showControl } from "./control.js";
import { byId, sizeOf } from "./dom.js";
import { showDraft, startDraft } from "./draft.js";
import { startDrag } from "./drag.js";
import { drawFrame } from "./field.js";
import { startHand } from "./hand.js";
import { showHealth } from "./health.js";
import { startKeys, TABS } from "./keys.js";
import { all, setLayer, showLegend, startLayers } from "./layers.js";
import { requests, silence, startLink } from "./link.js";
import { showBoard, showMatch } from "./match.js";
import { showOver } from "./over.js";
import { filmScene } from "./rehearse.js";
import { startSigns } from "./signs.js";
import { changed, on, recall, remember, store } from "./store.js";
import { startTimeline } from "./timeline.js";
import { advance, startTransport, time } from "./transport.js";
import { showTune } from "./tune.js";
import { showChosen, showWhy } from "./why.js";
import { bench as workbenchState } from "./workbench.js";

/** Panels follow so often, ms: faster than they are read. */
const PANELS_EVERY = 100;

const camera = new Camera();
const canvas = byId("field");
let frames = 0;
let wanted = false;
let drawnAt = performance.now();
let panelsAt = 0;

function want() {
  if (wanted) return;
  wanted = true;
  requestAnimationFrame(frame);
}

/** Times of the script in the newest frames, ms. */
const spent = [];

function frame(now) {
  const begun = performance.now();
  wanted = false;
  const more = advance(now, Math.min(0.1, Math.max(0, now - drawnAt) / 1000));
  drawnAt = now;
  byId("waiting").hidden = store.scene !== null;
  const film = filmScene(store.scene, now);
  if (film) draw(film, null);
  else if (store.scene) draw(store.scene, store.next);
  if (now - panelsAt >= PANELS_EVERY) {
    panelsAt = now;
    changed("panels");
  }
  if (more || film) want();
  spent.push(performance.now() - begun);
  if (spent.length > 600) spent.shift();
}

function draw(scene, next) {
  const ratio = devicePixelRatio || 1;
  const [width, height] = sizeOf(canvas);
  if (width === 0 || height === 0) return;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  camera.look(width, height, scene.field);
  drawFrame(canvas.getContext("2d"), camera, ratio, scene, next, store.share);
  frames += 1;
}

function showTab(asked) {
  const name = TABS.includes(asked) ? asked : TABS[0];
  store.tab = name;
  remember("tab", name);
  for (const button of document.querySelectorAll("#tabs button")) button.setAttribute("aria-selected", String(button.dataset.tab === name));
  for (const tab of document.querySelectorAll(".tab")) tab.hidden = tab.id !== `tab-${name}`;
  changed("panels");
}

let noted = 0;

/** A word for a few seconds. */
function showNotice(words) {
  const note = byId("note");
  note.textContent = words;
  Object.assign(note.style, { display: "block", left: "50%", top: "12px" });
  clearTimeout(noted);
  noted = setTimeout(() => (note.style.display = "none"), 4000);
}

on("frame", want);
on("layers", want);
on("colours", want);
on("chosen", () => { want(); changed("panels"); showChosen(); });
on("asked", (tab) => { showTab(tab); showChosen(); });
on("state", () => { want(); changed("panels"); });
on("panels", () => { showOver(); showLegend(); showBoard(); showWhy(); showMatch(); showHealth(); showControl(); showTune(); showCases(); showDraft(); });
on("refused", showNotice);
on("notice", showNotice);
new ResizeObserver(want).observe(canvas);
document.querySelectorAll("#tabs button").forEach((button) => button.addEventListener("click", () => showTab(button.dataset.tab)));

startColours();
startLayers();
startSigns();
startTransport();
startTimeline();
startControl();
startHand();
startDrag(canvas, camera);
startDraft(camera);
startKeys(camera, showTab);
showTab(new URLSearchParams(location.search).get("tab") ?? recall("tab", "why"));
startLink();
// Nothing moves while nothing comes, but clocks and the state of the link are looked at all the same.
setInterval(() => changed("panels"), 1000);

/** For tests and benches: what is shown now. */
window.onetwo = { store, time, camera, bench, layers: all, setLayer, frames: () => frames, requests, silence, refresh: () => changed("panels"), spent, workbench: workbenchState };
