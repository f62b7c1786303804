// log: the program's log: errors, alarms, warnings and notes, newest first, with a search.

import { byId, clock, el, keep, say } from "./dom.js";
import { getJson } from "./link.js";
import { on } from "./store.js";
import { seek } from "./transport.js";

const LEVELS = ["error", "alarm", "warning", "note"];
/** The program is asked for more so often, ms. */
const EVERY = 1000;
/** So many of those that fit are listed; all are searched. */
const SHOWN = 200;
/** More are not kept here either. */
const KEPT = 2000;

const hidden = new Set();
let entries = [];
let asked = 0;
let search = "";

on("state", () => {
  [entries, asked] = [[], 0];
});

async function more() {
  if (performance.now() - asked < EVERY) return;
  asked = performance.now();
  const from = (entries.at(-1)?.n ?? -1) + 1;
  const fresh = await getJson(`/api/log?from=${from}`);
  entries = [...entries, ...fresh.filter((entry) => entry.n > (entries.at(-1)?.n ?? -1))].slice(-KEPT);
}

export function buildLog() {
  const button = (level) => {
    const made = el("button", { class: "on", "data-level": level, "aria-pressed": "true", onclick: () => {
      if (!hidden.delete(level)) hidden.add(level);
      made.classList.toggle("on", !hidden.has(level));
      made.setAttribute("aria-pressed", String(!hidden.has(level)));
      showLog();
    } }, level);
    return made;
  };
  return [
    el("div", { class: "filters", role: "group", "aria-label": "Levels" }, LEVELS.map(button)),
    el("input", { id: "log-search", type: "search", class: "wide", placeholder: "Search the log", "aria-label": "Search the program log", oninput: (event) => { search = event.target.value.toLowerCase(); showLog(); } }),
    el("p", { id: "log-count", class: "muted", role: "status" }),
    el("ol", { id: "log", class: "log", tabindex: "0", "aria-label": "Program log" }),
  ];
}

export function showLog() {
  more().catch(() => {});
  const fits = entries.filter(({ level, source, text }) => !hidden.has(level) && `${source} ${text}`.toLowerCase().includes(search));
  keep(byId("log"), fits.slice(-SHOWN).reverse(), (entry) => `${entry.n} ${entry.at}`, ({ at, t, level, source, text }) => el("li", { class: level, "data-level": level },
    el("span", { class: "level" }, level),
    t == null ? el("span", { class: "at", title: "since the program's start" }, `+${clock(at)}`) : el("button", { class: "at", title: "time in the match: go there", "aria-label": `to ${clock(t)}`, onclick: () => seek(t, false) }, clock(t)),
    el("span", { class: "words" }, `${source}: ${text}`)));
  say(byId("log-count"), entries.length === 0 ? "Nothing was reported." : `${fits.length} of ${entries.length}`);
}
