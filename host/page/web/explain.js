// explain: explanation of a retrieval: the candidates by rank, then those that missed by the least, each with its margin.

import { byId, clock, el, number, table } from "./dom.js";
import { post } from "./link.js";
import { changed, store } from "./store.js";
import { time } from "./transport.js";

/** Number of cases that are no candidates, but are listed at first. */
const NEAREST = 12;

export function dialog(title, ...body) {
  byId("dialog-title").textContent = title;
  byId("dialog-body").replaceChildren(...body);
  if (!byId("dialog").open) byId("dialog").showModal();
}

export const explainEvent = (one) => open(`${one.words}, at ${clock(one.t)}`, one.decided ?? { problem: one.problem });

/** The newest decision on its own problem; apart from it, what this moment would give. */
export async function explainNow(team) {
  const cycle = await settled(team);
  const frozen = async () => JSON.parse(await post("/api/freeze", JSON.stringify({ t: time.at, team })));
  await open(`${team} at ${clock(time.at)}`, cycle?.decided, cycle, frozen);
}

/** A robot reports its problem within 0.1 s of its decision; a message may be lost and sent again. */
const REPORT_WITHIN = 600;

/** The team's newest cycle; where its problem is still under way, as it is a moment later. */
async function settled(team) {
  const until = performance.now() + REPORT_WITHIN;
  for (;;) {
    const cycle = store.scene?.cycles.find((one) => one.team === team);
    const decided = cycle?.decided;
    const awaited = time.live && decided?.by !== undefined && !decided.reported;
    if (!awaited || performance.now() > until) return cycle;
    await new Promise((later) => setTimeout(later, 40));
  }
}

async function open(title, decided, cycle, frozen) {
  try {
    const parts = [];
    if (cycle?.state === "playing") parts.push(el("p", { id: "playing" }, `Playing ${cycle.case}${copyOf(cycle.symmetry)}, cycle ${cycle.number}.`));
    if (decided) parts.push(...await decision(decided));
    if (frozen) {
      const problem = await frozen();
      parts.push(part("would-be", "What would be retrieved now", "On what the host sees, with the robots that are available now.", await ask(problem), problem, {}));
    }
    dialog(title, ...parts);
  } catch (error) {
    changed("refused", `no explanation: ${error.message}`);
  }
}

/** How a terminal names the cases of this match; a directory's path is not sent to viewers. */
let cases = "";

async function ask(problem) {
  cases ||= await post("/api/workbench", JSON.stringify({ do: "list" })).then(JSON.parse)
    .then(({ league, saves }) => (saves ? "with the --library of this match" : `--league ${league}`), () => "with the cases of this match");
  const answer = JSON.parse(await post("/api/explain", JSON.stringify(problem)));
  if (answer.error) throw new Error(answer.error);
  return answer;
}

async function decision(decided) {
  const heading = decided.cycle === undefined ? "" : `Decided in cycle ${decided.cycle}`;
  if (decided.by !== undefined && !decided.reported) return [unreported(decided, heading)];
  if (!decided.problem) return [el("p", { id: "decided" }, `No case: ${decided.grounds}.`)];
  const source = decided.by === undefined ? "" : `On robot ${decided.by}'s own problem, as it reported it.`;
  return [part("decided", heading, source, await ask(decided.problem), decided.problem, decided)];
}

/** A decision whose problem is not known has no explanation: retrieval on the host's view may answer otherwise. */
function unreported(decided, heading) {
  return el("section", { id: "decided" },
    el("h3", {}, heading),
    el("p", { class: "bad", id: "unreported" }, `Not reported: the problem that robot ${decided.by} decided on did not arrive, so this decision cannot be explained.`),
    decided.problem ? el("p", { class: "field-set" }, draftButton("Draft a case for what the host saw", decided.problem)) : null);
}

const draftButton = (words, problem) => el("button", { "data-draft-on": "", onclick: () => { closeDialog(); changed("draft-on", problem); } }, words);

/** An explanation of one problem, with the decision that rests on it where there is one. */
function part(id, heading, source, answer, problem, decided) {
  const same = decided.id === undefined || (decided.id ?? null) === answer.winner || decided.grounds !== "";
  return el("section", { id },
    heading ? el("h3", {}, heading) : null,
    source ? el("p", { class: "muted" }, source) : null,
    decided.grounds ? el("p", { class: "grounds" }, `${decided.grounds}.`) : null,
    same ? null : el("p", { class: "bad" }, "The robots decided otherwise: they retrieve with other cases or settings than this page."),
    body(answer, JSON.stringify(problem), false));
}

/** How near a case that is none was to be one: the later the check, the nearer; then by its margin. */
const ORDER = { candidate: 0, opponents: 1, path: 2, thr_c: 3, robots: 4, ball: 5 };
const margin = (row) => row.inside_mm ?? row.over_mm ?? row.outside_mm ?? 0;

function body(answer, problem, every) {
  const rows = [...answer.cases].sort((a, b) => ORDER[a.verdict] - ORDER[b.verdict] || (a.rank ?? 0) - (b.rank ?? 0) || margin(a) - margin(b));
  const shown = every ? rows : rows.slice(0, answer.candidates + NEAREST);
  const cells = shown.map((row) => [
    row.rank ? String(row.rank) : "", `${row.case}${copyOf(row.symmetry)}`,
    [VERDICTS[row.verdict] ?? row.verdict, row.verdict === "candidate" ? "fine" : "bad"], verdictText(row),
  ]);
  const winner = rows.find((row) => row.id === answer.winner);
  const rest = rows.length - shown.length;
  return el("div", { class: "explanation" },
    el("p", {}, winner ? `${winner.case} is the best of ${answer.candidates} that fit.` : "No case fits."),
    table(["rank", "case", "verdict", "why"], cells, true),
    el("p", { class: "field-set" },
      rest > 0 ? el("button", { onclick: (event) => event.target.closest(".explanation").replaceWith(body(answer, problem, true)) }, `${rest} more`) : null,
      el("button", { onclick: () => navigator.clipboard?.writeText(problem).then(() => changed("notice", "the problem is copied")) }, "Copy the problem"),
      draftButton("Draft a case for it", JSON.parse(problem))),
    el("p", { class: "muted" }, `The same on a terminal: paste the problem into onetwo cases explain ${cases}.`));
}

/** Verdicts in words. */
export const VERDICTS = { candidate: "fits", path: "path blocked", opponents: "other opponents", thr_c: "too far", robots: "too few robots", ball: "ball out of scope" };

const counted = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;
/** A mirror image in words: none for the case as authored, nor where the robot did not report it. */
const copyOf = (symmetry) => (!symmetry || symmetry === "identity" ? "" : ` · ${symmetry}`);

/** The margin of a verdict. */
export function verdictText(row) {
  switch (row.verdict) {
    case "candidate":
      return `${counted(row.conditions, "condition")}, ${counted(row.teammates, "teammate")}, similarity ${number(row.similarity, 2)}, ${number(row.cost / 1000, 2)} m to travel in all`;
    case "path":
      return `opponent ${row.opponent} stands ${number(row.inside_mm, 0)} mm inside leg ${row.leg}`;
    case "opponents":
      return row.opponent === null ? `no opponent stands where opp${row.case_opponent} requires one` : `opponent ${row.opponent} stands where opp${row.case_opponent} excludes one`;
    case "thr_c":
      return row.distance_mm === undefined ? "a place outside the field"
        : `robot ${row.robot} is ${number(row.distance_mm / 1000, 2)} m from its place, ${number(row.over_mm, 0)} mm too far`;
    case "robots":
      return `${row.needed} are needed, ${row.present} are there`;
    case "ball":
      return `the ball lies ${number(row.outside_mm, 0)} mm outside its scope`;
    default:
      return "";
  }
}

/** The keys' list, and whatever else has words alone. */
export function showKeys(keys) {
  dialog("Keys", table(["key", "does"], keys.map(([key, words]) => [key, words])));
}

export const closeDialog = () => byId("dialog").open && byId("dialog").close();
export const hasScene = () => store.scene !== null;
