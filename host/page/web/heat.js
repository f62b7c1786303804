// heat: drawing of heat maps: each is drawn once for each place on the screen, then copied, as it changes five times a second and
// frames come sixty times.

const scaled = new WeakMap();

export function drawHeat({ context, camera, ratio }, shape) {
  const found = onScreen(shape, camera, ratio, context.canvas);
  if (!found) return;
  context.save();
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.drawImage(found.image, found.x, found.y);
  context.restore();
}

/** The part of the map that is seen, in the canvas's own pixels. */
function onScreen(shape, camera, ratio, target) {
  const matrix = camera.matrix().map((x) => x * ratio);
  const key = [...matrix, target.width, target.height].join();
  const before = scaled.get(shape);
  if (before?.key === key) return before;
  const [a, b] = [shape.low, shape.high].map((at) => camera.to(at).map((x) => x * ratio));
  const [x, y] = [0, 1].map((i) => Math.max(0, Math.floor(Math.min(a[i], b[i]))));
  const wide = Math.min(target.width, Math.ceil(Math.max(a[0], b[0]))) - x;
  const high = Math.min(target.height, Math.ceil(Math.max(a[1], b[1]))) - y;
  if (wide < 1 || high < 1) return null;
  const canvas = new OffscreenCanvas(wide, high);
  const context = canvas.getContext("2d");
  const [m0, m1, m2, m3, m4, m5] = matrix;
  context.setTransform(m0, m1, m2, m3, m4 - x, m5 - y);
  context.imageSmoothingEnabled = true;
  const [[x0, y0], [x1, y1]] = [shape.low, shape.high];
  // Rows run from least y up, as the field does.
  context.drawImage(small(shape), x0, y0, x1 - x0, y1 - y0);
  const found = { key, image: canvas.transferToImageBitmap(), x, y };
  scaled.set(shape, found);
  return found;
}

const rowsOf = (shape) => Math.floor(shape.cells.length / shape.columns);

/** One pixel a cell: dark violet over orange to pale yellow. */
function small(shape) {
  const columns = Math.max(1, shape.columns);
  const rows = Math.max(1, rowsOf(shape));
  const picture = new OffscreenCanvas(columns, rows);
  const image = new ImageData(columns, rows);
  shape.cells.slice(0, columns * rows).forEach((value, i) => {
    const [r, g, b] = heatColour(value / 255);
    image.data.set([r, g, b, value === 0 ? 0 : 60 + value * 0.55], i * 4);
  });
  picture.getContext("2d").putImageData(image, 0, 0);
  return picture;
}

/** Rises in lightness all the way, so that it reads without hue too. */
const STOPS = [[42, 10, 74], [120, 28, 109], [188, 55, 84], [237, 105, 37], [251, 180, 26], [252, 255, 164]];

/** The scale as a picture, for the legend. */
export const HEAT_SCALE = `linear-gradient(to right, ${STOPS.map((stop) => `rgb(${stop})`).join(", ")})`;

function heatColour(x) {
  const at = Math.min(0.9999, Math.max(0, x)) * (STOPS.length - 1);
  const [low, share] = [Math.floor(at), at % 1];
  return STOPS[low].map((from, i) => from + (STOPS[low + 1][i] - from) * share);
}

/** What the map says of a place; nothing where it is not drawn. */
export function heatNote(shape, x, y) {
  const [i, j] = [[x, shape.columns], [y, rowsOf(shape)]].map(([at, n], axis) => Math.floor(((at - shape.low[axis]) / (shape.high[axis] - shape.low[axis])) * n));
  if (i < 0 || j < 0 || i >= shape.columns || j >= rowsOf(shape)) return null;
  const share = (shape.cells[j * shape.columns + i] / 255) * shape.most * 100;
  return share > 0 ? `${shape.note}: ${share.toFixed(share < 10 ? 1 : 0)} %` : null;
}
