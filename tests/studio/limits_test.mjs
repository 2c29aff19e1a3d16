// SPDX-License-Identifier: MIT
// The engine ends what takes too much, and goes on.
import assert from "node:assert/strict";
import {performance} from "node:perf_hooks";
import test from "node:test";

import {newEngine} from "./support.mjs";

const engine = await newEngine({seconds: 0.5, steps: 200_000, numbers: 1e6});

const diagram = (blocks, rest = "") => `format = "oblique-diagram/1"\n${rest}[blocks]\n${blocks}`;
// A quick oscillator: a turn in 6e-6 s.
const quick = (rest) => diagram(
  'x = { type = "integrator", in = "1e6*y", initial = 1 }\ny = { type = "integrator", in = "-1e6*x" }\n', rest);
const decay = diagram('x = { type = "integrator", in = "-x", initial = 1 }\n');

function assertRefused(answer, says) {
  assert.equal(answer.ok, false, "it was not refused");
  assert.match(answer.diagnostics[0].message, says);
}

function assertWorks() {
  const {ok, numbers, rows} = engine.run(decay, {until: 1, samples: 3});
  assert.ok(ok);
  assert.equal(rows, 3);
  assert.ok(Math.abs(numbers.at(-1) - Math.exp(-1)) < 1e-7);  // x = e^−t; the run's tolerance is 1e-8
}

test("a run that takes too many steps is refused", () => {
  const slow = engine.run(quick("[run]\nuntil = 1e6\n"), {samples: 2});
  if (slow.ok) assert.equal(slow.complete, false);  // a slow machine: the time was over before
  else assertRefused(slow, /steps/);
  assertWorks();
});

test("a run ends when its time is over, and says so", async () => {
  const patient = await newEngine({seconds: 0.3, steps: 1e12});
  const begin = performance.now();
  const answer = patient.run(quick("[run]\nuntil = 1e6\nmax_steps = 1e12\n"), {samples: 1000});
  assert.ok(performance.now() - begin < 5000);
  assert.ok(answer.ok, JSON.stringify(answer.diagnostics));
  assert.equal(answer.complete, false);
  assert.ok(answer.time > 0 && answer.time < 1e6);
  assert.match(answer.warnings.at(-1).message, /the run was ended at t = /);
});

test("an advance ends when its time is over", () => {
  const held = engine.console();
  assert.ok(held.open(quick("[run]\nuntil = 1\n")).ok);
  const answer = held.advance(1e5, ["x"], 10);
  if (answer.ok) {
    assert.equal(answer.complete, false);
    assert.ok(answer.time < 1e5);
    assert.equal(answer.numbers[2 * (answer.rows - 1)], answer.time);
  } else {
    assertRefused(answer, /steps/);
  }
  held.close();
  assertWorks();
});

test("rows that a page cannot hold are refused before the run", () => {
  assertRefused(engine.run(decay, {samples: 5_000_000}), /rows of 2 columns are too much/);
  assertRefused(engine.run(decay, {samples: 1e9}), /a whole number from 2 to/);
  assertWorks();
});

test("a text that is too long is refused", () => {
  assertRefused(engine.open("#".repeat(5 << 20)), /the file has 5242880 bytes/);
});

test("deep nesting is refused and leaves the engine whole", () => {
  for (const depth of [100, 10_000, 500_000]) {
    const nested = "(".repeat(depth) + "1" + ")".repeat(depth);
    const answer = engine.run(diagram(`x = { type = "constant", value = "${nested}" }\n`), {samples: 2});
    if (depth > 1000) assert.equal(answer.ok, false);
    const lists = engine.open(`a = ${"[".repeat(depth)}${"]".repeat(depth)}\n`);
    assert.equal(lists.ok, false);
    assert.equal(engine.ended, false, `nesting of ${depth}`);
  }
  assertWorks();
});

test("memory that is used up is a diagnostic", async () => {
  const greedy = await newEngine({numbers: 1e12, seconds: 60});
  const answer = greedy.motion(`format = "oblique-mechanism/1"
[frame]
A = [0, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
`, {positions: 10_000_000});
  assert.equal(answer.ok, false, "100 million numbers went in");
  assert.match(answer.diagnostics[0].message, /^the memory of the page is used up/);
  assert.equal(greedy.ended, false);
  assert.ok(greedy.run(decay, {samples: 3}).ok);
});

test("options are held to their names and kinds", () => {
  for (const [options, says] of [
    [{untill: 1}, /there is no option 'untill'[^]*did you mean 'until'/],
    [{until: "1 kg"}, /'until' is 1 kg/],
    [{until: -1}, /the run would end at t = -1 s/],
    [{until: [1]}, /'until' is \[1\]; expected a number/],
    [{samples: 2.5}, /a whole number/],
    [{set: {"x.initial": "2", "y.initial": "1"}}, /y/],
    [{set: ["x"]}, /'set' is \["x"\]/],
    [{trust: 1}, /true or false/],
  ]) assertRefused(engine.run(decay, options), says);
  const twice = engine.run(decay, {set: {"x.initial": "2"}, until: "1000 ms", samples: 2});
  assert.ok(Math.abs(twice.numbers.at(-1) - 2 * Math.exp(-1)) < 1e-7);
});

test("what is not of the kind is told, and the engine stays", () => {
  assertRefused(engine.open(), /neither a diagram nor a mechanism/);
  assertRefused(engine.open(17), /broken TOML/);
  assertRefused(engine.run(undefined, "options"), /no JSON object/);
  const held = engine.console();
  assert.ok(held.open(decay).ok);
  assertRefused(held.advance("a while"), /cannot go on by nan s/);
  assertRefused(held.advance(1, [undefined]), /there is no signal or pot ''/);
  assert.equal(held.advance("0.5").time, 0.5);
  held.close();
  held.close();
  assertRefused(held.read("x"), /this console is closed/);
  assert.equal(engine.ended, false);
  assertWorks();
});

test("a text of any bytes is a diagnostic", () => {
  let state = 1;
  const random = () => (state = (state * 48271) % 2147483647) / 2147483647;  // Park and Miller's generator
  for (let k = 0; k < 300; ++k) {
    const letters = [...decay];
    for (let m = 0; m < 3; ++m) letters[Math.floor(random() * letters.length)] = String.fromCharCode(random() * 0x250);
    const text = letters.join("");
    for (const answer of [engine.open(text), engine.run(text, {samples: 2, until: 0.01}), engine.draw(text)])
      assert.ok(answer.ok || answer.diagnostics.length > 0, text);
    assert.equal(engine.ended, false, text);
  }
});
