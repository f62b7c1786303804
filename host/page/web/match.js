// match: tab Match: score, stage, possession, ratios, and all events.

import { byId, clock, el, fill, keep, number, say, table } from "./dom.js";
import { explainEvent } from "./explain.js";
import { changed, store } from "./store.js";
import { seek, startOf } from "./transport.js";
import { tone } from "./timeline.js";

const KINDS = [["goal", "goals"], ["command", "referee"], ["foul", "fouls"], ["case", "cases"], ["kick", "ball"], ["cycle", "cycles"], ["fault", "faults"], ["event", "notes"], ["stage", "stages"]];

export function showBoard() {
  const scene = store.scene;
  if (!scene) return;
  say(byId("title"), store.state.title || "onetwo");
  for (const team of ["blue", "yellow"]) {
    say(byId(`name-${team}`), scene.game.teams[team].name || team);
    say(byId(`score-${team}`), String(scene.game.teams[team].score));
  }
  const over = Boolean(scene.over);
  say(byId("phase-now"), over ? "full time" : scene.game.phase || "–");
  const left = scene.game.stage_left == null ? "" : ` ${clock(scene.game.stage_left, 0)}`;
  // While play runs the referee's clock for an action says nothing.
  const act = scene.game.action_left == null || scene.game.action_left <= 0 || ["run", "halt", "stop"].includes(scene.game.phase) ? "" : ` · ${number(scene.game.action_left)} s left`;
  const next = scene.game.next ? ` · then ${scene.game.next}` : "";
  say(byId("phase-more"), over ? "" : `${scene.game.stage}${left}${act}${next}`);
  // Every alarm is a finding too, in the same order: it dates it.
  const since = (finding) => (finding ? ` (since ${clock(finding.since_s, 0)})` : "");
  const alarms = (scene.alarms ?? []).map((words, i) => words + since(scene.findings?.[i]));
  byId("alarms").hidden = alarms.length === 0;
  fill(byId("alarms"), JSON.stringify(alarms), () => alarms.map((words) => el("li", {}, words)));
}

export function showMatch() {
  const tab = byId("tab-match");
  const scene = store.scene;
  if (tab.hidden || !scene) return;
  const { blue, yellow } = scene.game.teams;
  const tenth = (x) => (x == null ? null : Math.round(x * 10));
  const key = JSON.stringify([blue, yellow].map((t) => [t.score, t.fouls, t.red_cards, t.yellow_cards.map(Math.round), t.allowed, t.timeouts, tenth(t.possession), tenth(t.offence_ratio), tenth(t.attack_ratio), t.counts]))
    + scene.game.phase + Math.round((scene.game.in_play ?? 0) * 100);
  if (!tab.firstChild) tab.append(el("div", { id: "match-sheet" }), el("h2", {}, "What happened"), filters(), el("ol", { class: "match-events", id: "match-events" }));
  fill(byId("match-sheet"), key, () => sheet(scene.game));
  showEvents();
}

function sheet(game) {
  const { blue, yellow } = game.teams;
  const rows = [["goals", blue.score, yellow.score]];
  const both = (words, of) => rows.push([words, of(blue), of(yellow)]);
  both("possession", (team) => (team.possession == null ? "–" : `${Math.round(team.possession * 100)} %`));
  both("offence ratio", (team) => number(team.offence_ratio, 2));
  both("attack ratio", (team) => number(team.attack_ratio, 2));
  blue.counts.forEach(([name, n], i) => rows.push([name, n, yellow.counts[i]?.[1] ?? "–"]));
  both("fouls to a card", (team) => team.fouls);
  both("cards", (team) => `${team.yellow_cards.length ? team.yellow_cards.map((s) => `yellow ${clock(s, 0)}`).join(", ") : "none"}${team.red_cards ? `, ${team.red_cards} red` : ""}`);
  both("robots allowed", (team) => team.allowed ?? "–");
  both("time-outs left", (team) => team.timeouts);
  return [
    blue.possession == null ? null : el("div", { class: "bar", title: "possession" },
      el("i", { class: "blue", style: `width:${blue.possession * 100}%` }), el("i", { class: "yellow", style: `width:${(yellow.possession ?? 0) * 100}%` })),
    table(["so far", ["blue", "n"], ["yellow", "n"]], rows.map(([name, a, b]) => [name, [String(a), "n"], [String(b), "n"]])),
    game.in_play == null ? null : el("p", { class: "muted" }, `The ball was in play for ${Math.round(game.in_play * 100)} % of the time.`),
  ];
}

function filters() {
  const button = ([kind, words]) => {
    const made = el("button", { class: store.hidden.has(kind) ? "" : "on", "data-kind": kind, onclick: () => {
      if (!store.hidden.delete(kind)) store.hidden.add(kind);
      made.classList.toggle("on", !store.hidden.has(kind));
      changed("panels");
    } }, words);
    return made;
  };
  return el("div", { class: "filters" }, KINDS.map(button));
}

/** The newest so many that are shown; the time line has all. */
const SHOWN = 150;

function showEvents() {
  const shown = store.matchEvents.filter((h) => !store.hidden.has(h.kind) && h.t <= store.scene.t + 0.05).slice(-SHOWN).reverse();
  const look = `${store.state.life} ${document.documentElement.dataset.theme}`;
  keep(byId("match-events"), shown, (matchEvent) => `${look} ${matchEvent.t} ${matchEvent.kind} ${matchEvent.words}`, (matchEvent) => {
    const go = () => seek(startOf(matchEvent), true);
    return el("li", { class: matchEvent.kind, onclick: go },
      el("button", { class: "at", "aria-label": `to ${clock(matchEvent.t)}` }, clock(matchEvent.t)), el("span", { class: "dot", style: `background:${tone(matchEvent)}` }), el("span", { class: "words" }, matchEvent.words),
      matchEvent.problem ? el("button", { class: "ask", onclick: (event) => { event.stopPropagation(); explainEvent(matchEvent); } }, "why?") : null);
  });
}
