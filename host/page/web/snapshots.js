// snapshots: snapshots of the simulated field: to return to as often as wanted, and to save as files.

import { byId, clock, el, fill } from "./dom.js";
import { ask, getJson } from "./link.js";
import { changed } from "./store.js";

/** The program is asked for its moments so often, ms. */
const EVERY = 1000;

let kept = [];
let asked = 0;

/** The part of the tab; its list is filled by `showSnapshots`. */
export const snapshotPart = () => [
  el("h2", {}, "Snapshots"),
  el("div", { class: "field-set" },
    el("button", { id: "snapshot-keep", onclick: () => order({ ask: "keep" }) }, "Keep a snapshot"),
    el("label", { for: "snapshot-file" }, "From a file"),
    el("input", { type: "file", id: "snapshot-file", accept: ".json,application/json", onchange: (event) => load(event.target).catch((error) => changed("refused", `no snapshot: ${error.message}`)) })),
  el("ul", { id: "snapshots", class: "learned" }),
  el("p", { class: "muted" }, "Ball and robots with their motion, as they truly are. Score, clock, referee and what robots think go on."),
];

function order(request) {
  ask(request);
  asked = 0;
}

async function load(input) {
  const [file] = input.files;
  if (!file) return;
  const snapshot = JSON.parse(await file.text());
  input.value = "";
  order({ ask: "load", snapshot });
}

export function showSnapshots() {
  const list = byId("snapshots");
  if (!list) return;
  if (performance.now() - asked > EVERY) {
    asked = performance.now();
    getJson("/api/snapshots").then((now) => (kept = now)).catch(() => {});
  }
  fill(list, String(kept.length), () => kept.map((snapshot, number) => el("li", {},
    el("button", { "data-return": String(number), onclick: () => ask({ ask: "return", number }) }, `Return to ${number}`),
    ` ${clock(snapshot.t)}, ${snapshot.robots.length} robots `,
    el("a", { class: "button", download: `snapshot-${number}.json`, href: `data:application/json;charset=utf-8,${encodeURIComponent(JSON.stringify(snapshot))}` }, "Save as a file"))));
}
