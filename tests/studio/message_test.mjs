// SPDX-License-Identifier: MIT
// What is wrong with a file, in the same words by the engine and by the program.
import assert from "node:assert/strict";
import {writeFileSync} from "node:fs";
import {join} from "node:path";
import test from "node:test";

import {inScratch, newEngine, runProgram} from "./support.mjs";

const engine = await newEngine();

const diagram = (blocks, rest = "") => `format = "oblique-diagram/1"\n${rest}[blocks]\n${blocks}`;
const crank = 'AB = { points = ["A", "B"], length = 1 }\n';
const mechanism = (bodies, drives = 'crank = { turns = "AB", about = "A", speed = 1 }\n', sketch = "C = [3, 3]\n") =>
  `format = "oblique-mechanism/1"\n[frame]\nA = [0, 0]\nD = [4, 0]\n[bodies]\n${bodies}[drives]\n${drives}[sketch]\n${sketch}`;

const wrong = [
  ["run", "broken TOML", 'format = "oblique-diagram/1"\n[blocks\n', 2],
  ["run", "unknown key", diagram('a = { type = "constant" }\n', 'tilte = "x"\n'), 2],
  ["run", "unknown block", diagram('a = { type = "integrater", in = "a" }\n'), 3],
  ["run", "unknown signal", diagram('one = { type = "constant" }\nb = { type = "cosine", in = "onne" }\n'), 4],
  ["run", "open input", diagram('m = { type = "multiplier", x = "m" }\n'), 3],
  ["run", "several findings", diagram('m = { type = "multiplier", x = "m" }\nn = { type = "multiplyer" }\n'), 3],
  ["run", "wrong unit", diagram('a = { type = "constant", value = "3 kg" }\n'), 3],
  ["run", "wrong expression", diagram('a = { type = "constant", value = "3*(2+" }\n'), 3],
  ["run", "a number out of range", diagram('a = { type = "constant", value = "1e999" }\n'), 3],
  ["run", "singular loop", diagram('x = { type = "summer", in = "x" }\n'), 0],
  ["run", "blow up", diagram('x = { type = "integrator", in = "y", initial = 1 }\ny = { type = "multiplier", in = ["x", "x"] }\n', "[run]\nuntil = 2\n"), 0],
  ["draw", "neither of the two", 'title = "x"\n', 1],
  ["solve", "no drive", mechanism(crank, ""), 0],
  ["solve", "unknown point of a drive", mechanism(crank, 'crank = { turns = "AB", about = "E", speed = 1 }\n', ""), 8],
  ["solve", "wrong mobility", mechanism(crank + 'BC = { points = ["B", "C"], length = 3.5 }\n'), 0],
  ["solve", "links that do not reach", mechanism(crank + 'BC = { points = ["B", "C"], length = 0.5 }\nCD = { points = ["C", "D"], length = 0.5 }\n'), 0],
  ["patch", "links that do not reach", mechanism(crank + 'BC = { points = ["B", "C"], length = 0.5 }\nCD = { points = ["C", "D"], length = 0.5 }\n'), 0],
];

for (const [verb, what, text, line] of wrong) {
  test(`${verb}: ${what}`, () => inScratch((folder) => {
    const file = join(folder, "input.toml");
    writeFileSync(file, text);
    const native = runProgram(verb === "draw" ? ["draw", file, "-o", join(folder, "x.svg")] : [verb, file]);
    const answer = {
      run: () => engine.run(text, {}, file),
      draw: () => engine.draw(text, {}, file),
      solve: () => engine.motion(text, {}, file),
      patch: () => engine.patch(text, {}, file),
    }[verb]();
    assert.equal(answer.ok, false);
    assert.notEqual(native.status, 0);
    const said = answer.diagnostics.map(({message}) => `error: ${message}\n`).join("");
    // The page has no options: where the program says --until, the engine says 'until'.
    const plain = native.err.replace(/--([a-z]+)/g, "'$1'").replace(/`oblique ([a-z]+)`/g, "'$1'");
    assert.equal(said, plain);
    if (line > 0) assert.equal(answer.diagnostics[0].line, line);
  }));
}

test("a diagram is not taken for a mechanism", () => {
  const answer = engine.motion(diagram('a = { type = "constant" }\n'), {}, "a.toml");
  assert.equal(answer.diagnostics[0].message, "a.toml: this is a diagram, and a motion is of mechanisms; expected a mechanism");
});
