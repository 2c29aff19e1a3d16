// SPDX-License-Identifier: MIT
// A machine that is held, by the engine and by `oblique operate` with the same commands.
import assert from "node:assert/strict";
import {readFileSync, writeFileSync} from "node:fs";
import {join} from "node:path";
import test from "node:test";

import {inScratch, newEngine, runProgram} from "./support.mjs";

const engine = await newEngine();

function opened(name) {
  const held = engine.console();
  const answer = held.open(readFileSync(name, "utf8"), name);
  assert.ok(answer.ok, JSON.stringify(answer));
  return {held, answer};
}

// What `read` commands printed, in order.
function readings(done) {
  assert.equal(done.status, 0, done.err);
  return done.out.trimEnd().split("\n").map((line) => Number(line.split(" = ")[1].split(" ")[0]));
}

function assertNear(here, native, within, what) {
  assert.ok(Math.abs(here - native) <= within, `${what}: ${here} here, ${native} by the program`);
}

const side = "diagrams/lessons/triangle-side.toml";

test("a pot turned while the machine runs gives what it gives the program", () => {
  const {held, answer} = opened(side);
  assert.deepEqual(answer.outputs, ["side"]);
  assert.ok(answer.pots.includes("b.value"), answer.pots.join(" "));
  held.advance(1);
  const before = held.read("side", "c");
  assert.deepEqual(before.units, ["m", "machine unit"]);
  const turned = held.turn("b.value", 0.5);
  assert.equal(turned.how, "at_once");
  held.advance(1);
  const after = held.read("side");
  held.setMode("hold");
  held.advance(1);
  const kept = held.read("side");
  held.setMode("initial");
  held.advance(0.1);
  const back = held.read("phi");

  const native = readings(runProgram(["operate", side],
    "advance 1\nread side\nturn b.value 0.5\nadvance 2\nread side\nhold\nadvance 3\nread side\nic\nadvance 3.1\nread phi\n"));
  // The tolerance of the diagram's run is 1e-8 of 1 machine unit; both are that near to the solution.
  assertNear(before.numbers[0], native[0], 2e-8, "before");
  assertNear(after.numbers[0], native[1], 2e-8, "after");
  assertNear(kept.numbers[0], native[2], 2e-8, "held");
  assertNear(back.numbers[0], native[3], 1e-12, "at the beginning again");
  // The cosine theorem at φ = t, to what the file promises of a gain of 1e5.
  const exact = (b, phi) => Math.sqrt(0.3 * 0.3 + b * b - 2 * 0.3 * b * Math.cos(phi));
  assertNear(before.numbers[0], exact(0.4, 1), 1e-4, "before");
  assertNear(after.numbers[0], exact(0.5, 2), 1e-4, "after");
  held.close();
});

test("rows of an advance are what the voltmeter shows on the way", () => {
  const first = opened(side).held;
  const rows = first.advance(2, ["side", "phi"], 4);
  assert.equal(rows.rows, 4);
  assert.equal(rows.complete, true);
  assert.equal(rows.numbers.length, 12);
  const second = opened(side).held;
  for (let row = 0; row < 4; ++row) {
    second.advance(0.5);
    const shown = second.read("side", "phi");
    // Where a console is asked in between changes none of its steps.
    assert.deepEqual([...rows.numbers.slice(3 * row + 1, 3 * row + 3)], [...shown.numbers]);
    assert.equal(rows.numbers[3 * row], 0.5 * (row + 1));
  }
  first.close();
  second.close();
});

test("a state goes from the engine to the program and back", () => inScratch((folder) => {
  const file = join(folder, "state.toml");
  const {held} = opened(side);
  held.advance(1);
  writeFileSync(file, held.save().state);
  held.advance(2);
  const there = held.read("side").numbers[0];
  // The solver restarts from a state, so that two ways agree to the tolerance of the run.
  const [byProgram] = readings(runProgram(["operate", side], `restore ${file}\nadvance 3\nread side\n`));
  assertNear(there, byProgram, 2e-8, "from the engine");

  readings(runProgram(["operate", side], `advance 0.5\nsave ${file}\nread side\n`));
  assert.equal(held.restore(readFileSync(file, "utf8")).time, 0.5);
  assert.equal(held.advance(2.5).time, 3);
  assertNear(held.read("side").numbers[0], there, 2e-8, "from the program");
  held.close();
}));

// sin t and cos t: whatever the frames, a sweep begins where sin t rises through 1/2.
const circle = `format = "oblique-diagram/1"
[blocks]
x = { type = "integrator", in = ["y"] }
y = { type = "integrator", in = ["-x"], initial = 1 }
[outputs]
twice = { signal = "x", scale = 2, unit = "m" }
`;

test("a probe gives sweeps from where its trigger is", () => {
  const held = engine.console();
  assert.ok(held.open(circle).ok);
  const {probe} = held.setProbe(["x", "y"], {interval: 0.1, length: "2 s", trigger: "twice", level: 1, slope: "rising"});
  const sweeps = [];
  for (let frame = 0; frame < 100; ++frame) {
    held.advance(0.17);
    const taken = held.takeTraces(probe);
    let at = 0;
    for (const {begin, rows, ended} of taken.traces) {
      const numbers = taken.numbers.subarray(3 * at, 3 * (at += rows));
      if (ended) sweeps.push({begin, rows, numbers});
      else assert.ok(rows <= 20);
    }
    assert.equal(taken.numbers.length, 3 * at);
  }
  assert.equal(sweeps.length, 3);  // the last one at 12π/6 + … = 13.09; t ends at 17
  sweeps.forEach(({begin, rows, numbers}, k) => {
    assertNear(begin, Math.PI / 6 + 2 * Math.PI * k, 1e-6, "rises through 1/2");  // 1e-8 of the run, grown over 13 s
    assert.equal(rows, 21);
    for (let row = 0; row < rows; ++row) {
      assertNear(numbers[3 * row], begin + 0.1 * row, 1e-12, "at the interval");
      assertNear(numbers[3 * row + 1], Math.sin(numbers[3 * row]), 1e-6, "x");
      assertNear(numbers[3 * row + 2], Math.cos(numbers[3 * row]), 1e-6, "y");
    }
  });
  assert.ok(held.removeProbe(probe).ok);
  for (const [answer, says] of [
    [held.takeTraces(probe), /there is no probe number 0/],
    [held.takeTraces(-1), /there is no probe number/],
    [held.takeTraces("x"), /there is no probe number/],
    [held.setProbe([], {}), /it has no names/],
    [held.setProbe(["z"], {}), /there is no signal 'z' for a probe/],
    [held.setProbe(["x"], {trigger: "z"}), /there is no signal 'z' for a probe/],
    [held.setProbe(["x"], {trigger: "x", slope: "risin"}), /there is no slope 'risin'; expected rising, falling or either\n.*'rising'/],
    [held.setProbe(["x"], {interval: 1e-9, length: 1}), /traces of 1000000000 rows of 1 values; expected 16000000 numbers at most/],
    [held.setProbe(["x"], {length: "-1 s"}), /its traces have no length/],
    [held.setProbe(["x"], {most: 0}), /'most' is 0; expected a whole number from 1/],
    [held.setProbe(["x"], {lenght: 1}), /there is no option 'lenght'/],
  ]) {
    assert.equal(answer.ok, false);
    assert.match(answer.diagnostics[0].message, says);
  }
  held.close();
});

test("all signals are given at once, in machine units", () => {
  const held = engine.console();
  const {signals} = held.open(circle);
  assert.deepEqual(signals, ["x", "y"]);
  held.advance(1);
  const {numbers} = held.signals();
  assertNear(numbers[0], Math.sin(1), 1e-7, "x");
  assertNear(numbers[1], Math.cos(1), 1e-7, "y");
  assert.equal(held.read("twice").numbers[0], 2 * numbers[0]);
  held.close();
});

// What a page colours and points at: signals that the console knows.
test("a schematic with data names what the console reads", () => {
  const {held, answer} = opened(side);
  const {svg} = engine.draw(readFileSync(side, "utf8"), {data: true}, side);
  const named = [...svg.matchAll(/ data-signal="([^"]*)"/g)].flatMap(([, words]) => words.split(" "));
  assert.ok(named.length > 20);
  for (const name of named) assert.ok(answer.signals.includes(name), name);
  assert.match(svg, / data-element="c" data-signal="c"/);
  assert.doesNotMatch(engine.draw(readFileSync(side, "utf8"), {}, side).svg, /data-/);
  held.close();
});

test("lamps show what is beyond the machine unit", () => {
  const text = 'format = "oblique-diagram/1"\n[blocks]\nx = { type = "integrator", in = "one" }\none = { type = "constant" }\n';
  const held = engine.console();
  assert.ok(held.open(text).ok);
  assert.deepEqual(held.overloads().signals, []);
  held.advance(1.5);
  const lit = held.overloads();
  assert.deepEqual(lit.signals, ["x"]);
  assert.ok(Math.abs(lit.numbers[0] - 1.5) < 1e-8);
  held.close();
});

test("what there is not is a diagnostic, and the machine stays as it was", () => {
  const {held} = opened(side);
  held.advance(1);
  for (const [answer, says] of [
    [held.turn("b.valu", 1), /b\.valu/],
    [held.turn("b.value", "two apples"), /apples|two/],
    [held.read("nothing"), /there is no signal or pot 'nothing'/],
    [held.setMode("fast"), /there is no mode of operation 'fast'/],
    [held.advance(-1), /cannot go on by -1 s/],
    [held.advance(NaN), /cannot go on by nan s/],
    [held.advance(1, ["side"], 0), /0 rows/],
    [held.advance(1, ["sidde"]), /did you mean 'side'/],
    [held.restore("nonsense"), /state/],
    [held.open("nonsense"), /broken TOML/],
  ]) {
    assert.equal(answer.ok, false);
    assert.match(answer.diagnostics[0].message, says);
  }
  assert.equal(held.advance(0).time, 1);
  held.close();
  assert.match(engine.console().read("x").diagnostics[0].message, /no machine is held/);
});
