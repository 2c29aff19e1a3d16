// SPDX-License-Identifier: MIT
// The page in Chromium, from file://, as it is opened. Prints its size, how long it takes until it can be used, and its frames a
// second.
import assert from "node:assert/strict";
import {readFileSync, statSync} from "node:fs";
import {cpus} from "node:os";
import test from "node:test";
import {gunzipSync} from "node:zlib";

import {button, choose, opened, studio, text, timeOf, wait} from "./browser.mjs";
import {newEngine} from "./support.mjs";

// Which part of the cores' time nobody uses, over half a second.
async function idlePart() {
  const now = () => cpus().reduce(([idle, all], {times}) => [idle + times.idle, all + Object.values(times).reduce((sum, one) => sum + one)], [0, 0]);
  const [idle, all] = now();
  await wait(500);
  const [idler, more] = now();
  return (idler - idle) / (more - all);
}

const framesOf = (page) => page.evaluate(() => new Promise((done) => {
  let count = 0;
  const begin = performance.now();
  const step = () => (performance.now() - begin > 2000 ? done(count / 2) : (++count, requestAnimationFrame(step)));
  requestAnimationFrame(step);
}));

test("opens class III from a file, runs and moves it, and asks for nothing", async () => {
  // A browser that has just been started is busy with itself for a few seconds.
  let idle = await idlePart();
  for (const begin = Date.now(); idle < 0.9 && Date.now() - begin < 15000;) idle = await idlePart();
  const {page, requests, troubles, ready} = await opened();
  const size = statSync(studio).size;
  console.log(`page ${(size / 1e6).toFixed(2)} MB (at most 2.5), ready in ${ready} ms (at most 1000 on idle cores; they were idle for ${(100 * idle).toFixed(0)} % before)`);
  assert.ok(size <= 2.5e6);
  assert.match(await text(page, "h1"), /Class III/);
  await page.waitForSelector(".linkage");
  const before = await page.$eval(".linkage", (element) => element.innerHTML);
  await button(page, "OP");
  await wait(1500);
  assert.ok(await timeOf(page) > 0.3);
  assert.notEqual(await page.$eval(".linkage", (element) => element.innerHTML), before);
  console.log(`class III runs and moves at ${await framesOf(page)} frames a second`);
  await button(page, "HOLD");
  await wait(300);
  const held = await timeOf(page);
  await wait(300);
  assert.equal(await timeOf(page), held);
  assert.deepEqual(requests.filter((url) => !url.startsWith("file:") && !url.startsWith("blob:")), []);
  assert.equal(requests.filter((url) => url.startsWith("file:")).length, 1);
  assert.deepEqual(troubles, []);
  await choose(page, "Examples", "mechanisms/four-bar.toml");
  await page.waitForFunction(() => document.querySelector("h1").textContent.includes("Four-bar"));
  await button(page, "OP");
  await wait(1500);
  assert.ok(await timeOf(page) > 0.3);
  console.log(`the four-bar runs and moves at ${await framesOf(page)} frames a second`);
  await page.close();
});

test("carries the patch of class III as the engine makes it, and does not ask for it", async () => {
  const packed = /id="patch">([^<]*)</.exec(readFileSync(studio, "utf8"))[1];
  const {name, text: source, ...carried} = JSON.parse(gunzipSync(Buffer.from(packed, "base64")));
  const engine = await newEngine();
  const patched = engine.patch(source, {gain: "1e5", split: [], force: false}, name);
  const {svg} = engine.draw(patched.text, {theme: "auto", data: true}, name);
  assert.deepEqual(carried, {diagram: patched.text, judgement: patched.judgement, schematic: svg});

  const {page, troubles} = await opened({prepare: () => {
    globalThis.asked = [];
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message, ...rest) {
      globalThis.asked.push(message.verb);
      post.call(this, message, ...rest);
    };
  }});
  const asked = async (verb) => (await page.evaluate(() => globalThis.asked)).filter((one) => one === verb).length;
  await page.waitForFunction(() => document.querySelector("h1 .quiet")?.textContent, {timeout: 30000});  // its machine is there
  assert.equal(await asked("console.open"), 1);
  assert.equal(await asked("patch"), 0);
  await page.$eval("input.gain", (field) => {  // of another gain it has to ask
    field.value = "1e3";
    field.dispatchEvent(new Event("change", {bubbles: true}));
  });
  await page.waitForFunction(() => globalThis.asked.filter((verb) => verb === "console.open").length === 2, {timeout: 30000});
  assert.equal(await asked("patch"), 1);
  assert.deepEqual(troubles, []);
  await page.close();
});
