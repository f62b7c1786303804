// workbench: state of the workbench: the text of one case, the program's findings about it, undo and redo. The text is the only copy of
// the case.

import { post } from "./link.js";
import { changed, on, recall, remember, store } from "./store.js";
import { time } from "./transport.js";

export const SYMMETRIES = ["identity", "across-x", "across-y", "both"];

export const bench = {
  /** The library: names of cases and kicks, settings, whether it can be saved and rehearsed here. */
  list: null,
  /** The case: its name, its text, and what the program says of that text; none where nothing is open. */
  name: "", sheet: null,
  /** The text that is on disk under that name, as far as is known here. */
  opened: null,
  past: [], future: [],
  /** Which of the four symmetric copies is shown. */
  copy: 0,
  /** Key of the chosen handle. */
  chosen: null,
  /** The problem that it is held against: `{ t, team, problem }`. */
  moment: null,
  notes: [],
  /** The name under which it was not saved, as another case has it. */
  taken: null,
};

/** Asks the program; its refusals are shown. */
export async function request(what) {
  return JSON.parse(await post("/api/workbench", JSON.stringify(what)));
}

const showRefusal = (error) => changed("refused", error.message);

/** Changes wait for the one before: each is made on the text that it left. */
let queue = Promise.resolve();
const inTurn = (work) => (queue = queue.then(work).catch(showRefusal));

function show(sheet) {
  Object.assign(bench, { sheet, name: sheet.name });
  remember("bench", { name: bench.name, text: sheet.text, opened: bench.opened });
  changed("bench");
  changed("frame");
}

function begin(sheet, opened) {
  Object.assign(bench, { opened, past: [], future: [], chosen: null, notes: sheet.notes ?? [] });
  show(sheet);
}

export const loadList = () => inTurn(async () => {
  bench.list = await request({ do: "list" });
  changed("bench");
});

export const openCase = (name) => inTurn(async () => {
  const sheet = await request({ do: "open", name });
  begin(sheet, sheet.text);
});

/** The moment that is shown, as that team's problem. */
export async function freezeMoment(team) {
  const t = time.at;
  const problem = JSON.parse(await post("/api/freeze", JSON.stringify({ t, team })));
  // Who is not available plays no case.
  bench.moment = { t, team, problem };
  return problem;
}

const draftOn = async (problem) => {
  begin(await request({ do: "draft", problem }), null);
  changed("asked", "bench");
};

export const draft = (team) => inTurn(async () => draftOn(await freezeMoment(team)));

on("draft", draft);
// A decision's own problem.
on("draft-on", (problem) => inTurn(async () => {
  bench.moment = { t: time.at, team: problem.defending === "yellow" ? "who defends -x" : "who defends +x", problem };
  await draftOn(problem);
}));

const changing = (text, edit) => request({ do: "edit", name: bench.name, text, symmetry: SYMMETRIES[bench.copy], edit });

/** A drag asks so often at most, ms: the handle follows the pointer at once, the rest of the case at this pace. */
const PREVIEW_EVERY = 40;

/** The newest change of a drag that was not asked for yet, and how many drags have ended. */
let wanted = null;
let previewing = false;
let dropped = 0;

/** A change that can be taken back. */
export function edit(change, from) {
  // What a drag asked before is no longer shown.
  wanted = null;
  dropped += 1;
  return inTurn(() => make(change, from));
}

async function make(change, from) {
  const before = from ?? bench.sheet.text;
  const sheet = await changing(before, change);
  if (sheet.text !== before) {
    bench.past.push(before);
    bench.future = [];
  }
  show(sheet);
}

/** What a drag would change: drawn with the next frame, and in the panels when they follow; kept when it is dropped. */
export async function preview(change, from) {
  wanted = { change, from };
  if (previewing) return;
  previewing = true;
  while (wanted) {
    const [asked, drag] = [wanted, dropped];
    wanted = null;
    const pause = new Promise((over) => setTimeout(over, PREVIEW_EVERY));
    try {
      const sheet = await changing(asked.from, asked.change);
      if (drag === dropped) Object.assign(bench, { sheet });
      changed("frame");
    } catch { /* the drop shows the error */ }
    await pause;
  }
  previewing = false;
}

/** The text as a hand wrote it, or as it was before. */
const look = (text) => request({ do: "look", name: bench.name, text });

export const setText = (text) => inTurn(async () => {
  const before = bench.sheet.text;
  if (text === before) return;
  const sheet = await look(text);
  bench.past.push(before);
  bench.future = [];
  show(sheet);
});

function step(from, to) {
  return inTurn(async () => {
    if (!bench.sheet || bench[from].length === 0) return;
    // History and sheet change together: a refused answer loses nothing.
    const sheet = await look(bench[from].at(-1));
    bench[from].pop();
    bench[to].push(bench.sheet.text);
    show(sheet);
  });
}

export const undo = () => step("past", "future");
export const redo = () => step("future", "past");

export const rename = (name) => inTurn(async () => {
  const sheet = await request({ do: "look", name, text: bench.sheet.text });
  // What is on disk under the new name has not been seen.
  if (name !== bench.name) bench.opened = null;
  show(sheet);
});

/** Everything that the checks find, drawn problems too: it takes a second. */
export const checkAll = () => inTurn(async () => {
  const sheet = await request({ do: "check", name: bench.name, text: bench.sheet.text });
  show(sheet);
  changed("notice", sheet.findings.length ? `${sheet.findings.length} findings` : "cases check finds nothing");
});

export const save = () => inTurn(async () => {
  bench.taken = null;
  const sheet = await request({ do: "save", name: bench.name, text: bench.sheet.text, over: bench.opened }).catch((error) => {
    // Before a file is overwritten, the viewer sees what it holds.
    if (bench.opened === null && bench.list?.names.includes(bench.name)) bench.taken = bench.name;
    changed("bench");
    throw error;
  });
  bench.opened = sheet.text;
  show(sheet);
  changed("notice", `${sheet.name}.toml is saved; the next match is played with it`);
  bench.list = await request({ do: "list" });
  changed("bench");
});

/** Writes over the case of the same name, as it is on disk now. */
export const saveOver = () => inTurn(async () => {
  bench.opened = (await request({ do: "open", name: bench.name })).text;
}).then(save);

/** What was on it at the last visit. */
export function restore() {
  const kept = recall("bench", null);
  if (bench.sheet || !kept?.text) return;
  bench.name = kept.name;
  bench.opened = kept.opened;
  inTurn(async () => show(await look(kept.text)));
}

export const isOpen = () => store.tab === "bench" && bench.sheet !== null;
export const copyOf = (sheet = bench.sheet) => sheet?.copies[bench.copy] ?? null;
