// layers: choice of layers: those of the page and those that the program names; a viewer's choice is kept.

import { byId, el, fill, number, say } from "./dom.js";
import { HEAT_SCALE } from "./heat.js";
import { changed, on, recall, remember, store } from "./store.js";

/** The page's own: name, label, shown at first. */
const OWN = [
  ["raw", "raw vision", false],
  ["trail", "ball's trail", true],
  ["ahead", "ball's prediction", true],
  ["velocities", "velocities", true],
  ["paths", "paths and targets", true],
  ["roles", "roles", true],
];

let chosen = {};

/** Whether that layer is drawn. */
export const shows = (name, otherwise) => chosen[name] ?? otherwise;

/** The map that was switched on last. */
let lastMap = null;

export function setLayer(name, shown) {
  if (shown) lastMap = name;
  chosen = { ...chosen, [name]: shown };
  remember("layers", chosen);
  changed("layers");
}

/** All that there are now: name, label, shown, how many shapes. */
export function all() {
  const own = OWN.map(([name, label, first]) => ({ name, label, shown: shows(name, first), own: true }));
  const named = (store.scene?.layers ?? []).map((layer) => ({
    name: layer.name, label: layer.label, shown: shows(layer.name, layer.on), count: layer.shapes.length,
  }));
  return [...own, ...named];
}

export function toggleLayers() {
  const panel = byId("layers");
  panel.hidden = !panel.hidden;
  byId("layers-open").setAttribute("aria-expanded", String(!panel.hidden));
  show();
}

function show() {
  const panel = byId("layers");
  if (panel.hidden) return;
  const list = all();
  const key = list.map((layer) => `${layer.name}${layer.shown ? 1 : 0}`).join();
  fill(panel, key, () => {
    const row = (layer) => {
      const box = el("input", { type: "checkbox", "data-layer": layer.name, onchange: (event) => setLayer(layer.name, event.target.checked) });
      box.checked = layer.shown;
      return el("label", {}, box, layer.label, el("small", { "data-now": layer.name }));
    };
    const part = (words, layers) => (layers.length ? [el("h2", {}, words), ...layers.map(row)] : []);
    const every = (shown) => () => list.forEach((layer) => setLayer(layer.name, shown));
    return [
      ...part("Field", list.filter((layer) => layer.own)),
      ...part("Thinking", list.filter((layer) => !layer.own)),
      el("div", { class: "field-set", style: "margin: 8px 0 0" },
        el("button", { onclick: every(true), id: "layers-all" }, "all"), el("button", { onclick: every(false), id: "layers-none" }, "none")),
    ];
  });
  // In its place: a row that is replaced under a finger would lose the click.
  for (const layer of list) say(panel.querySelector(`[data-now="${CSS.escape(layer.name)}"]`), layer.count === 0 ? "none now" : "");
}

/** What the colours of the map mean; of two maps one would hide the other, so one alone is shown. */
export function showLegend() {
  const maps = (store.scene?.layers ?? []).filter((layer) => layer.shapes[0]?.is === "heat" && shows(layer.name, layer.on));
  const shown = maps.find((layer) => layer.name === lastMap) ?? maps[0];
  for (const layer of maps) if (layer !== shown) setLayer(layer.name, false);
  const legend = byId("legend");
  legend.hidden = !shown;
  if (!shown) return;
  const { note, most } = shown.shapes[0];
  fill(legend, `${shown.name} ${note} ${most}`, () => [
    note, el("i", { style: `background:${HEAT_SCALE}` }), el("div", {}, el("span", {}, "0 %"), el("span", { id: "legend-most" }, `${number(most * 100, most < 0.1 ? 1 : 0)} %`)),
  ]);
}

export function startLayers() {
  chosen = recall("layers", {});
  const asked = new URLSearchParams(location.search).get("layers");
  if (asked) for (const name of asked.split(",")) chosen[name.replace(/^-/, "")] = !name.startsWith("-");
  byId("layers-open").addEventListener("click", toggleLayers);
  on("layers", show);
  on("panels", show);
}
