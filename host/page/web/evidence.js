// evidence: what learning found out about a case: where it works and where it fails, and changes of it to take over.

import { byId, el, fill, number, table } from "./dom.js";
import { changed } from "./store.js";
import { bench, request, setText } from "./workbench.js";

/** The last answer, and the name of its case. */
let evidence = null;

const fail = (error) => changed("refused", error.message);

async function ask() {
  const name = bench.name;
  evidence = { name, ...(await request({ do: "learned", name })) };
  changed("bench");
}

/** Refuses a change, or takes the refusal back. */
async function keep({ words, refused }) {
  const { name } = evidence;
  evidence = { name, ...(await request({ do: "refuse", name, words, refused: !refused })) };
  changed("bench");
}

export function showEvidence() {
  const shown = evidence?.name === bench.name ? evidence : null;
  fill(byId("bench-evidence"), JSON.stringify([shown, bench.name, shown && bench.sheet.text]), () => [
    el("h2", {}, "Evidence"),
    el("div", { class: "field-set" }, el("button", { id: "bench-learned", onclick: () => ask().catch(fail) }, "What learning has found")),
    shown?.told ? counts(shown.told) : null,
    shown?.proposals ? proposals(shown.proposals) : null,
  ]);
}

const share = ({ plays, to_goal }) => (plays ? `${number((100 * to_goal) / plays)} %` : "");
const row = (name, one) => [name, String(one.plays), share(one)];

const STRIPS = ["own goal line", "own half", "own side of the middle", "beyond the middle", "their half", "their goal line"];
const SYMMETRIES = ["as authored", "across x", "across y", "both"];

function counts(one) {
  if (one.all.plays === 0) return el("p", { id: "bench-told" }, "It was never played.");
  const areas = one.areas.map((area, i) => [`${STRIPS[i >> 1]}, ${i % 2 ? "wings" : "middle"}`, String(area.plays), share(area), share(one.usual[i])]).filter((_, i) => one.areas[i].plays);
  const ends = Object.entries(one.ends).sort((a, b) => b[1] - a[1]).map(([end, n]) => `${end} ${n}`).join(", ");
  return el("div", { id: "bench-told" },
    el("p", {}, `${one.all.plays} plays, ${share(one.all)} to goal; ${one.now.plays} of them in the library as it is. Ends: ${ends}.`),
    table(["ball, opponents, symmetry", "plays", "to goal"], [
      row("inner half of the scope", one.rings[0]), row("outer half", one.rings[1]),
      row("every opponent's scope held", one.opponents[0]), row("some empty", one.opponents[1]),
      ...one.symmetries.map((symmetry, i) => row(SYMMETRIES[i], symmetry)).filter((_, i) => one.symmetries[i].plays),
    ], true),
    table(["place of the ball", "plays", "to goal", "average there"], areas, true));
}

function proposals(list) {
  if (list.length === 0) return el("p", { class: "muted" }, "No change of it was tried.");
  const take = (one) => el("button", { "data-take": one.words, disabled: one.after === bench.sheet.text, onclick: () => setText(one.after) }, "Take");
  const refuse = (one) => el("button", { "data-refuse": one.words, onclick: () => keep(one).catch(fail) }, one.refused ? "Propose again" : "Refuse");
  const line = (one) => el("li", { class: one.refused ? "muted" : "" }, el("b", {}, one.words), ` ${one.verdict}, ${number(one.gain)} points in ${one.pairs} pairs (${one.raised} raised, ${one.lowered} lowered). ${one.reason}. `, one.after ? take(one) : null, one.after ? " " : null, refuse(one), one.refused ? " Refused: learning does not propose it again." : null);
  return el("div", {}, el("p", { class: "muted" }, "Changes that were tried. What is taken is undone like any change, and is in the library once it is saved. What is refused is kept in refused.jsonl beside the report, and learning does not propose it."),
    el("ul", { id: "bench-proposals" }, list.map(line)));
}
