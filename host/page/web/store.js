// store: state of the page: one object, and listeners that are called on changes.

export const store = {
  /** From the program: title, what may be asked, recorded or live. */
  state: { title: "", recorded: false, powers: "none", life: 0 },
  /** The scene that is shown, and the one that it moves towards. */
  scene: null,
  next: null,
  /** How far it has moved, 0 to 1. */
  share: 0,
  matchEvents: [],
  samples: [],
  /** Bookmarks: `{ t, words }`. */
  marks: [],
  /** Chosen robot: `{ team, id }`. */
  chosen: null,
  tab: "why",
  /** Kinds of events that are left out of the list and of jumps: cycles without a case are many and say little. */
  hidden: new Set(["cycle"]),
};

const listeners = new Map();

/** Calls `listener` whenever that changed. */
export function on(what, listener) {
  if (!listeners.has(what)) listeners.set(what, []);
  listeners.get(what).push(listener);
}

export function changed(what, value) {
  for (const listener of listeners.get(what) ?? []) listener(value);
}

export function choose(team, id) {
  const same = store.chosen && store.chosen.team === team && store.chosen.id === id;
  store.chosen = same || team == null ? null : { team, id };
  changed("chosen");
}

export const isChosen = (robot) =>
  store.chosen !== null && store.chosen.team === robot.team && store.chosen.id === robot.id;

/** What a browser keeps for the next visit; some browsers keep nothing. */
export function remember(name, value) {
  try { localStorage.setItem(`onetwo.${name}`, JSON.stringify(value)); } catch { /* it is forgotten then */ }
}

export function recall(name, otherwise) {
  try { return JSON.parse(localStorage.getItem(`onetwo.${name}`)) ?? otherwise; } catch { return otherwise; }
}
