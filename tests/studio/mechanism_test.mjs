// SPDX-License-Identifier: MIT
// A mechanism that a page shows, held by formulas and by the program.
import assert from "node:assert/strict";
import {readFileSync} from "node:fs";
import {join} from "node:path";
import test from "node:test";

import {inScratch, newEngine, runProgram} from "./support.mjs";

const engine = await newEngine();
const fourBar = "diagrams/mechanisms/four-bar.toml", classThree = "diagrams/mechanisms/class-iii.toml";
const textOf = (name) => readFileSync(name, "utf8");

function opened(name) {
  const mechanism = engine.mechanism(), answer = mechanism.open(textOf(name), name);
  assert.ok(answer.ok, JSON.stringify(answer));
  return {mechanism, answer};
}
function held(name, options = {}) {
  const console_ = engine.console(), patched = engine.patch(textOf(name), options, name);
  assert.ok(console_.open(patched.text, name).ok);
  return console_;
}
// The place of a point of the mechanism in the picture, and back: the crank's pivot A is at (0, 0), D at (4, 0).
function placesOf(answer, position) {
  const index = (name) => answer.points.findIndex((point) => point.name === name);
  const pixel = (name) => [position.numbers[2 * index(name)], position.numbers[2 * index(name) + 1]];
  const zero = pixel("A"), scale = (pixel("D")[0] - zero[0]) / 4;
  return {pixel, toPixel: ([x, y]) => [zero[0] + scale * x, zero[1] - scale * y], scale};
}

test("the point of a crank goes where it is wanted, from turn to turn", () => {
  const {mechanism, answer} = opened(fourBar);
  const start = mechanism.at(0), {toPixel, pixel} = placesOf(answer, start);
  assert.ok(Math.hypot(...pixel("B").map((at, k) => at - toPixel([1, 0])[k])) < 1e-9);
  for (const angle of [0.3, 1.5, 3, 4.4, 6]) {
    // beyond the circle of the crank, whose nearest point lies in the same direction
    const found = mechanism.nearest("B", ...toPixel([1.7 * Math.cos(angle), 1.7 * Math.sin(angle)]), angle - 0.2);
    assert.ok(Math.abs(found.time - angle) < 1e-6, `${found.time} ${angle}`);  // 1 rad/s from 0
    assert.ok(Math.abs(found.distance - 0.7) < 1e-9, String(found.distance));
  }
  // past a whole turn it goes on from the other end of the motion
  const around = mechanism.nearest("B", ...toPixel([1.2 * Math.cos(0.1), 1.2 * Math.sin(0.1)]), 6.2);
  assert.ok(Math.abs(around.time - 0.1) < 1e-6, String(around.time));
});

test("a machine is followed for as long as it is in operation", () => {
  const {mechanism, answer} = opened(fourBar);
  const machine = held(fourBar, {gain: 1e4});
  const check = (operated, what) => {
    const position = mechanism.follow(machine, 1);
    assert.ok(position.ok && position.analog, JSON.stringify(position));
    assert.ok(Math.abs(position.time - operated) < 1e-9, `${what}: ${position.time}`);
    const {pixel, toPixel} = placesOf(answer, position);
    assert.ok(Math.hypot(...pixel("B").map((at, k) => at - toPixel([Math.cos(operated), Math.sin(operated)])[k])) < 1e-6, what);
    assert.ok(position.away < 1e-3, `${what}: ${position.away}`);  // 4 m at gain 1e4 and input weights of 10: some 1e-4 m
    return position;
  };
  machine.advance(0.5);
  const error = check(0.5, "in operation").away;
  assert.ok(error > 1e-7);  // it is not the exact one
  machine.setMode("hold");
  machine.advance(0.4);
  check(0.5, "held");
  machine.setMode("operate");
  machine.advance(0.25);
  check(0.75, "in operation again");
  machine.repeat(0.1, 1);
  machine.advance(0.05);
  check(0, "in initial condition");
  machine.advance(0.35);
  check(0.3, "repeated");
  machine.advance(1.1);
  check(0.3, "in the next round");
});

test("a diagram that is not of the mechanism is not followed", () => {
  const {mechanism} = opened(fourBar);
  const machine = engine.console();
  machine.open(textOf("diagrams/lessons/circle.toml"), "circle.toml");
  assert.equal(mechanism.follow(machine, 1).analog, false);
  assert.match(mechanism.follow(machine, -1).diagnostics[0].message, /the magnification is -1; expected a finite number above 0/);
  assert.match(mechanism.nearest("Q", 0, 0, 0).diagnostics[0].message, /there is no point 'Q'/);
  assert.match(engine.mechanism().at(0).diagnostics[0].message, /no mechanism is held; expected a mechanism/);
});

test("a dragged joint gives a file with other lengths", () => {
  const {mechanism, answer} = opened(fourBar);
  const {pixel, toPixel, scale} = placesOf(answer, mechanism.at(1));
  const c = pixel("C");
  const dragged = mechanism.drag("C", c[0] + 10, c[1] - 5, 1);
  assert.ok(dragged.ok, JSON.stringify(dragged));
  const rocker = dragged.changed.find(({name}) => name === "CD");
  const d = toPixel([4, 0]);
  assert.ok(Math.abs(rocker.after - Math.hypot(c[0] + 10 - d[0], c[1] - 5 - d[1]) / scale) < 5.1e-5, JSON.stringify(rocker));
  assert.equal(engine.open(dragged.text, fourBar).ok, true);
  assert.equal(mechanism.timeOf(dragged.drive).time, 1);
});

test("eigenvalues tell what the program tells of a patch", () => {
  const options = {gain: 1e3, split: ["O1C", "DE", "AB"]};
  const slow = engine.loops(textOf(classThree), {...options, moments: 91}, classThree);
  assert.equal(slow.growing, 0);
  const patched = (...given) => inScratch((folder) => runProgram(["patch", classThree, "--gain", "1e3", "--split", "O1C,DE,AB", ...given, "-o", join(folder, "p.toml")]));
  const told = patched();
  const pole = Number((told.out + told.err).match(/slowest pole (-?[\d.e+]+)/)?.[1]);
  assert.ok(Math.abs(slow.rightmost.real / pole - 1) < 0.005, `${slow.rightmost.real} ${pole}`);  // three digits are printed
  assert.deepEqual(slow.outer, ["EC"]);
  assert.equal(slow.bandwidth, 20);
  const fast = engine.loops(textOf(classThree), {...options, slower: 4, moments: 91}, classThree);
  const refused = patched("--slower", "4");
  const growth = Number(refused.err.match(/diverge, at ([\d.e+]+) 1\/s/)[1]);
  assert.ok(fast.growing > 0 && Math.abs(fast.rightmost.real / growth - 1) < 0.005, `${fast.rightmost.real} ${growth}`);
});

test("errors come gain by gain as `compare` has them together", () => {
  const comparison = engine.comparison();
  comparison.open(textOf(fourBar), {}, fourBar);
  const first = comparison.add(1e4);
  assert.equal(first.order, null);
  const both = comparison.add(1e3);
  const told = JSON.parse(runProgram(["compare", fourBar, "--gain", "1e3,1e4", "--json"]).out);
  assert.deepEqual(both.runs.map(({gain}) => gain), [1e3, 1e4]);
  both.runs.forEach((run, k) => {
    // the solver's tolerance, which the program's steps need not share
    assert.ok(Math.abs(run.max_error / told.runs[k].max_error - 1) < 1e-4, `${run.max_error} ${told.runs[k].max_error}`);
    assert.ok(Math.abs(run.static + run.lag + run.solver - run.max_error) < 1e-9 * run.max_error);
  });
  assert.ok(Math.abs(both.order - told.order) < 1e-4, `${both.order} ${told.order}`);
  assert.match(both.svg, /order −1/);
  assert.match(comparison.add(-1).diagnostics[0].message, /the gain is -1; expected a finite number above 0/);
});
