// draft: editor of a case on the workbench: its parts and actions, the findings of the checks, undo and redo, and the file.

import { byId, clock, el, fill } from "./dom.js";
import { showEvidence } from "./evidence.js";
import { actionWords, chooseHandle, handles, nudge, pointOf } from "./ghost.js";
import { showJudge } from "./judge.js";
import { showRehearsal } from "./rehearse.js";
import { changed, on, store } from "./store.js";
import { bench, checkAll, copyOf, draft, edit, loadList, openCase, redo, rename, restore, save, saveOver, setText, SYMMETRIES, undo } from "./workbench.js";

const PARTS = ["open", "head", "findings", "parts", "actions", "judge", "rehearse", "evidence", "file"];

export function showDraft() {
  const tab = byId("tab-bench");
  if (tab.hidden) return;
  if (!tab.firstChild) {
    tab.append(...PARTS.map((name) => el("section", { id: `bench-${name}` })));
    loadList();
    restore();
  }
  fill(byId("bench-open"), JSON.stringify([bench.list?.names, bench.list?.saves, bench.name]), opening);
  const { sheet } = bench;
  for (const name of PARTS.slice(1)) byId(`bench-${name}`).hidden = !sheet;
  if (!sheet) return;
  fill(byId("bench-head"), JSON.stringify([bench.name, sheet.text === bench.opened, bench.past.length, bench.future.length, bench.copy, bench.list?.saves, bench.taken, sheet.intent, sheet.copies[0]?.defending]), head);
  fill(byId("bench-findings"), JSON.stringify([sheet.findings, sheet.elsewhere, bench.notes]), findings);
  fill(byId("bench-parts"), JSON.stringify([copyOf(), bench.chosen]), parts);
  // Points that are only proposed change with every drag: they are looked up when one is chosen.
  fill(byId("bench-actions"), JSON.stringify(sheet.robots.map((one) => [one.actions, one.may_be.map((list) => list.map(actionWords))])), () => [el("h2", {}, "Gameplays"), el("p", { class: "muted" }, "As the file has them, whichever symmetry is shown."), ...sheet.robots.map(robot)]);
  showJudge();
  showRehearsal();
  showEvidence();
  fill(byId("bench-file"), sheet.text, file);
}

const press = (words, onclick, more = {}) => el("button", { onclick, ...more }, words);
const set = (...children) => el("div", { class: "field-set" }, ...children);

function opening() {
  const names = bench.list?.names ?? [];
  const select = el("select", { id: "bench-case", "aria-label": "Case" }, ...names.map((name) => el("option", { value: name }, name)));
  if (names.includes(bench.name)) select.value = bench.name;
  return [
    el("p", { class: "muted" }, `Edit a case on the field: open one, or draft one from this moment; move its parts with the pointer, check and rehearse it.${bench.list && !bench.list.saves ? " Nothing is saved here: start the program with --library DIRECTORY to write case files." : ""}`),
    set(select, press("Open", () => select.value && openCase(select.value), { id: "bench-open-case" })),
    set(el("span", { class: "muted" }, "Draft from this moment:"), ...["blue", "yellow"].map((team) => press(team, () => draft(team), { "data-draft": team }))),
  ];
}

function head() {
  const { sheet } = bench;
  const saved = sheet.text === bench.opened;
  const name = el("input", { id: "bench-name", value: bench.name, "aria-label": "Name of the case, region/name", onchange: (event) => rename(event.target.value.trim()) });
  const intent = el("input", { id: "bench-intent", class: "wide", value: sheet.intent, "aria-label": "What the case is for", onchange: (event) => edit({ edit: "intent", intent: event.target.value }) });
  const symmetry = (label, i) => press(label, () => { bench.copy = i; changed("bench"); changed("frame"); }, { class: i === bench.copy ? "on" : "", "aria-pressed": String(i === bench.copy), "data-copy": label });
  return [
    el("h2", {}, "Case", saved ? null : el("span", { class: "muted", id: "bench-unsaved" }, "not saved")),
    set(name),
    intent,
    set(press("Undo", undo, { id: "bench-undo", disabled: bench.past.length === 0, title: "Ctrl+Z" }), press("Redo", redo, { id: "bench-redo", disabled: bench.future.length === 0, title: "Ctrl+Shift+Z" }),
      press("Check all", checkAll, { id: "bench-check", title: "Everything that cases check finds, drawn problems too" }), press("Save", save, { id: "bench-save", disabled: saved })),
    bench.taken === bench.name ? set(press(`Write over ${bench.name}`, saveOver, { id: "bench-save-over", class: "danger" })) : null,
    bench.list?.saves === false ? el("p", { class: "muted" }, "These cases are built into the program: to save, start it with --library DIR, a copy of a league's directory.") : null,
    set(el("span", { class: "muted" }, "Shown:"), ...SYMMETRIES.map(symmetry)),
    set(el("label", { for: "bench-goal" }, "Defends"), goal(sheet.copies[0]?.defending)),
  ];
}

function goal(now) {
  const select = el("select", { id: "bench-goal", onchange: (event) => edit({ edit: "defending", goal: event.target.value }) },
    el("option", { value: "yellow" }, "yellow, the goal at -x"), el("option", { value: "cyan" }, "cyan, the goal at +x"));
  if (now) select.value = now;
  return select;
}

function findings() {
  const { sheet } = bench;
  const line = (one) => el("li", { class: one.severity, "data-code": one.code },
    el("b", {}, `${one.severity} ${one.code}`), ` line ${one.line}: ${one.message}; ${one.hint}`);
  return [
    el("h2", {}, "Findings"),
    sheet.findings.length ? el("ul", { class: "findings", id: "bench-findings-list" }, sheet.findings.map(line)) : el("p", { class: "fine", id: "bench-sound" }, "The checks find nothing."),
    sheet.elsewhere.length ? el("p", { class: "muted" }, "In other files, because of this one:") : null,
    sheet.elsewhere.length ? el("ul", { class: "findings" }, sheet.elsewhere.map((one) => el("li", { class: one.severity }, el("b", {}, `${one.file} ${one.code}`), ` ${one.message}`))) : null,
    bench.notes.length ? el("p", { class: "muted" }, `The draft differs from the moment: ${bench.notes.join("; ")}.`) : null,
  ];
}

/** What a scope demands, in words. */
const PRESENCES = { preferred: "ranks higher", required: "must hold one", excluded: "must be empty" };

function parts() {
  const copy = copyOf();
  if (!copy) return el("p", { class: "muted" }, "The text cannot be read: mend it below.");
  const remove = (part) => {
    const found = /^(tm|opp)(\d+)$/.exec(part);
    if (!found) return null;
    const change = found[1] === "tm" ? { edit: "remove_robot", robot: Number(found[2]) } : { edit: "remove_opponent", opponent: Number(found[2]) };
    return press("✕", () => edit(change), { "aria-label": `Take ${part} out`, "data-remove": part });
  };
  const presence = (part) => {
    const number = /^opp(\d+)$/.exec(part)?.[1];
    if (!number) return null;
    const select = el("select", { "data-presence": part, "aria-label": `What ${part}'s scope demands`, onchange: (event) => edit({ edit: "presence", opponent: Number(number), presence: event.target.value }) },
      ...Object.entries(PRESENCES).map(([value, words]) => el("option", { value }, words)));
    select.value = copy.opponents[number - 1].presence;
    return select;
  };
  const row = (handle) => {
    const chosen = handle.key === bench.chosen;
    const values = handle.axis === undefined ? `${handle.at[0]}, ${handle.at[1]}` : `${handle.scope[handle.axis]}`;
    const button = press(`${handle.label}: ${values}`, () => chooseHandle(handle.key), { "data-handle": handle.key, class: chosen ? "on" : "", "aria-pressed": String(chosen), onfocus: () => chooseHandle(handle.key) });
    return el("div", { class: "part" }, button, handle.axis === undefined ? presence(handle.part) : null, handle.axis === undefined ? remove(handle.part) : null);
  };
  const beside = (dy) => [copy.ball.at[0] + (copy.defending === "yellow" ? 500 : -500), copy.ball.at[1] + dy];
  return [
    el("h2", {}, "Parts"),
    el("p", { class: "muted" }, "mm. Drag them on the field, or choose one and press the arrow keys: 10 mm, with shift 100."),
    set(...["←", "↑", "↓", "→"].map((arrow, i) => press(arrow, (event) => nudgeBy(["ArrowLeft", "ArrowUp", "ArrowDown", "ArrowRight"][i], event.shiftKey), { "aria-label": `Move the chosen part: ${["left", "up", "down", "right"][i]}`, disabled: !bench.chosen })),
      press("Add a robot", () => edit({ edit: "add_robot", at: beside(800) }), { id: "bench-add-robot", disabled: copy.robots.length > 3 }),
      press("Add an opponent", () => edit({ edit: "add_opponent", at: beside(-300), scope: [400, 400] }), { id: "bench-add-opponent", disabled: copy.opponents.length > 3 })),
    el("div", { class: "parts", id: "bench-part-list" }, handles(copy).map(row)),
  ];
}

/** A finger has no arrow keys: its buttons move by 100 mm, or 10 with shift. */
let camera = null;
const nudgeBy = (key, fine) => nudge({ key, shiftKey: !fine, preventDefault() {}, stopPropagation() {} }, camera);

/** The action of these words among those that may be there now. */
const chosenOf = (robot, index, words) => bench.sheet.robots[robot].may_be[index].find((one) => actionWords(one) === words);

function robot(sheet, i) {
  const number = i + 1;
  const list = sheet.actions.map((action, k) => {
    const choices = sheet.may_be[k];
    const known = choices.some((one) => actionWords(one) === actionWords(action));
    const select = el("select", { "data-action": `tm${number}.${k + 1}`, "aria-label": `tm${number}, action ${k + 1}`, onchange: (event) => edit({ edit: "set_action", robot: number, number: k + 1, action: chosenOf(i, k, event.target.value) }) },
      ...(known ? [] : [el("option", { value: actionWords(action) }, `${actionWords(action)} (not here)`)]), ...choices.map((one) => el("option", { value: actionWords(one) }, actionWords(one))));
    select.value = actionWords(action);
    const at = pointOf(action);
    const place = (axis) => el("input", { type: "number", step: "10", value: String(at[axis]), "aria-label": `tm${number}, action ${k + 1}, ${"xy"[axis]} in mm`, "data-at": `tm${number}.${k + 1}.${axis}`,
      onchange: (event) => edit({ edit: "set_action", robot: number, number: k + 1, action: withPoint(action, at.map((mm, j) => (j === axis ? Math.round(Number(event.target.value)) : mm))) }) });
    return el("li", {}, select, at ? [place(0), place(1)] : null,
      press("↑", () => edit({ edit: "move_action", robot: number, number: k + 1, to: k }), { disabled: k === 0, "aria-label": `tm${number}, action ${k + 1}: earlier`, "data-earlier": `tm${number}.${k + 1}` }),
      press("✕", () => edit({ edit: "remove_action", robot: number, number: k + 1 }), { "aria-label": `tm${number}, action ${k + 1}: take out`, "data-remove": `tm${number}.${k + 1}` }));
  });
  const choices = sheet.may_be.at(-1);
  const add = el("select", { "data-add": `tm${number}`, "aria-label": `tm${number}: what follows`, onchange: (event) => event.target.value && edit({ edit: "add_action", robot: number, number: sheet.actions.length + 1, action: chosenOf(i, sheet.actions.length, event.target.value) }) },
    el("option", { value: "" }, "then …"), ...choices.map((one) => el("option", { value: actionWords(one) }, actionWords(one))));
  return el("div", { class: "gameplay" }, el("h3", {}, `tm${number}`), el("ol", {}, list), add);
}

function withPoint(action, at) {
  const [what] = Object.keys(action);
  return what === "turn" ? { turn: { face: at } } : { [what]: at };
}

function file() {
  const { sheet } = bench;
  const text = el("textarea", { id: "bench-text", rows: "16", spellcheck: "false", "aria-label": "The case file, TOML", onchange: (event) => setText(event.target.value) });
  text.value = sheet.text;
  const download = () => {
    const link = el("a", { href: URL.createObjectURL(new Blob([sheet.text], { type: "text/plain" })), download: `${bench.name.replace("/", "-")}.toml` });
    link.click();
    URL.revokeObjectURL(link.href);
  };
  return [el("h2", {}, "The file"), text, set(press("Download", download))];
}

export function startDraft(theCamera) {
  camera = theCamera;
  on("bench", showDraft);
  // Before all other keys: arrows move the chosen part, where there is one, and not the time.
  addEventListener("keydown", (event) => {
    if (store.tab !== "bench" || byId("dialog").open || event.target.matches?.("input, select, textarea")) return;
    if (event.key === "Escape") chooseHandle(null);
    else nudge(event, camera);
  }, true);
  addEventListener("keydown", (event) => {
    const letter = event.key.toLowerCase();
    if (store.tab !== "bench" || !(event.ctrlKey || event.metaKey) || !["z", "y", "s"].includes(letter) || byId("dialog").open) return;
    // What is typed is taken back by the browser.
    if (letter !== "s" && event.target.matches?.("input:not([type=range]), textarea")) return;
    event.preventDefault();
    if (letter === "s") save();
    else if (letter === "y" || event.shiftKey) redo();
    else undo();
  });
}

/** The moment that the case is held against, in words. */
export const momentWords = () => (bench.moment ? `${bench.moment.team} at ${clock(bench.moment.t)}` : "no moment yet");
