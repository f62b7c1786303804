// colours: colours of both themes, read from page.css. Pairs that must be distinguished differ in lightness as well as in hue, and never
// by colour alone.

import { byId } from "./dom.js";
import { changed, recall, remember } from "./store.js";

const NAMES = ["back", "panel", "raised", "edge", "text", "dim", "surface", "margin", "line", "rim", "blue", "blue-ink", "blue-line", "yellow",
  "yellow-ink", "yellow-line", "ball", "case", "forbidden", "good", "plain", "accent", "warn", "bad"];

export const colours = {};
const thin = new Map();

function read() {
  const style = getComputedStyle(document.documentElement);
  for (const name of NAMES) colours[name] = style.getPropertyValue(`--${name}`).trim();
  thin.clear();
}

/** The colour of lines and words of that name: a team's fill may be too light for them. */
export const stroke = (name) => colours[`${name}-line`] ?? colours[name] ?? colours.plain;

/** The colour of lines, let through by so much. */
export function faint(name, share) {
  const key = `${name} ${share}`;
  if (!thin.has(key)) {
    const value = stroke(name);
    const part = (at) => parseInt(value.slice(at, at + 2), 16);
    thin.set(key, `rgba(${part(1)},${part(3)},${part(5)},${share})`);
  }
  return thin.get(key);
}

function take(theme) {
  document.documentElement.dataset.theme = theme;
  read();
  changed("colours");
}

export function toggleTheme() {
  const theme = document.documentElement.dataset.theme === "light" ? "dark" : "light";
  remember("theme", theme);
  take(theme);
}

export function startColours() {
  const asked = new URLSearchParams(location.search).get("theme");
  const system = matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
  take(["light", "dark"].includes(asked) ? asked : recall("theme", system));
  byId("theme").addEventListener("click", toggleTheme);
}
