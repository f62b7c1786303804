// judge: retrieval of the case on the workbench: its rank at a moment, what it wins over the match, and what other settings would
// change.

import { byId, clock, el, fill, number, table } from "./dom.js";
import { VERDICTS, verdictText } from "./explain.js";
import { changed } from "./store.js";
import { bench, freezeMoment, request } from "./workbench.js";

/** Candidates and near misses that are listed. */
const LISTED = 8;

let ranked = null;
let counted = null;
let similar = null;
/** Settings that differ from the match's. */
let values = {};

const fail = (error) => changed("refused", error.message);
const given = () => ({ name: bench.name, text: bench.sheet.text });

async function rank(team) {
  if (team) await freezeMoment(team);
  if (!bench.moment) return;
  ranked = { text: bench.sheet.text, ...(await request({ do: "rank", ...given(), problem: bench.moment.problem })) };
  changed("bench");
}

async function count() {
  counted = { text: bench.sheet.text, ...(await request({ do: "count", ...given() })) };
  changed("bench");
}

async function settings() {
  similar = await request({ do: "settings", values });
  changed("bench");
}

export function showJudge() {
  const now = bench.sheet.text;
  fill(byId("bench-judge"), JSON.stringify([ranked, counted, similar, bench.moment?.t, bench.moment?.team, ranked && ranked.text !== now, counted && counted.text !== now, bench.list?.settings]), () => [
    el("h2", {}, "Rank at a moment"),
    el("div", { class: "field-set" }, el("span", { class: "muted" }, "This moment:"), ...["blue", "yellow"].map((team) => el("button", { "data-rank": team, onclick: () => rank(team).catch(fail) }, team)),
      bench.moment ? el("button", { id: "bench-rank-again", onclick: () => rank().catch(fail) }, `again: ${bench.moment.team} at ${clock(bench.moment.t)}`) : null),
    ranked ? rankPart(ranked.text !== now) : null,
    el("h2", {}, "Over the match"),
    el("div", { class: "field-set" }, el("button", { id: "bench-count", onclick: () => count().catch(fail) }, "Count over all problems")),
    counted ? countPart(counted.text !== now) : null,
    el("h2", {}, "Settings of retrieval"),
    ...sliders(),
    el("div", { id: "bench-similar" }, similar ? similarPart() : null),
  ]);
}

const stale = (old) => (old ? el("p", { class: "muted" }, "The case was changed since: ask again.") : null);

function rankPart(old) {
  const { ids, answer } = ranked;
  const own = (row) => ids.includes(row.id);
  const mine = answer.cases.filter(own).sort((a, b) => (a.rank || 1000) - (b.rank || 1000));
  const best = mine[0];
  const candidates = answer.cases.filter((row) => row.rank).sort((a, b) => a.rank - b.rank);
  const words = !best ? "The case plays for the other goal."
    : answer.winner === best.id ? `Retrieved: it is the first of ${answer.candidates} that fit.`
      : best.rank ? `It fits, and is number ${best.rank} of ${answer.candidates}: ${candidates[0].case} is retrieved.`
        : `It does not fit: ${VERDICTS[best.verdict] ?? best.verdict}, ${verdictText(best)}.`;
  const rows = candidates.slice(0, LISTED).map((row) => [String(row.rank), [`${row.case}${row.symmetry === "identity" ? "" : ` · ${row.symmetry}`}`, own(row) ? "fine" : null],
    own(row) ? "this case" : !best?.rank ? "" : row.rank < best.rank ? "it wins" : "it loses", verdictText(row)]);
  return el("div", { id: "bench-rank" }, stale(old), el("p", {}, words), rows.length ? table(["rank", "case", "against this", "margins"], rows, true) : null,
    mine.length > 1 && !best.rank ? el("p", { class: "muted" }, mine.map((row) => `${row.symmetry}: ${verdictText(row)}`).join("; ")) : null);
}

const caseName = (name) => name ?? "no case";

function countPart(old) {
  const list = (pairs) => pairs.map(([name, n]) => `${n} from ${caseName(name)}`).join(", ");
  const [before, wins] = counted.wins;
  const share = counted.problems ? `, ${number((100 * wins) / counted.problems)} %` : "";
  return el("div", { id: "bench-counted" }, stale(old),
    el("p", {}, counted.problems === 0 ? "The match has no problem yet." : `It would be retrieved at ${wins} of ${counted.problems} problems${share}${before ? ` (as saved: ${before})` : ""}. With a case: ${counted.answered[1]}, without these changes ${counted.answered[0]}.`),
    counted.takes.length ? el("p", { id: "bench-takes" }, `Takes ${list(counted.takes)}.`) : null,
    counted.gives.length ? el("p", {}, `Gives ${counted.gives.map(([name, n]) => `${n} to ${caseName(name)}`).join(", ")}.`) : null);
}

/** Range of the numbers, and choices of the words; the program refuses what it cannot take. */
const RANGES = { thr: [0.05, 0.95, 0.01], thr_c: [100, 4000, 50], free_min: [0, 1, 0.01], lookahead: [0, 3, 0.1] };
const CHOICES = {
  correspondence: ["min-then-test", "constrained"], cost: ["sum", "max"], scopes: ["translated", "absolute"], free_path: ["crisp", "fuzzy"], out_of_field: ["keep", "clamp", "reject"],
  ranking: ["conditions,teammates,interval-cost", "conditions,interval-cost,teammates", "teammates,conditions,interval-cost", "teammates,interval-cost,conditions", "interval-cost,conditions,teammates", "interval-cost,teammates,conditions"],
};

function sliders() {
  const change = (name, value, now) => {
    if (value === now) delete values[name];
    else values[name] = value;
    settings().catch(fail);
  };
  return (bench.list?.settings ?? []).map(([name, now]) => {
    const value = values[name] ?? now;
    const id = `set-${name}`;
    const range = RANGES[name];
    const shown = el("output", { for: id }, value);
    const control = range
      ? el("input", { id, type: "range", min: range[0], max: range[1], step: range[2], value, "data-setting": name, oninput: (event) => (shown.textContent = event.target.value), onchange: (event) => change(name, event.target.value, now) })
      : el("select", { id, "data-setting": name, onchange: (event) => change(name, event.target.value, now) }, ...(CHOICES[name] ?? [now]).map((choice) => el("option", { value: choice }, choice)));
    if (!range) control.value = value;
    return el("div", { class: "field-set" }, el("label", { for: id }, name), control, range ? shown : null);
  });
}

function similarPart() {
  const { problems, answered, changed: other, cases } = similar;
  if (problems === 0) return el("p", { class: "muted" }, "The match has no problem yet.");
  const rows = cases.slice(0, 12).map(([name, [now, then]]) => [caseName(name), [String(now), "n"], [String(then), "n"], [then > now ? `+${then - now}` : String(then - now), "n"]]);
  return [
    el("p", {}, `Of ${problems} problems ${answered[1]} would have a case, now ${answered[0]}; ${other} answers change.`),
    rows.length ? table(["case", ["now", "n"], ["then", "n"], ["more", "n"]], rows) : null,
  ];
}
