// cases: tab Cases: how often each case was retrieved, how its plays ended, and what followed, up to the shown moment.

import { byId, el, fill, number } from "./dom.js";
import { getJson } from "./link.js";
import { on, store } from "./store.js";
import { span, time } from "./transport.js";

/** Tables by team, up to a whole second. */
let tables = {};
let have = "";
let fetching = false;
/** Cases whose rows are open: `team case`. */
const open = new Set();

const FOLLOWED = [["goal", "goal"], ["shot", "shot"], ["loss", "lost"]];
const words = (label) => label.replaceAll("-", " ");

/** Fetches what counts at the shown moment, at most once for a second of the match. */
async function follow() {
  // Up to the whole second; at the end all that is known.
  const newest = time.live || time.at > span()[1] - 0.1;
  const at = newest ? Number.MAX_SAFE_INTEGER : Math.floor(time.at);
  const wanted = `${store.state.life} ${Math.floor(time.at)} ${newest}`;
  if (fetching || wanted === have) return;
  fetching = true;
  try {
    tables = await getJson(`/api/cases?at=${at}`);
    have = wanted;
  } catch { /* the link shows the failure, and the next look tries again */ } finally {
    fetching = false;
  }
}

on("state", () => { have = ""; });

export function showCases() {
  const tab = byId("tab-cases");
  if (tab.hidden || !store.scene) return;
  follow();
  fill(tab, JSON.stringify(tables) + [...open], () => {
    const teams = ["blue", "yellow"].filter((team) => tables[team]);
    if (teams.length === 0) return el("p", { class: "muted" }, "Nothing is counted yet. Cases are counted in matches in which robots of ours play.");
    return [...teams.flatMap((team) => teamPart(team, tables[team])), teams.some((team) => tables[team].cases.length > 0) ? el("p", { class: "muted" }, LEGEND) : null];
  });
}

const LEGEND = "n: retrieved. done: every robot finished its part. pass: arrived of kicked. goal, shot, lost: what followed until the possession ended, at the latest 10 s after the play; the best of them counts. A case is dropped and chosen again as soon as the ball has left its scope: many retrieved and few done is common in fast play. Open a case to see how its plays ended.";

function teamPart(team, table) {
  const done = table.cases.reduce((sum, line) => sum + line.finished, 0);
  const share = table.retrieved ? `, ${number((100 * done) / table.retrieved, 0)} %` : "";
  return [
    el("h2", {}, el("span", { class: `chip ${team}` }, team), el("span", {}, `${table.retrieved} retrieved, ${done} finished${share}`)),
    el("p", { class: "muted", "data-no-case": team }, `${table.no_case} decisions to play no case${table.no_case ? `: ${reasons(table.no_case_because)}; ${byOpponents(table.no_case_by_opponents)}` : ""}`),
    table.cases.length === 0 ? null : el("div", { class: "scroll" }, el("table", { class: "tight" },
      head("case"), el("tbody", {}, table.cases.flatMap((line) => rows(team, line))))),
  ];
}

const reasons = (counts) => Object.entries(counts).sort((a, b) => b[1] - a[1]).map(([why, n]) => `${n} ${words(why)}`).join(", ");
const byOpponents = (counts) => Object.entries(counts).map(([n, count]) => `${count} against ${n}`).join(", ");

function head(first) {
  const cell = (name, title) => el("th", { class: "n", scope: "col", title }, name);
  return el("thead", {}, el("tr", {}, el("th", { scope: "col" }, first), cell("n", "how often retrieved"), cell("done", "plays that every robot finished"),
    cell("pass", "passes that arrived, of those that were kicked"), ...FOLLOWED.map(([what, name]) => cell(name, `plays that were followed by this: ${what}`))));
}

function counts(tally) {
  const cell = (content) => el("td", { class: "n" }, String(content));
  return [cell(tally.retrieved), cell(tally.finished), cell(tally.passes ? `${tally.passes_arrived}/${tally.passes}` : "–"),
    ...FOLLOWED.map(([what]) => cell(tally.followed_by[what] ?? 0))];
}

function rows(team, line) {
  const key = `${team} ${line.case}`;
  const isOpen = open.has(key);
  const toggle = () => {
    if (!open.delete(key)) open.add(key);
    showCases();
  };
  const row = el("tr", {}, el("td", {}, el("button", { class: "case-name", "data-case": key, "aria-expanded": String(isOpen), onclick: toggle }, line.case)), ...counts(line));
  return isOpen ? [row, el("tr", { "data-detail": key }, el("td", { colspan: "7" }, detail(line)))] : [row];
}

function detail(line) {
  const ends = Object.entries(line.ends).sort((a, b) => b[1] - a[1]).map(([end, n]) => `${n} ${words(end)}`).join(", ");
  const others = Object.entries(line.followed_by).filter(([what]) => !FOLLOWED.some(([known]) => known === what)).map(([what, n]) => `${n} ${what}`).join(", ");
  return [
    el("p", {}, `Ended: ${ends}.`),
    others ? el("p", { class: "muted" }, `Also followed by: ${others}.`) : null,
    el("table", { class: "tight" }, head("opponents"), el("tbody", {}, Object.entries(line.by_opponents).map(([n, tally]) =>
      el("tr", {}, el("td", {}, n), ...counts(tally))))),
  ];
}
