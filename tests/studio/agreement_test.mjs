// SPDX-License-Identifier: MIT
// The shipped diagrams and mechanisms by the engine and by the program: the same code, but for the functions of the C
// library (sin, exp, pow …), whose last bit may differ. Where it does, the solver chooses other steps.
import assert from "node:assert/strict";
import {readFileSync, readdirSync, statSync} from "node:fs";
import {join} from "node:path";
import {performance} from "node:perf_hooks";
import test from "node:test";
import {gzipSync} from "node:zlib";

import {enginePath, inScratch, newEngine, readTable, runProgram, shipped} from "./support.mjs";

const begin = performance.now();
const engine = await newEngine({seconds: 300, numbers: 50e6});
const ready = performance.now() - begin;

const ownBlocks = "diagrams/own-blocks/blocks";
for (const file of readdirSync(ownBlocks))
  assert.ok(engine.putBlock(file.replace(".toml", ""), readFileSync(join(ownBlocks, file), "utf8")).ok);

// The table that the program writes.
const table = (args, words) => inScratch((folder) => {
  const file = join(folder, "table.csv");
  const done = runProgram(["--blocks", ownBlocks, ...args, "-o", file]);
  assert.ok(done.status < 2, done.err);
  return readTable(readFileSync(file, "utf8"), words);
});

// What the program tells of the errors of a run: of each output the largest.
function toldErrors(name, args) {
  const lines = runProgram(["--blocks", ownBlocks, "run", name, ...args, "--trust"]).err.split("\n");
  const head = lines.findIndex((line) => /^ *output +size +largest error /.test(line));
  assert.ok(head >= 0, lines.join("\n"));
  return Object.fromEntries(lines.slice(head + 1).map((line) => line.trim().split(/ +/)).map(([output, , largest]) => [output, Number(largest)]));
}

// Of each column its size, the largest magnitude by the program, and how far the two are apart.
function compared(answer, native) {
  assert.ok(answer.ok, JSON.stringify(answer.diagnostics));
  assert.deepEqual(answer.columns.map(({name}) => name), native.columns);
  assert.equal(answer.rows, native.rows.length);
  return answer.columns.map(({name}, c) => {
    let size = 0;
    let apart = 0;
    native.rows.forEach((row, r) => {
      const here = answer.numbers[r * answer.columns.length + c];
      if (Object.is(here, row[c]) || here === row[c]) return;
      assert.ok(Number.isFinite(here) && Number.isFinite(row[c]), `${name}, row ${r}: ${here}, ${row[c]}`);
      apart = Math.max(apart, Math.abs(here - row[c]));
    });
    for (const row of native.rows) if (Number.isFinite(row[c])) size = Math.max(size, Math.abs(row[c]));
    return {name, size, apart, part: apart === 0 ? 0 : apart / size};
  });
}

// The same by the largest column of the same unit: what is zero but for roundings has no size of its own. Angular
// accelerations have at least that of the square of the angular velocities, of which they are sums.
function byUnit(columns, units) {
  const sizes = {};
  columns.forEach(({size}, c) => (sizes[units[c]] = Math.max(sizes[units[c]] ?? 0, size)));
  sizes["rad/s^2"] = Math.max(sizes["rad/s^2"] ?? 0, (sizes["rad/s"] ?? 0) ** 2);
  return columns.map((column, c) => ({...column, part: column.apart === 0 ? 0 : column.apart / sizes[units[c]]}));
}

// Two texts that may differ in the last digits of their numbers.
function assertSameText(here, native, within) {
  const number = /-?\d+(\.\d+)?(e[-+]?\d+)?/g;
  assert.equal(here.replace(number, "#"), native.replace(number, "#"));
  const numbers = here.match(number) ?? [];
  (native.match(number) ?? []).forEach((text, k) => {
    const apart = Math.abs(Number(text) - Number(numbers[k]));
    assert.ok(apart <= within * Math.abs(Number(text)), `${numbers[k]} here, ${text} by the program`);
  });
}

const worst = (columns) => columns.reduce((a, b) => (b.part > a.part ? b : a));

let bitwise = 0;
const others = [];

for (const {name, text} of shipped("oblique-diagram/1")) {
  // Promised: no further apart than the sum of the errors that both tell of their runs (docs/trust.md). Of a chaotic
  // motion no digit stands after some time; half as long is compared.
  test(`run ${name}`, () => {
    const columns = compared(engine.run(text, {}, name), table(["run", name]));
    if (worst(columns).apart === 0) return void ++bitwise;
    others.push(`${name}: ${worst(columns).name} ${worst(columns).part.toExponential(1)}`);
    if (worst(columns).part < 1e-12) return;  // roundings of what both compute with 1e-16
    let {trust} = engine.run(text, {trust: true}, name);
    let held = columns, told = [];
    const lost = Math.min(...trust.outputs.map((output) => output.lost ?? Infinity));
    if (lost < Infinity) {
      const until = lost / 2;
      told = ["--until", String(until)];
      held = compared(engine.run(text, {until}, name), table(["run", name, ...told]));
      trust = engine.run(text, {until, trust: true}, name).trust;
      others[others.length - 1] += `; until ${until} ${worst(held).part.toExponential(1)}`;
    }
    const native = toldErrors(name, told);
    for (const {name: column, apart, size} of held.slice(1)) {
      const here = trust.outputs.find((output) => output.name === column).largest, there = native[column];
      // and roundings of what both compute with 1e-16
      assert.ok(apart <= here + there + 1e-12 * size, `${column}: ${apart} apart, the errors are ${here} here, ${there} by the program`);
    }
  });
}

for (const {name, text} of shipped("oblique-mechanism/1")) {
  // Promised: twelve digits of the largest position, velocity, angle … The library solves to rounding; near a dead
  // centre roundings are magnified.
  test(`solve ${name}`, () => {
    const answer = engine.motion(text, {}, name);
    const native = table(["solve", name], answer.statuses);
    const columns = byUnit(compared(answer, native), answer.columns.map(({unit}) => unit));
    if (worst(columns).apart === 0) return void ++bitwise;
    others.push(`${name}: ${worst(columns).name} ${worst(columns).part.toExponential(1)}`);
    assert.ok(worst(columns).part <= 1e-12, others.at(-1));
  });
  // The diagram has dimensions and starts of the exact motion, computed by sines and cosines, in parts of the largest.
  test(`patch ${name}`, () => {
    const native = runProgram(["patch", name]);
    const answer = engine.patch(text, {}, name);
    assert.equal(answer.ok, native.status === 0, native.err);
    if (answer.ok) assertSameText(answer.text, native.out, 1e-13);
  });
}

for (const format of ["oblique-diagram/1", "oblique-mechanism/1"]) {
  for (const {name, text} of shipped(format)) {
    test(`draw ${name}`, () => inScratch((folder) => {
      const file = join(folder, "picture.svg");
      const native = runProgram(["--blocks", ownBlocks, "draw", name, "-o", file]);
      const answer = engine.draw(text, {}, name);
      assert.equal(answer.ok, native.status === 0, native.err);
      if (answer.ok) assert.equal(answer.svg, readFileSync(file, "utf8"));
    }));
  }
}

test("what it weighs", () => {
  const wasm = readFileSync(enginePath("engine.wasm"));
  const js = readFileSync(enginePath("engine.js"));
  console.log(`engine.wasm ${wasm.length} bytes, ${gzipSync(wasm).length} gzipped; engine.js ${js.length}, ` +
    `${gzipSync(js).length} gzipped; ready after ${ready.toFixed(0)} ms`);
  console.log(`${bitwise} runs and motions are the same to the last bit; the others, by the size of the column:`);
  for (const line of others) console.log(`  ${line}`);
});
