// bench: cost of a frame: the script's own time for 22 robots and every layer, beside that of an empty field, in the same run.

import { Camera } from "./camera.js";
import { drawFrame } from "./field.js";
import { all, setLayer } from "./layers.js";
import { store } from "./store.js";

/** Frames of each kind in a round, and rounds: empty and full take turns, so that both meet the same machine. */
const FRAMES = 40;
const ROUNDS = 15;

const median = (list) => list.sort((a, b) => a - b)[Math.floor(list.length / 2)];

/** Milliseconds a frame, empty and full, and how many shapes, robots and layers the full one had. */
export function bench(full = store.scene) {
  for (const layer of all()) setLayer(layer.name, true);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [1200, 860];
  const context = canvas.getContext("2d");
  const camera = new Camera();
  camera.look(1200, 860, full.field);
  const empty = { ...full, ball: null, robots: [], layers: [], raw: { balls: [], robots: [] }, game: { ...full.game, placement: null } };
  const timed = (scene) => {
    const begin = performance.now();
    for (let i = 0; i < FRAMES; i++) {
      drawFrame(context, camera, 1, scene, scene, 0.5);
      // A pixel is asked for: without that the browser only notes what is to be drawn, and throws it away at the next clearing.
      context.getImageData(0, 0, 1, 1);
    }
    return (performance.now() - begin) / FRAMES;
  };
  const [bare, whole] = [[], []];
  for (let i = 0; i < ROUNDS; i++) {
    bare.push(timed(empty));
    whole.push(timed(full));
  }
  // What each part costs beside the empty frame, the most expensive first.
  const parts = [["robots", { ...empty, robots: full.robots }], ...full.layers.map((layer) => [layer.name, { ...empty, layers: [layer] }])]
    .map(([name, scene]) => [name, median([0, 1, 2].map(() => timed(scene)))]);
  const shapes = full.layers.reduce((sum, layer) => sum + layer.shapes.length, 0);
  const [emptyMs, fullMs] = [median(bare), median(whole)];
  const costs = parts.map(([name, ms]) => [name, ms / emptyMs - 1]).sort((a, b) => b[1] - a[1]);
  return { empty_ms: emptyMs, full_ms: fullMs, times: fullMs / emptyMs, robots: full.robots.length, layers: full.layers.length, shapes, parts: costs };
}
