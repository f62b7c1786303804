// robots: drawing of a robot: hull with a flat front, number, velocity, target, role.

import { colours, faint, stroke } from "./colours.js";
import { shows } from "./layers.js";
import { isChosen } from "./store.js";

export const lerp = (a, b, share) => [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share];

/** The flat front stands at this half angle: 0.6 of a robot's width is its mouth's side. */
const FRONT = 0.61;

/** Half the side of yellow's square, in radii. */
const PLATE = 0.62;

const turn = (a, b, share) => a + Math.atan2(Math.sin(b - a), Math.cos(b - a)) * share;

/** Where a robot is between two scenes. */
export function between(robot, next, share) {
  const later = next?.robots.find((other) => other.team === robot.team && other.id === robot.id);
  if (!later) return [robot.at, robot.heading];
  return [lerp(robot.at, later.at, share), turn(robot.heading, later.heading, share)];
}

/** As large as it is, and never too small for its number, m. */
export const robotRadius = (field, pixel) => Math.max(field.robot_radius, 8 * pixel);

export function drawRobots(pen, scene, next, share) {
  const { context, pixel } = pen;
  const radius = robotRadius(scene.field, pixel);
  const paths = shows("paths", true);
  for (const robot of scene.robots) if (paths && robot.mind) drawIntent(pen, robot, radius);
  const velocities = shows("velocities", true);
  for (const robot of scene.robots) {
    const [at, heading] = between(robot, next, share);
    if (velocities) drawVelocity(pen, robot, at, radius);
    context.globalAlpha = robot.confidence > 0.3 ? 1 : 0.45;
    context.fillStyle = colours[robot.team];
    context.beginPath();
    context.arc(at[0], at[1], radius, heading + FRONT, heading - FRONT + 2 * Math.PI);
    context.closePath();
    context.fill();
    context.lineWidth = 1.2 * pixel;
    context.strokeStyle = colours.rim;
    context.stroke();
    // Told apart without colour: yellow's number stands on a dark square.
    if (robot.team === "yellow") {
      context.fillStyle = colours["yellow-ink"];
      context.fillRect(at[0] - PLATE * radius, at[1] - PLATE * radius, 2 * PLATE * radius, 2 * PLATE * radius);
    }
    if (robot.vitals?.faults.length) {
      context.strokeStyle = colours.bad;
      context.lineWidth = 2.5 * pixel;
      context.setLineDash([3 * pixel, 3 * pixel]);
      ring(context, at, radius + 4 * pixel);
      context.setLineDash([]);
    }
    if (isChosen(robot)) {
      context.strokeStyle = colours.accent;
      context.lineWidth = 2.5 * pixel;
      ring(context, at, radius + 3.5 * pixel);
    }
    context.globalAlpha = 1;
  }
  drawWords(pen, scene, next, share, radius);
}

function drawIntent({ context, pixel }, robot, radius) {
  const { path, ball_to: target } = robot.mind.intent;
  if (path.length > 1) {
    // Thin and whole: dashed paths of twenty robots would be the most expensive strokes of a frame.
    context.strokeStyle = faint(robot.team, isChosen(robot) ? 1 : 0.8);
    context.lineWidth = (isChosen(robot) ? 2.4 : 1.2) * pixel;
    context.beginPath();
    context.moveTo(path[0][0], path[0][1]);
    for (const [x, y] of path.slice(1)) context.lineTo(x, y);
    context.stroke();
    ring(context, path[path.length - 1], radius * 0.45);
  }
  if (target) {
    const [x, y] = target;
    const r = 6 * pixel;
    context.strokeStyle = colours.ball;
    context.lineWidth = 1.4 * pixel;
    context.setLineDash([2 * pixel, 4 * pixel]);
    context.beginPath();
    context.moveTo(robot.at[0], robot.at[1]);
    context.lineTo(x, y);
    context.stroke();
    context.setLineDash([]);
    context.beginPath();
    context.moveTo(x - r, y);
    context.lineTo(x, y + r);
    context.lineTo(x + r, y);
    context.lineTo(x, y - r);
    context.closePath();
    context.stroke();
  }
}

function drawVelocity({ context, pixel }, robot, at, radius) {
  const [vx, vy] = robot.velocity;
  const speed = Math.hypot(vx, vy);
  if (speed < 0.1) return;
  // As far as it goes in a quarter of a second, from its hull on.
  const [ux, uy] = [vx / speed, vy / speed];
  const [from, to] = [radius, radius + speed * 0.25];
  const [x, y] = [at[0] + ux * to, at[1] + uy * to];
  const head = 4.5 * pixel;
  context.strokeStyle = stroke(robot.team);
  context.lineWidth = 1.8 * pixel;
  context.beginPath();
  context.moveTo(at[0] + ux * from, at[1] + uy * from);
  context.lineTo(x, y);
  context.moveTo(x - head * (ux - uy), y - head * (uy + ux));
  context.lineTo(x, y);
  context.lineTo(x - head * (ux + uy), y - head * (uy - ux));
  context.stroke();
}

function drawWords({ context, camera, ratio, words }, scene, next, share, radius) {
  // Letters stand upright whichever way the field lies: in pixels.
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.textAlign = "center";
  context.textBaseline = "middle";
  const size = Math.max(11, Math.min(22, radius * camera.scale * 1.15));
  context.font = `700 ${size}px system-ui, "DejaVu Sans", sans-serif`;
  // A phone's field has 35 to 40 pixels a metre: roles stand where there is room, and the chosen robot's always.
  const roles = shows("roles", true);
  for (const robot of scene.robots) {
    const at = camera.to(between(robot, next, share)[0]);
    context.fillStyle = colours[robot.team === "yellow" ? "yellow" : "blue-ink"];
    context.fillText(robot.id, at[0], at[1] + size * 0.04);
    words.keepFree(at, radius * camera.scale);
    if (!roles || !robot.mind || (camera.scale <= 24 && !isChosen(robot))) continue;
    // The chosen robot's word before all others.
    words.ask({ key: `${robot.team}${robot.id}`, at, text: label(robot.mind), tone: "text", gap: radius * camera.scale + 2, rank: isChosen(robot) ? 2 : 0 });
  }
  const m = camera.matrix().map((x) => x * ratio);
  context.setTransform(m[0], m[1], m[2], m[3], m[4], m[5]);
}

/** What people read under a robot: its role, and the state where a case binds it. */
export function label(mind) {
  return mind.part ? `${mind.role} · ${mind.state}` : mind.role;
}

function ring(context, at, radius) {
  context.beginPath();
  context.arc(at[0], at[1], radius, 0, 2 * Math.PI);
  context.stroke();
}
