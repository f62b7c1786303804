// spectrum: power on the radio's channels, as `onetwo robot scan` measured it: a bar for each, the team's own channel marked.

import { el } from "./dom.js";

/** Heights and widths of the picture, its own units: a channel is 4 wide. */
const CHANNEL = 4, HIGH = 80, LEFT = 34, TOP = 14, BOTTOM = 30;
/** Channels between two labels of the axis. */
const LABELLED = 20;
/** MHz to each side of its channel's middle that a team at 2 Mbit/s takes. */
const HALF_WIDTH = 1;

function drawn(tag, attributes, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

const middle = (channel) => LEFT + CHANNEL * (channel + 0.5);
const height = (share) => TOP + HIGH * (1 - share);

/** The heading, the picture and its words of a scan `{ sweeps, counts, channel, quietest }`. */
export function spectrum({ sweeps, counts, channel, quietest }) {
  const percent = (at) => Math.round((100 * (counts[at] ?? 0)) / sweeps);
  const right = LEFT + CHANNEL * counts.length;
  const bars = counts.map((count, at) => drawn("rect", { class: Math.abs(at - channel) <= HALF_WIDTH ? "own" : "power", x: LEFT + CHANNEL * at, y: height(count / sweeps), width: CHANNEL - 1, height: (HIGH * count) / sweeps },
    drawn("title", {}, `${2400 + at} MHz, channel ${at}: power in ${percent(at)} % of the sweeps`)));
  const levels = [0, 0.5, 1].flatMap((share) => [drawn("line", { x1: LEFT, x2: right, y1: height(share), y2: height(share) }), drawn("text", { x: LEFT - 4, y: height(share) + 4, "text-anchor": "end" }, `${100 * share} %`)]);
  const labels = counts.flatMap((_, at) => (at % LABELLED ? [] : [drawn("text", { x: middle(at), y: TOP + HIGH + 14, "text-anchor": "middle" }, String(2400 + at))]));
  const mark = [drawn("line", { class: "own", x1: middle(channel), x2: middle(channel), y1: TOP, y2: TOP + HIGH }), drawn("text", { class: "own", x: middle(channel), y: TOP - 3, "text-anchor": "middle" }, "ours")];
  const own = Math.max(...[channel - HALF_WIDTH, channel, channel + HALF_WIDTH].map(percent));
  const words = `Our channel ${channel} (${2400 + channel} MHz): power in ${own} % of ${sweeps} sweeps. Quietest: ${quietest.join(", ")}.`;
  return [el("h2", {}, "Radio channels before the match"),
    drawn("svg", { class: "spectrum", viewBox: `0 0 ${right + 4} ${TOP + HIGH + BOTTOM}`, role: "img", "aria-label": words }, ...levels, ...labels, drawn("text", { x: right, y: TOP + HIGH + 28, "text-anchor": "end" }, "MHz"), ...bars, ...mark),
    el("p", { class: own ? "bad" : "muted" }, words, own ? " Set [radio] channel in team.toml to one of these, and start control again." : "")];
}
