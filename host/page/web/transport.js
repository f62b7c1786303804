// transport: choice of the shown moment: the newest one, or any that was kept; with speed, bookmarks and an address for each moment.

import { byId, clock, el, fill, say } from "./dom.js";
import { ask, getJson, post } from "./link.js";
import { placed } from "./put.js";
import { changed, on, recall, remember, store } from "./store.js";

/** This moment's address for others: they view, and send no requests in our place. */
function shared() {
  const url = new URL(location.href);
  url.searchParams.delete("token");
  return url.href;
}

/** Seconds that were fetched, by number: a list of scenes each, or a promise of one. */
const seconds = new Map();
const SECONDS_MAX = 120;

export const time = { live: true, playing: true, at: 0, pace: 1 };

/** Of a recording that is sent to the network the moment is the program's, the same for all viewers: when it came, ms, and from where it goes on. */
let sent = null;

on("transport", (moment) => follow(moment));

/** Goes on from there, until the program names the next moment. */
function follow(moment) {
  sent = { ...moment, came: performance.now() };
  Object.assign(time, { live: false, playing: sent.playing, pace: sent.speed });
  byId("pace").value = String(sent.speed);
  changed("frame");
}

/** Asks the program for it, and shows it at once. */
function steer(request, change) {
  if (ask(request)) follow({ at: time.at, playing: sent.playing, speed: sent.speed, ...change });
}

let before = null;
let arrived = 0;
let interval = 40;

on("newest", (scene) => {
  const now = performance.now();
  if (before) interval = Math.min(200, Math.max(10, 0.8 * interval + 0.2 * (now - arrived)));
  arrived = now;
  before = store.latest ?? scene;
  store.latest = scene;
  seconds.delete(Math.floor(scene.t));
  changed("frame");
});

on("state", () => {
  seconds.clear();
  if (store.state.recorded && time.live && store.state.span) {
    time.live = false;
    time.at = store.state.span[0];
    time.playing = true;
  }
});

export const span = () => {
  const kept = store.state.span ?? [0, 0];
  return [kept[0], Math.max(kept[1], store.latest?.t ?? 0)];
};

async function load(second) {
  const [first, last] = span();
  if (seconds.has(second) || second < Math.floor(first) || second > Math.floor(last)) return;
  if (seconds.size > SECONDS_MAX) seconds.delete(seconds.keys().next().value);
  seconds.set(second, null);
  try {
    seconds.set(second, await getJson(`/api/second/${second}`));
  } catch {
    seconds.set(second, []);
  }
  changed("frame");
}

/** The scenes around a moment: the one by then, the next, and the share of the way. */
function around(t) {
  const second = Math.floor(t);
  load(second);
  // The scene by then may be the last of the second before.
  if (t - second < 0.5) load(second - 1);
  else load(second + 1);
  const list = [...(seconds.get(second - 1) ?? []).slice(-1), ...(seconds.get(second) ?? []), ...(seconds.get(second + 1) ?? []).slice(0, 1)];
  if (list.length === 0) return null;
  let i = list.findIndex((scene) => scene.t > t + 1e-6);
  i = i < 0 ? list.length - 1 : Math.max(0, i - 1);
  const [scene, next] = [list[i], list[i + 1] ?? null];
  const share = next ? Math.min(1, Math.max(0, (t - scene.t) / (next.t - scene.t))) : 0;
  return [scene, next, share];
}

/** Brings `store.scene` to the moment; true where there is more to draw in the next frame. */
export function advance(now, passed) {
  if (time.live) {
    if (!store.latest) return false;
    const share = (now - arrived) / interval;
    // A movement that has ended shows the newest scene itself: the last of a match is followed by none.
    [store.scene, store.next, store.share] = share < 1 ? [placed(before), placed(store.latest), share] : [placed(store.latest), null, 0];
    time.at = store.latest.t;
    return share < 1;
  }
  const [first, last] = span();
  if (sent) {
    time.at = Math.min(last, sent.at + (sent.playing ? (performance.now() - sent.came) / 1000 * sent.speed : 0));
  } else if (time.playing) {
    // What is still on its way is waited for.
    const ready = seconds.get(Math.floor(time.at));
    if (ready) time.at = Math.min(last, time.at + passed * time.pace);
    if (time.at >= last && store.state.recorded) time.playing = false;
    if (time.at >= last && !store.state.recorded) goLive();
  }
  time.at = Math.max(first, time.at);
  const waits = reach(last);
  const found = around(waits ? last : time.at);
  if (found) [store.scene, store.next, store.share] = found;
  return time.playing || waits;
}

/** A recording that is still being read grows: so long without growth, ms, and it is whole. */
const WHOLE = 2000;
let end = { at: 0, since: 0 };

/** Whether a moment is waited for that is not there yet. Once it cannot come, a notice names the end of the match. */
function reach(last) {
  const now = performance.now();
  if (last !== end.at) end = { at: last, since: now };
  if (last === 0 || time.at <= last) return false;
  if (store.state.span === undefined) return true;
  if (!store.state.recorded) {
    changed("notice", `${clock(time.at)} is not played yet: this is the newest moment`);
    goLive();
    return false;
  }
  if (now - end.since <= WHOLE) return true;
  changed("notice", `${clock(time.at)} is not there: this ends at ${clock(last)}`);
  time.at = last;
  address();
  return false;
}

export function seek(t, play = time.playing) {
  const [first, last] = span();
  time.live = false;
  time.playing = play;
  time.at = Math.min(last, Math.max(first, t));
  if (sent) {
    if (play !== sent.playing) steer({ ask: "pause", on: !play }, { playing: play });
    steer({ ask: "seek", t: time.at }, {});
  }
  address();
  changed("frame");
  changed("panels");
}

export function goLive() {
  if (store.state.recorded) return seek(span()[1], false);
  time.live = true;
  time.playing = true;
  history.replaceState(null, "", location.pathname + location.search);
  changed("frame");
}

/** Space: a simulation pauses for all viewers, a recording for this one alone. */
export function toggle() {
  if (time.live) {
    // A match that is over is watched once more.
    if (store.latest?.over) seek(span()[0], true);
    else if (store.state.powers === "simulation") ask({ ask: "pause", on: !store.latest?.paused });
    else seek(time.at, false);
  } else {
    if (!time.playing && time.at >= span()[1] - 0.01) seek(span()[0], false);
    time.playing = !time.playing;
    if (sent) steer({ ask: "pause", on: !time.playing }, { playing: time.playing });
    address();
    changed("frame");
  }
}

function address() {
  history.replaceState(null, "", `${location.pathname}${location.search}#t=${time.at.toFixed(2)}`);
}

/** To the event before or after this moment, of those that are shown. */
export function jump(direction) {
  const list = [...store.matchEvents, ...store.marks].filter((h) => !store.hidden.has(h.kind)).map((h) => h.t).sort((a, b) => a - b);
  const to = direction > 0 ? list.find((t) => t > time.at + 0.05) : list.findLast((t) => t < time.at - 0.6);
  if (to !== undefined) seek(to);
}

/** A goal is looked at from so long before it, s. */
const BEFORE_GOAL = 5;
export const startOf = (matchEvent) => Math.max(span()[0], matchEvent.t - (matchEvent.kind === "goal" ? BEFORE_GOAL : 1));

/** To the way to the goal before or after this moment; a notice names the team. */
export function jumpGoal(direction) {
  const goals = store.matchEvents.filter((h) => h.kind === "goal");
  const goal = direction > 0 ? goals.find((h) => startOf(h) > time.at + 0.05) : goals.findLast((h) => startOf(h) < time.at - 0.6);
  if (goal) seek(startOf(goal));
  // The start of a recording may be nearer to its first goal.
  const coming = goal ?? (direction > 0 ? goals.find((h) => h.t > time.at) : undefined);
  changed("notice", coming ? `${clock(coming.t)}: ${coming.words}` : `no goal ${direction > 0 ? "after" : "before"} this moment`);
}

export function mark() {
  store.marks = [...store.marks, { t: time.at, words: `mark ${store.marks.length + 1}`, kind: "mark" }];
  remember(`marks.${store.state.title}`, store.marks);
  changed("match-events");
}

async function freeze(choice) {
  const [what, team] = choice.split(" ");
  if (what === "bench") return changed("draft", team);
  try {
    const problem = await post("/api/freeze", JSON.stringify({ t: time.at, team }));
    const text = what === "case" ? JSON.parse(await post("/api/workbench", JSON.stringify({ do: "draft", problem: JSON.parse(problem) }))).text : problem;
    const name = `${what}-${team}-${time.at.toFixed(2)}.${what === "case" ? "toml" : "json"}`;
    const link = el("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name });
    link.click();
    URL.revokeObjectURL(link.href);
    changed("notice", `${name} is saved`);
  } catch (error) {
    changed("refused", error.message);
  }
}

function show() {
  const paused = time.live ? Boolean(store.latest?.paused || store.latest?.over) : !time.playing;
  say(byId("play"), paused ? "▶" : "❚❚");
  byId("live").classList.toggle("on", time.live);
  byId("live").hidden = store.state.recorded;
  byId("pace").disabled = time.live;
  const words = [clock(time.at), ` of ${clock(span()[1], 0)}`];
  fill(byId("clock"), words.join(), () => [document.createTextNode(words[0]), el("small", {}, words[1])]);
}

/** The moment that the address names, s; none where it names none that there can be. */
function asked() {
  const words = /(?:^|[#&])t=([^&]*)/.exec(location.hash)?.[1];
  if (words === undefined) return null;
  const t = words.trim() === "" ? NaN : Number(words);
  if (Number.isFinite(t) && t >= 0) return t;
  changed("notice", `the address names no moment: #t=${words}, seconds are expected, such as #t=12.5`);
  return null;
}

export function startTransport() {
  const from = asked();
  if (from !== null) [time.live, time.playing, time.at] = [false, false, from];
  const press = (id, action) => byId(id).addEventListener("click", action);
  press("play", toggle);
  press("live", goLive);
  press("before", () => jump(-1));
  press("after", () => jump(1));
  press("mark", mark);
  press("link", async () => {
    address();
    try {
      await navigator.clipboard.writeText(shared());
      changed("notice", "the address of this moment is copied");
    } catch {
      changed("notice", shared());
    }
  });
  byId("pace").addEventListener("change", (event) => {
    time.pace = Number(event.target.value);
    if (sent) steer({ ask: "speed", factor: time.pace }, { speed: time.pace });
  });
  byId("freeze").addEventListener("change", (event) => {
    if (event.target.value) freeze(event.target.value);
    event.target.value = "";
  });
  addEventListener("hashchange", () => {
    const moment = asked();
    if (moment === null) return;
    seek(moment, false);
    time.at = moment;
  });
  on("state", () => (store.marks = recall(`marks.${store.state.title}`, [])));
  on("panels", show);
}
