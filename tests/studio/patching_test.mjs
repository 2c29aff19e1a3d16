// SPDX-License-Identifier: MIT
// What the engine gives a patch panel.
import assert from "node:assert/strict";
import test from "node:test";

import {newEngine, shipped} from "./support.mjs";

const lag = `format = "oblique-diagram/1"
[blocks]
a = { type = "constant", value = 0.5 }
x = { type = "integrator", in = ["4*a", "-4*x"] }
`;

test("every kind of block has its words and its symbol", async () => {
  const engine = await newEngine();
  const {ok, blocks} = engine.blocks();
  assert.ok(ok);
  assert.ok(blocks.length >= 56);
  for (const block of blocks) {
    assert.match(block.summary, /\.$/, block.name);
    assert.match(block.svg, /^<svg /, block.name);
    assert.ok(block.outputs.length > 0, block.name);
  }
  const servo = blocks.find(({name}) => name === "servo-amplifier");
  assert.equal(servo.parameters.find(({name}) => name === "bandwidth").unit, "Hz");
  assert.equal(servo.inputs[0].sum, true);
});

// A step there and a step back: nothing else of the file changes, and what was drawn is drawn again.
test("every shipped diagram is a panel, and an element that is added and removed leaves its text as it was", async () => {
  const engine = await newEngine();
  for (const {name, text} of shipped("oblique-diagram/1").filter(({name}) => !/own-blocks/.test(name))) {
    const panel = engine.panel(text, {}, name);
    assert.ok(panel.ok, `${name}: ${panel.diagnostics?.[0].message}`);
    assert.deepEqual(panel.lost, [], name);
    assert.deepEqual(panel.moved, [], name);
    for (const block of panel.blocks) {
      for (const wire of block.wires) assert.ok(wire.at || !block.body, `${name}: ${block.name}.${wire.port} has no place for ${wire.text}`);
      assert.deepEqual(block.open, [], `${name}: ${block.name}`);
    }
    const there = engine.edit(text, {steps: [{do: "add", type: "inverter", name: "added_by_hand"}, {do: "connect", signal: panel.blocks[0].outputs[0]?.signal ?? panel.blocks[0].name, block: "added_by_hand", port: "in"}]}, name);
    assert.ok(there.ok, `${name}: ${there.diagnostics?.[0].message}`);
    assert.notEqual(there.text, text);
    assert.ok(engine.open(there.text, name).ok, name);
    const back = engine.edit(there.text, {steps: [{do: "remove", block: "added_by_hand"}]}, name);
    assert.equal(back.text, text, name);
    // to another name and back
    const first = panel.blocks[0].name;
    const renamed = engine.edit(text, {steps: [{do: "rename", block: first, name: "renamed_by_hand"}]}, name);
    assert.ok(renamed.ok, `${name}: ${renamed.diagnostics?.[0].message}`);
    assert.deepEqual(renamed.renamed, [[first, "renamed_by_hand"]]);
    const opened = engine.open(renamed.text, name);
    assert.ok(opened.ok, `${name}: ${opened.diagnostics?.[0].message}`);
  }
});

test("steps that cannot be done are refused, and say why", async () => {
  const engine = await newEngine();
  const message = (steps) => {
    const {ok, diagnostics} = engine.edit(lag, steps, "x.toml");
    assert.equal(ok, false);
    return diagnostics[0].message;
  };
  assert.equal(message({}), "an edit has no 'steps'; expected a list of steps");
  assert.equal(message({steps: [{do: "solder"}]}),
    "an edit has no step 'solder'; expected add, remove, rename, connect, disconnect, weigh, set, head, place or show");
  assert.equal(message({steps: [{do: "weigh", block: "x", port: "in", term: -1, weight: 2}]}), "'term' of an edit is no number of a wire; expected 0 or more");
  assert.equal(message({steps: [{do: "weigh", block: "x", port: "in", term: 0}]}), "a step of an edit has no 'weight'; expected a number");
  assert.equal(message({steps: [7]}), "a step of an edit is no object; expected an object");
  assert.equal(message({steps: [{do: "place", places: [{name: "x", at: [1]}]}]}), "a place of an edit has no 'at'; expected [x, y]");
  assert.match(engine.edit("[broken", {steps: []}, "x.toml").diagnostics[0].message, /^x\.toml:1:\d+: broken TOML/);
});

test("settings are given as they can be written again", async () => {
  const engine = await newEngine();
  const text = `format = "oblique-diagram/1"
[blocks]
w = { type = "recording", data = { file = "wind.csv", x = "t", y = "v" } }
f = { type = "function-generator", in = "w", points = [[0, 0], [1, 0.5]], label = "a \\"b\\"" }
`;
  for (const block of engine.panel(text, {}, "x.toml").blocks) {
    for (const [key, value] of Object.entries(block.settings)) {
      if (key === "in") continue;
      const again = engine.edit(text, {steps: [{do: "set", block: block.name, key, value}]}, "x.toml");
      assert.equal(again.text, text, `${block.name}.${key}: ${value}`);
    }
  }
});

test("a machine goes on as another one", async () => {
  const engine = await newEngine();
  const console = engine.console();
  assert.equal(console.exchange(lag, [], "x.toml").diagnostics[0].what, "no machine is held");
  assert.ok(console.open(lag, "x.toml").ok);
  console.turn("a.value", "0.25");
  console.advance(0.5, [], 1);
  const {text, renamed} = engine.edit(lag, {steps: [{do: "rename", block: "x", name: "y"}]}, "x.toml");
  const went = console.exchange(text, renamed, "x.toml");
  assert.equal(went.time, 0.5);
  assert.deepEqual(went.turned, {"a.value": "0.25"});
  // to the tolerance of a run, 1e-8, with room
  assert.ok(Math.abs(console.read("y").numbers[0] - 0.25 * (1 - Math.exp(-2))) < 1e-6);
  assert.equal(console.exchange("format = 1", [], "x.toml").ok, false);
  assert.ok(console.advance(0.5, [], 1).ok);
});
