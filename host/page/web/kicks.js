// kicks: kick test: a robot kicks again and again, the ball is tracked, the gain is fitted and taken.

import { el, number, table } from "./dom.js";
import { ask } from "./link.js";
import { store } from "./store.js";

/** Kicks of a test. */
const KICKS = 10;

/** What a test says of itself, by the program's words. */
const STATES = {
  "waits-for-game": "waits until the referee lets the game run (force start)", "no-robot": "the robot is not on the field, or does not answer", "no-ball": "no camera sees the ball",
  rolls: "the ball rolls", "out-of-reach": "the ball lies outside the field or in a defence area: bring it back, the robots stand", kicks: "the robot goes to the ball and kicks it", done: "done",
};

/** The chosen robot of each team. */
const chosen = {};

/** Choice of a robot, the running test and its result; `take` sets a gain. */
export function kickTest(name, test, may, take) {
  const robots = (store.scene?.robots ?? []).filter((robot) => robot.team === name).map(({ id }) => id).sort((a, b) => a - b);
  const select = el("select", { id: `kicks-${name}`, "aria-label": `Robot of ${name} whose kicker is tested`, onchange: (event) => (chosen[name] = Number(event.target.value)) },
    ...robots.map((id) => el("option", { value: String(id) }, String(id))));
  select.value = String(chosen[name] ?? test?.robot ?? robots[robots.length - 1] ?? "");
  const begin = () => ask({ ask: "kicks", team: name, robot: Number(select.value), kicks: KICKS });
  return [
    el("h3", {}, "Kick test"),
    may ? el("div", { class: "field-set" }, el("label", { for: select.id }, "Robot"), select,
      el("button", { "data-kicks": name, disabled: robots.length === 0, onclick: begin }, `Kick ${KICKS} times`),
      test ? el("button", { "data-kicks-end": name, onclick: () => ask({ ask: "kicks", team: name, robot: null }) }, "End the test") : null) : null,
    test ? result(name, test, may, take) : el("p", { class: "muted" }, "A robot kicks a resting ball at 2.6 to 4.4 m/s while the game runs, the tracker sees how fast the ball leaves, and the gain is fitted. All others of the team stand, until the test is ended."),
  ];
}

function result(name, { robot, wanted, kicks, gain, state }, may, take) {
  const rows = kicks.map(([ordered, seen], i) => [[String(i + 1), "n"], [number(ordered, 2), "n"], [number(seen, 2), "n"], [number(seen / ordered, 3), "n"]]);
  return el("div", { "data-kicks-state": state },
    el("p", { role: "status" }, `Robot ${robot}: ${kicks.length} of ${wanted} kicks measured; ${STATES[state] ?? state}.`),
    rows.length ? table([["kick", "n"], ["ordered, m/s", "n"], ["seen, m/s", "n"], ["gain", "n"]], rows) : null,
    gain ? el("p", {}, `Gain ${number(gain.value, 3)} ± ${number(gain.error, 3)} `,
      may && state === "done" ? el("button", { "data-kicks-take": name, onclick: () => take(robot, Number(gain.value.toFixed(3))) }, `Take as calibration.kick ${robot}`) : null) : null);
}
