// over: dialog after a match: its result, the same match again, or another one.

import { byId, el, fill } from "./dom.js";
import { ask } from "./link.js";
import { store } from "./store.js";
import { seek, span, time } from "./transport.js";

export function showOver() {
  const box = byId("over");
  const over = time.live ? store.latest?.over : null;
  box.hidden = !over;
  if (!over) return;
  const { blue, yellow } = store.latest.game.teams;
  const seed = (store.latest.seed ?? 0) + 1;
  fill(box, JSON.stringify([store.state.life, blue.score, yellow.score, over, seed]), () => [
    el("h2", {}, `Full time ${blue.score} : ${yellow.score}`),
    el("p", {}, blue.score === yellow.score ? "A draw." : `${blue.score > yellow.score ? "Blue" : "Yellow"} wins.`),
    el("div", { class: "field-set" },
      el("button", { id: "again", onclick: () => seek(span()[0], true) }, "Watch again"),
      over.another && store.state.may_ask !== false ? el("button", { id: "another", onclick: () => ask({ ask: "restart", seed }) }, `New match, seed ${seed}`) : null),
  ]);
}
