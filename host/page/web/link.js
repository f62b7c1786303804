// link: connection to the program: a WebSocket that reconnects, and requests over HTTP.

import { byId, say } from "./dom.js";
import { changed, store } from "./store.js";

/** Silence of a match that is shown, ms. */
const SILENT = 3000;
/** Tries again after so long, ms; twice as long each time up to the last. */
const AGAIN = [300, 600, 1200, 2500];

/** What lets this viewer ask for something, from the page's own address; null where none is needed, or none was given. */
const TOKEN = new URLSearchParams(location.search).get("token");
const withToken = (path) => (TOKEN === null ? path : `${path}?token=${encodeURIComponent(TOKEN)}`);

let socket = null;
let tries = 0;
let heard = 0;

/** Asks the match for something; false without a connection. */
export function ask(request) {
  if (socket?.readyState !== WebSocket.OPEN) return false;
  socket.send(JSON.stringify(request));
  return true;
}

export const isOpen = () => socket?.readyState === WebSocket.OPEN;

let underWay = 0;
/** Requests over HTTP that are not answered yet. */
export const requests = () => underWay;
/** Time since the match was last heard, ms. */
export const silence = () => performance.now() - heard;

async function counted(request) {
  underWay += 1;
  return request.finally(() => (underWay -= 1));
}

export async function getJson(path) {
  const answer = await counted(fetch(path));
  if (!answer.ok) throw new Error(await answer.text());
  return answer.json();
}

export async function post(path, body) {
  const answer = await counted(fetch(withToken(path), { method: "POST", body }));
  const text = await answer.text();
  if (!answer.ok) throw new Error(text);
  return text;
}

/** Fetches what is shown and what this viewer may ask for. */
async function refreshState() {
  const state = await getJson(withToken("/api/state"));
  const restarted = state.life !== store.state.life;
  store.state = state;
  if (restarted) {
    store.matchEvents = [];
    store.samples = [];
  }
}

async function refresh() {
  await refreshState();
  await refreshRecord();
}

/** Fetches what was recorded so far. */
async function refreshRecord() {
  store.samples = await getJson("/api/plots");
  await catchUp();
  changed("state");
}

let fetching = false;

/** Fetches what happened since. */
async function catchUp() {
  if (fetching) return;
  fetching = true;
  try {
    for (;;) {
      const more = await getJson(`/api/events?from=${store.matchEvents.length}`);
      if (more.length === 0) break;
      store.matchEvents.push(...more);
    }
    // Events that are known late arrive late: a decision whose problem came after it, a kick that was fitted.
    store.matchEvents.sort((a, b) => a.t - b.t);
    changed("match-events");
  } finally {
    fetching = false;
  }
}

function take(text) {
  heard = performance.now();
  const scene = JSON.parse(text);
  if (scene.refused !== undefined) {
    changed("refused", scene.refused);
    return;
  }
  if (scene.transport !== undefined) {
    changed("transport", scene.transport);
    return;
  }
  // What comes after an earlier moment is another match.
  if (store.newest && scene.t < store.newest.t - 0.001) refresh().catch(() => {});
  else if (scene.happened !== store.matchEvents.length) catchUp().catch(() => {});
  store.newest = scene;
  changed("newest", scene);
}

/** Opens the connection; the state first, so that no scene is shown before its viewer may act on it. */
async function connect() {
  try {
    await refreshState();
  } catch {
    reconnect();
    return;
  }
  socket = new WebSocket(`ws://${location.host}${withToken("/socket")}`);
  socket.onopen = () => {
    tries = 0;
    heard = performance.now();
    refreshRecord().catch(() => {});
    showLink();
  };
  socket.onmessage = (event) => {
    take(event.data);
    // Taken: the next one may come.
    requestAnimationFrame(() => socket?.readyState === WebSocket.OPEN && socket.send("."));
  };
  socket.onclose = () => {
    socket = null;
    showLink();
    reconnect();
  };
}

function reconnect() {
  setTimeout(connect, AGAIN[Math.min(tries++, AGAIN.length - 1)]);
}

function showLink() {
  const open = isOpen();
  const over = open && store.newest?.over;
  const silent = open && !over && !store.state.recorded && store.newest && silence() > SILENT;
  const state = !open ? (store.newest ? "lost" : "waiting") : silent ? "lost" : "live";
  const words = { lost: open ? "silent" : "lost", waiting: "connecting", live: store.state.powers === "replay" ? "sending" : store.state.recorded ? "recording" : over ? "full time" : "connected" }[state];
  const badge = byId("connection");
  // A host that is reached is not well for that.
  const alarms = state === "live" ? (store.newest?.alarms ?? []).length : 0;
  badge.dataset.state = alarms ? "alarm" : state;
  say(badge, alarms ? `${alarms} alarm${alarms > 1 ? "s" : ""}` : words);
  byId("lost").hidden = state !== "lost";
}

export function startLink() {
  connect();
  setInterval(showLink, 500);
  // A page in the background draws no frames, and a match that stands still sends none: we are here all the same.
  setInterval(() => isOpen() && socket.send(document.hidden ? "." : ""), 5000);
}
