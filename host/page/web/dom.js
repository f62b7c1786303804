// dom: elements of the page, made from data; text is always text, never markup.

export const byId = (id) => document.getElementById(id);

/** An element: `el("p", { class: "why" }, "words", child)`; names that begin with `on` are listeners. */
export function el(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value != null) made.setAttribute(name, value);
  }
  made.append(...children.flat().filter((child) => child != null && child !== false));
  return made;
}

const sizes = new WeakMap();
const sizing = new ResizeObserver((entries) => entries.forEach(({ target, contentRect }) => sizes.set(target, [contentRect.width, contentRect.height].map(Math.round))));

/** Width and height of a canvas, CSS pixels, as last laid out: to measure it would lay out at once all that a frame has changed. */
export function sizeOf(canvas) {
  if (!sizes.has(canvas)) {
    sizes.set(canvas, [canvas.clientWidth, canvas.clientHeight]);
    sizing.observe(canvas);
  }
  return sizes.get(canvas);
}

/** Sets words only where they differ: the browser lays out nothing that stays. */
export function say(target, words) {
  if (target.textContent !== words) target.textContent = words;
}

/** Where a hand presses now: what lies under it stays until it lets go, or its click would be lost. */
let pressed = null;
addEventListener("pointerdown", (event) => (pressed = event.target), true);
for (const end of ["pointerup", "pointercancel"]) {
  addEventListener(end, () => {
    const released = pressed;
    // After its click; what is pressed again until then stays pressed.
    setTimeout(() => pressed === released && (pressed = null));
  }, true);
}

/** The field that is being written in: it stays until its change is taken or it is left, or what is written so far would be lost. */
let written = null;
addEventListener("input", (event) => event.target === document.activeElement && (written = event.target), true);
for (const end of ["change", "blur"]) {
  // A window that is left takes the focus along, and the field keeps it.
  addEventListener(end, (event) => event.target === written && (end === "change" || document.activeElement !== written) && (written = null), true);
}

/** What an element is known by when it is made again. */
const face = (element) => `${element.tagName} ${JSON.stringify(element.dataset)} ${element.id}`;

/** Replaces what is in `target` where `key` differs from last time; true where it did. Focus and caret stay with what is made again. */
export function fill(target, key, make) {
  if (target.dataset.key === key || [pressed, written].some((held) => held && target.contains(held))) return false;
  target.dataset.key = key;
  const had = target !== document.activeElement && target.contains(document.activeElement) ? document.activeElement : null;
  const caret = had?.selectionStart == null ? null : [had.selectionStart, had.selectionEnd];
  target.replaceChildren(...[make()].flat().filter((child) => child != null && child !== false));
  const again = had && [...target.querySelectorAll("button, select, input, textarea, [tabindex]")].find((one) => face(one) === face(had));
  again?.focus({ preventScroll: true });
  if (caret) again?.setSelectionRange?.(...caret);
  return true;
}

const keys = new WeakMap();

/** Shows `items` in `target`, in their order; an element whose item is still there stays the same element, with its focus and its click. */
export function keep(target, items, keyOf, make) {
  const had = new Map([...target.children].map((child) => [keys.get(child), child]));
  const wanted = new Map();
  for (const item of items) {
    let key = keyOf(item);
    while (wanted.has(key)) key += "'";
    wanted.set(key, item);
  }
  for (const [key, child] of had) if (!wanted.has(key)) child.remove();
  let place = target.firstChild;
  for (const [key, item] of wanted) {
    const child = had.get(key) ?? make(item);
    keys.set(child, key);
    if (child === place) place = place.nextSibling;
    else target.insertBefore(child, place);
  }
}

/** 75.4 as 1:15.4. */
export function clock(seconds, digits = 1) {
  const whole = Math.max(0, seconds);
  const minutes = Math.floor(whole / 60);
  return `${minutes}:${(whole - minutes * 60).toFixed(digits).padStart(digits ? 3 + digits : 2, "0")}`;
}

export const number = (x, digits = 1) => (x == null || !Number.isFinite(x) ? "–" : x.toFixed(digits));

/** A table: heads and rows of cells; a cell is words or `[words, class]`. With `cards` a narrow screen shows each row as a card. */
export function table(heads, rows, cards = false) {
  const cell = (tag) => (content, i) => {
    const [words, kind] = Array.isArray(content) ? content : [content];
    return el(tag, { class: kind, "data-head": cards && tag === "td" && words !== "" ? [heads[i]].flat()[0] : null }, words);
  };
  return el("div", { class: "scroll" }, el("table", cards ? { class: "cards" } : {},
    el("thead", {}, el("tr", {}, heads.map(cell("th")))),
    el("tbody", {}, rows.map((row) => el("tr", {}, row.map(cell("td")))))));
}
