// field: drawing of one frame: field surface, lines, layers, robots, ball; in field coordinates, m.

import { colours, faint, stroke } from "./colours.js";
import { drawGhost, givesWay } from "./ghost.js";
import { shows } from "./layers.js";
import { drawRobots, lerp, robotRadius } from "./robots.js";
import { drawShapes } from "./shapes.js";
import { Words } from "./words.js";

/** Draws a frame; the same function for the page and for its bench. */
export function drawFrame(context, camera, ratio, scene, next, share) {
  const [width, height] = camera.size;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.fillStyle = colours.back;
  context.fillRect(0, 0, width, height);
  const m = camera.matrix();
  context.setTransform(m[0] * ratio, m[1] * ratio, m[2] * ratio, m[3] * ratio, m[4] * ratio, m[5] * ratio);
  // One CSS pixel in metres.
  const pixel = 1 / camera.scale;
  drawSurface(context, scene.field);
  const words = new Words();
  const pen = { context, pixel, camera, ratio, words, robot: robotRadius(scene.field, pixel) / pixel + 2 };
  // Maps lie on the field surface, lines on the maps, and all else on the lines.
  const layers = scene.layers.filter((layer) => shows(layer.name, layer.on) && !givesWay(layer.name));
  const isMap = (layer) => layer.shapes[0]?.is === "heat";
  for (const layer of layers) if (isMap(layer)) drawShapes(pen, layer);
  drawLines(context, scene.field, pixel, defenders(scene.game));
  drawDirections(pen, scene);
  for (const layer of layers) if (!isMap(layer)) drawShapes(pen, layer);
  if (scene.game.placement) drawPlacement(pen, scene);
  if (shows("raw", false)) drawRaw(pen, scene);
  drawRobots(pen, scene, next, share);
  if (scene.ball) drawBall(pen, scene, next, share);
  drawGhost(pen, scene.field);
  words.draw(pen);
}

function drawSurface(context, field) {
  const [x, y, edge] = [field.length / 2, field.width / 2, field.margin];
  context.fillStyle = colours.margin;
  context.fillRect(-x - edge, -y - edge, 2 * (x + edge), 2 * (y + edge));
  context.fillStyle = colours.surface;
  context.fillRect(-x, -y, 2 * x, 2 * y);
}

/** Whose goal is at -x and at +x; nothing where it is not known. */
function defenders({ teams }) {
  return [-1, 1].map((side) => ["blue", "yellow"].find((team) => teams[team].defends === side));
}

function drawLines(context, field, pixel, owners) {
  const [x, y] = [field.length / 2, field.width / 2];
  context.strokeStyle = colours.line;
  context.lineWidth = Math.max(0.01, 1.2 * pixel);
  context.beginPath();
  context.rect(-x, -y, 2 * x, 2 * y);
  context.moveTo(0, -y);
  context.lineTo(0, y);
  if (field.centre_radius > 0) {
    context.moveTo(field.centre_radius, 0);
    context.arc(0, 0, field.centre_radius, 0, 2 * Math.PI);
  }
  for (const side of [-1, 1]) area(context, field, side, x);
  context.stroke();
  for (const side of [-1, 1]) goal(context, field, side, pixel, owners[side < 0 ? 0 : 1]);
}

/** Which way a team attacks: its name with an arrow, in the margin beside its own half. */
function drawDirections({ camera, words }, { field, game }) {
  const owners = defenders(game);
  for (const side of [-1, 1]) {
    const team = owners[side < 0 ? 0 : 1];
    if (!team) continue;
    const [from, to] = [camera.to([0, 0]), camera.to([-side, 0])];
    const arrow = camera.turned ? (to[1] > from[1] ? "↓" : "↑") : to[0] > from[0] ? "→" : "←";
    // Beside the touch line, or where the field stands upright beside the goal, on the right of the screen: tools are on the left.
    const at = camera.turned ? [side * (field.length + field.margin) / 2, (camera.flipped ? 1 : -1) * (field.goal_width / 2 + 0.7)] : [side * field.length / 4, (field.width + field.margin) / 2];
    words.ask({ key: `attacks ${team}`, at: camera.to(at), text: arrow === "←" ? `← ${team} attacks` : `${team} attacks ${arrow}`, tone: team, gap: 0, middle: true, rank: 3 });
  }
}

function area(context, field, side, x) {
  const half = field.area_width / 2;
  if (field.area_radius) {
    const r = field.area_radius;
    context.moveTo(side * x, -half - r);
    context.arc(side * x, -half, r, -Math.PI / 2, side > 0 ? -Math.PI : 0, side > 0);
    context.lineTo(side * (x - r), half);
    context.arc(side * x, half, r, side > 0 ? Math.PI : 0, Math.PI / 2, side > 0);
  } else {
    context.rect(side > 0 ? x - field.area_depth : -x, -half, field.area_depth, field.area_width);
  }
}

function goal(context, field, side, pixel, team) {
  const [line, half] = [side * field.length / 2, field.goal_width / 2];
  const deep = line + side * field.goal_depth;
  context.beginPath();
  context.moveTo(line, -half);
  context.lineTo(deep, -half);
  context.lineTo(deep, half);
  context.lineTo(line, half);
  if (team) {
    context.fillStyle = faint(team, 0.35);
    context.fill();
  }
  context.lineWidth = Math.max(0.03, 2.6 * pixel);
  context.strokeStyle = team ? stroke(team) : colours.dim;
  context.stroke();
}

function drawPlacement({ context, pixel }, scene) {
  const [x, y] = scene.game.placement;
  context.strokeStyle = colours.forbidden;
  context.lineWidth = 1.5 * pixel;
  context.beginPath();
  context.arc(x, y, 0.15, 0, 2 * Math.PI);
  context.moveTo(x - 0.22, y);
  context.lineTo(x + 0.22, y);
  context.moveTo(x, y - 0.22);
  context.lineTo(x, y + 0.22);
  context.stroke();
}

function drawRaw({ context, pixel }, scene) {
  context.lineWidth = 1.2 * pixel;
  for (const [team, , x, y, heading] of scene.raw.robots) {
    const r = scene.field.robot_radius;
    context.strokeStyle = stroke(team);
    context.strokeRect(x - r, y - r, 2 * r, 2 * r);
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + 1.6 * r * Math.cos(heading), y + 1.6 * r * Math.sin(heading));
    context.stroke();
  }
  context.strokeStyle = colours.ball;
  context.beginPath();
  for (const [x, y] of scene.raw.balls) {
    const r = Math.max(0.05, 5 * pixel);
    context.moveTo(x - r, y - r);
    context.lineTo(x + r, y + r);
    context.moveTo(x - r, y + r);
    context.lineTo(x + r, y - r);
  }
  context.stroke();
}

function drawBall({ context, pixel }, scene, next, share) {
  const ball = scene.ball;
  const [x, y] = next?.ball ? lerp(ball.at, next.ball.at, share) : ball.at;
  const r = Math.max(scene.field.ball_radius, 4 * pixel);
  if (shows("trail", true) && ball.trail.length > 1) {
    context.lineCap = "round";
    const steps = ball.trail.length;
    // Four strokes, fainter the older: not one for each point.
    for (let part = 0; part < 4; part++) {
      const from = Math.floor((part * (steps - 1)) / 4);
      const to = Math.floor(((part + 1) * (steps - 1)) / 4);
      context.strokeStyle = faint("ball", 0.15 + part * 0.2);
      context.lineWidth = (1 + part * 0.7) * pixel;
      path(context, ball.trail, from, to);
    }
    context.lineCap = "butt";
  }
  if (shows("ahead", true) && ball.ahead.length > 1) {
    context.strokeStyle = faint("ball", 0.8);
    context.lineWidth = 1.2 * pixel;
    context.setLineDash([4 * pixel, 4 * pixel]);
    path(context, ball.ahead, 0, ball.ahead.length - 1);
    context.setLineDash([]);
  }
  if (ball.height > 0.03) {
    // Its shadow stays on the field surface.
    context.fillStyle = faint("back", 0.6);
    disc(context, x, y, r);
    context.strokeStyle = colours.ball;
    context.lineWidth = pixel;
    context.beginPath();
    context.arc(x, y, r + ball.height * 0.25, 0, 2 * Math.PI);
    context.stroke();
  }
  context.fillStyle = ball.confidence > 0.3 ? colours.ball : faint("ball", 0.4);
  disc(context, x, y, r);
  context.strokeStyle = colours.rim;
  context.lineWidth = pixel;
  context.stroke();
}

function disc(context, x, y, r) {
  context.beginPath();
  context.arc(x, y, r, 0, 2 * Math.PI);
  context.fill();
}

function path(context, points, from, to) {
  context.beginPath();
  context.moveTo(points[from][0], points[from][1]);
  for (let i = from + 1; i <= to; i++) context.lineTo(points[i][0], points[i][1]);
  context.stroke();
}
