// keys: keyboard: what each key does, and the list of keys for viewers.

import { toggleTheme } from "./colours.js";
import { byId } from "./dom.js";
import { closeDialog, showKeys } from "./explain.js";
import { toggleLayers } from "./layers.js";
import { ask } from "./link.js";
import { toggleSigns } from "./signs.js";
import { changed, store } from "./store.js";
import { goLive, jump, jumpGoal, mark, seek, time, toggle } from "./transport.js";

export const TABS = ["why", "match", "health", "control", "cases", "bench", "tune"];

export function startKeys(camera, showTab) {
  const flip = () => { camera.flipped = !camera.flipped; changed("frame"); };
  const fit = () => { camera.reset(); changed("frame"); };
  const zoom = (factor) => { camera.zoomAt([camera.size[0] / 2, camera.size[1] / 2], factor); changed("frame"); };
  const step = () => {
    if (time.live && store.state.powers === "simulation") ask({ ask: "step", ticks: 1 });
    else seek(time.at + 0.04, false);
  };
  const keys = {
    " ": ["space", "resume, or pause", toggle], ".": [".", "one tick on", step], l: ["l", "to the newest moment", goLive],
    ArrowLeft: ["← →", "a second back and on; with shift ten", (far) => seek(time.at - (far ? 10 : 1))], ArrowRight: ["", "", (far) => seek(time.at + (far ? 10 : 1))],
    "[": ["[ ]", "shown event before and after", () => jump(-1)], "]": ["", "", () => jump(1)],
    g: ["g", "5 s before the next goal; with shift the one before", () => jumpGoal(1)], G: ["", "", () => jumpGoal(-1)],
    b: ["b", "bookmark this moment", mark], c: ["c", "copy this moment's address", () => byId("link").click()],
    y: ["y", "layers", toggleLayers], k: ["k", "legend: what the marks on the field mean", toggleSigns], f: ["f", "turn the field round", flip], 0: ["0", "whole field", fit], "+": ["+ −", "zoom", () => zoom(1.25)], "-": ["", "", () => zoom(0.8)],
    1: ["1 – 7", "why, match, health, control, cases, workbench, parameters", () => showTab(TABS[0])], 2: ["", "", () => showTab(TABS[1])], 3: ["", "", () => showTab(TABS[2])], 4: ["", "", () => showTab(TABS[3])], 5: ["", "", () => showTab(TABS[4])], 6: ["", "", () => showTab(TABS[5])], 7: ["", "", () => showTab(TABS[6])],
    // On the workbench; `draft.js` takes them.
    "bench move": ["arrows", "on the workbench: the chosen part by 10 mm; with shift 100; Escape lets it go", () => {}], "bench undo": ["Ctrl+Z, Ctrl+Shift+Z, Ctrl+S", "on the workbench: undo, redo, save", () => {}],
    t: ["t", "light or dark", toggleTheme], "?": ["?", "this list", () => help()],
  };
  const help = () => showKeys(Object.values(keys).filter(([name]) => name));
  byId("help").addEventListener("click", help);
  byId("flip").addEventListener("click", flip);
  byId("fit").addEventListener("click", fit);
  // What a pointer pressed does not keep the focus: the next space is not for it.
  addEventListener("click", (event) => event.detail > 0 && event.target.closest?.("button, [role=button], input[type=checkbox]")?.blur());
  addEventListener("change", (event) => event.target.matches?.("select:not(:focus-visible)") && event.target.blur());
  addEventListener("keydown", (event) => {
    if (event.key === "Escape") return closeDialog();
    const typing = event.target.matches?.("input:not([type=checkbox]), select, textarea") && !(event.key === " " && event.target.type === "range");
    if (typing || event.ctrlKey || event.metaKey || event.altKey || byId("dialog").open) return;
    // A button or a box takes the space itself where it is seen to have the focus.
    if (event.key === " " && event.target.matches?.(":is(button, input, [role=button]):focus-visible")) return;
    const found = keys[event.key];
    if (!found) return;
    event.preventDefault();
    found[2](event.shiftKey);
  });
}
